// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <random>
#include <thread>

#include "cli/prove/experiment.hpp"
#include "cli/prove/rival_methods.hpp"
#include "cli/prove/score.hpp"
#include "cli/prove/write.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/write.hpp"
#include "golden/concealed/cases.hpp"

namespace hemi::prove {
namespace {

namespace fs = std::filesystem;

Answer diagnose(const std::string& stem, const TrialOptions& options) {
  const std::string out = stem + ".diagnosis";
  std::vector<std::string> arguments{stem + ".csv", "--model", stem + ".model.json", "-o", out};
  if (options.own_program) arguments.insert(arguments.begin(), "diagnose");
  const ChildResult child = run_child(options.program, arguments, stem + ".log", options.limits);
  Answer answer;
  answer.failure = child.failure;
  if (answer.failure.empty()) {
    try {
      answer = parse_answer(recording::read_json_object(out + "/diagnosis.json"));
    } catch (const std::runtime_error& error) {
      answer = Answer{};
      answer.failure = error.what();
    }
  }
  answer.seconds = child.seconds;
  answer.peak_mib = child.peak_mib;
  return answer;
}

/// The resonator's ageing and the clock's are one, in any experiment without a second clock.
bool separable(const Truth& truth) {
  const std::vector<std::string> never{"frequency_ageing", "oscillator_ageing"};
  return truth.set != never;
}

/// Carries out what an ambiguous answer proposes.
std::optional<Answer> carry_out(const concealed::Case& hidden, const std::string& stem,
                                const TrialOptions& options) {
  const std::string scenario = proposed_scenario(stem + ".diagnosis");
  if (scenario.empty()) return std::nullopt;
  const std::string run = stem + ".experiment";
  fs::create_directories(run);
  const ChildResult simulated =
      run_child(options.program, {"simulate", scenario, "-o", run}, run + "/log", options.limits);
  Answer none;
  none.failure = simulated.failure.empty() ? "the experiment has no inputs" : simulated.failure;
  if (!simulated.failure.empty()) return none;
  for (const auto& entry : fs::directory_iterator(run)) {
    if (entry.path().extension() != ".csv") continue;
    const auto inputs = inputs_of(entry.path().string(), hidden.unit);
    if (!inputs) return none;
    write_concealed(concealed::repeat_case(hidden, *inputs), run, "again");
    return diagnose(run + "/again", options);
  }
  return none;
}

/// Everything that this trial left under its name.
void tidy(const std::string& stem) {
  for (const char* part : {".csv", ".json", ".model.json", ".log", ".diagnosis", ".experiment"})
    fs::remove_all(stem + part);
}

void keep(const std::string& stem, const Task& task, const recording::Json& truth,
          const std::string& directory) {
  const fs::path target(directory);
  for (const char* part : {".csv", ".json", ".model.json", ".log", ".diagnosis", ".experiment"}) {
    const fs::path from(stem + part), to = target / (task.name + part);
    if (!fs::exists(from)) continue;
    fs::remove_all(to);
    fs::copy(from, to, fs::copy_options::recursive);
  }
  recording::write_text((target / (task.name + ".truth.json")).string(),
                        recording::json_text(truth, 1) + "\n");
}

}  // namespace

std::vector<Task> plan(int total, const std::string& only_class) {
  const auto& all = concealed::classes();
  if (!only_class.empty() &&
      std::none_of(all.begin(), all.end(), [&](const auto& one) { return one.name == only_class; }))
    throw recording::InputError({}, fmt::format("no class '{}'", only_class), "see hemi prove --help");
  const int full =
      std::accumulate(all.begin(), all.end(), 0, [](int sum, const auto& c) { return sum + c.count; });
  std::vector<Task> tasks;
  for (const auto& one : all) {
    if (!only_class.empty() && one.name != only_class) continue;
    const int count =
        only_class.empty()
            ? std::max(1, static_cast<int>(std::lround(static_cast<double>(one.count) * total / full)))
            : total;
    for (int i = 0; i < count; ++i) tasks.push_back({one.name, static_cast<std::uint64_t>(i), ""});
  }
  // In an order that tells nothing, always the same one.
  std::mt19937 order(1);
  std::shuffle(tasks.begin(), tasks.end(), order);
  for (std::size_t i = 0; i < tasks.size(); ++i) tasks[i].name = fmt::format("recording-{:05}", i);
  return tasks;
}

Trial run_trial(const Task& task, const TrialOptions& options) {
  const std::string stem = (fs::path(options.directory) / task.name).string();
  const auto hidden = concealed::make_case(task.cls, options.seed, task.index);
  write_concealed(hidden, options.directory, task.name);
  Trial trial;
  trial.answer = diagnose(stem, options);
  if (options.rivals) trial.rivals = rival_answers(stem + ".csv", stem + ".model.json");
  const recording::Json truth = truth_json(hidden, task.name);
  trial.truth = parse_truth(truth);
  if (options.own_program && task.cls == "poor" && separable(trial.truth)) {
    std::string why;
    if (right(trial.truth, trial.answer, why)) trial.experiment = carry_out(hidden, stem, options);
  }
  if (!options.keep.empty()) keep(stem, task, truth, options.keep);
  tidy(stem);
  return trial;
}

void run_trials(const std::vector<Task>& tasks, const TrialOptions& options, unsigned jobs,
                const std::function<void(std::size_t, Trial&&)>& done) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr problem;
  std::atomic<bool> stop{false};
  const auto work = [&] {
    while (!stop) {
      const std::size_t at = next++;
      if (at >= tasks.size()) return;
      try {
        recording::check_interrupt();
        Trial trial = run_trial(tasks[at], options);
        const std::lock_guard lock(mutex);
        done(at, std::move(trial));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!problem) problem = std::current_exception();
        stop = true;
      }
    }
  };
  {
    std::vector<std::jthread> pool;
    for (unsigned i = 0; i < jobs; ++i) pool.emplace_back(work);
  }
  if (problem) std::rethrow_exception(problem);
}

}  // namespace hemi::prove
