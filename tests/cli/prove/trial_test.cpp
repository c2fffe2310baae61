// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/trial.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "cli/recording/error.hpp"
#include "cli/recording/model.hpp"
#include "cli/recording/recording.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::prove {
namespace {

namespace fs = std::filesystem;

TEST(Plan, KeepsTheProportions) {
  std::map<std::string, int> count;
  std::set<std::string> names;
  for (const Task& task : plan(1300, "")) {
    ++count[task.cls];
    names.insert(task.name);
  }
  EXPECT_EQ(count["null"], 400);
  EXPECT_EQ(count["params"], 200);
  EXPECT_EQ(count["pair"], 100);
  EXPECT_EQ(names.size(), 1300u);
  EXPECT_EQ(plan(5, "weak").size(), 5u);
  EXPECT_THROW(plan(5, "wrong"), recording::InputError);
}

/// A stand-in that knows nothing, keeps a list of what it was given, and answers always the same.
class TrialTest : public recording::testing::ScratchTest {
 protected:
  TrialOptions stand_in(const std::string& body) const {
    std::ofstream(path("diagnose")) << "#!/bin/sh\n" << body;
    fs::permissions(path("diagnose"), fs::perms::owner_all);
    fs::create_directory(path("work"));
    TrialOptions options;
    options.program = path("diagnose");
    options.own_program = false;
    options.limits = {30.0, 0.0};
    options.directory = path("work");
    return options;
  }
};

TEST_F(TrialTest, ShowsTheDiagnosisNothingButRecordingAndModel) {
  auto options =
      stand_in("ls \"$(dirname $1)\" > " + path("seen") +
               "; mkdir $5; echo '{\"format\": \"hemi-diagnosis/1\", \"verdict\": \"consistent\"}' > "
               "$5/diagnosis.json\n");
  const Trial trial = run_trial({"single_strong", 1, "recording-7"}, options);
  EXPECT_EQ(trial.answer.failure, "");
  EXPECT_EQ(trial.answer.verdict, "consistent");
  EXPECT_EQ(trial.truth.cls, "single_strong");
  std::multiset<std::string> seen;
  std::ifstream list(path("seen"));
  for (std::string name; list >> name;) seen.insert(name);
  EXPECT_EQ(seen, (std::multiset<std::string>{"recording-7.csv", "recording-7.json", "recording-7.log",
                                              "recording-7.model.json"}));
  EXPECT_TRUE(fs::is_empty(path("work")));
}

TEST_F(TrialTest, WritesFilesOfTheFormatAndKeepsThemOnRequest) {
  auto options = stand_in("exit 0\n");
  options.keep = path("kept");
  options.rivals = true;
  fs::create_directory(options.keep);
  const Trial trial = run_trial({"null", 3, "recording-0"}, options);
  EXPECT_NE(trial.answer.failure, "");  // no diagnosis.json
  EXPECT_EQ(trial.rivals.size(), 4u);
  const auto file = recording::read_recording(path("kept/recording-0.csv"));
  EXPECT_GE(file.rows(), 5u * 3600u - 10u);
  for (const char* channel : {"case_temp_degc", "frequency_hz", "drive_v", "quadrature_v", "rate_dph"})
    EXPECT_NE(file.find(channel), nullptr) << channel;
  const auto model = recording::read_model(path("kept/recording-0.model.json"));
  EXPECT_TRUE(model.frequency && model.bias && model.drive && model.quadrature &&
              model.thermal_time_constant_s);
  EXPECT_GT(model.noise.at("rate_dph_rthz").white, 0.0);
  EXPECT_TRUE(fs::exists(path("kept/recording-0.truth.json")));
  for (const char* word : {"null", "single", "weak"})
    EXPECT_EQ(recording::json_text(file.sidecar).find(word), std::string::npos) << word;
}

TEST_F(TrialTest, RunsAllAtOnceAndStopsAtTheFirstProblem) {
  const auto options = stand_in("exit 0\n");
  std::set<std::size_t> seen;
  run_trials(plan(3, "null"), options, 2, [&](std::size_t task, Trial&&) { seen.insert(task); });
  EXPECT_EQ(seen, (std::set<std::size_t>{0, 1, 2}));
  auto broken = options;
  broken.directory = path("nowhere");
  EXPECT_THROW(run_trials(plan(2, "null"), broken, 2, [](std::size_t, Trial&&) {}), recording::OutputError);
}

}  // namespace
}  // namespace hemi::prove
