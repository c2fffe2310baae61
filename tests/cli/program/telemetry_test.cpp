// SPDX-License-Identifier: Apache-2.0
// hemi diagnose on telemetry as it comes: channels missing, gaps, NaN, other rates, HDF5, foreign names. Each
// is diagnosed for what it holds, and what it could not show is said.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <set>

#include "cli/recording/recording.hpp"
#include "cli/recording/write.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

using recording::Json;
using recording::Recording;
using Names = std::set<std::string>;

// What the run holds: effects far above their limits, or none.
struct Recipe {
  double step_s = 5.0, length_s = 10800.0;
  double swing_degc = 25.0;
  double dwell_s = 900.0;      // of an amplitude step; 0: none
  double duffing = 0.0;        // df/f of amplitude 0 to 1
  double leak_per_h = 0.0;     // relative growth of the drive
  double split_v_per_h = 0.0;  // growth of the quadrature
  std::uint64_t seed = 1;
};
constexpr Recipe kNothing{};

// Explicit Euler at a twentieth of a second or of a row.
Recording telemetry(const Recipe& recipe) {
  Recording run{.device = "test", .sample_rate_hz = 1.0 / recipe.step_s};
  for (const auto& [name, unit] :
       std::vector<std::pair<const char*, const char*>>{{"time_s", "s"},
                                                        {"case_temp_degc", "degC"},
                                                        {"board_temp_degc", "degC"},
                                                        {"rate_in_dph", "deg/h"},
                                                        {"accel_g", "g"},
                                                        {"supply_v", "V"},
                                                        {"quadrature_trim_v", "V"},
                                                        {"frequency_hz", "Hz"},
                                                        {"amplitude", "1"},
                                                        {"drive_v", "V"},
                                                        {"quadrature_v", "V"},
                                                        {"rate_dph", "deg/h"}})
    run.channels.push_back({name, unit, {}});
  std::mt19937_64 random(recipe.seed);
  std::normal_distribution<double> normal;
  const double scale = std::sqrt(0.5 / recipe.step_s);  // of a one-sided density in a row's mean
  const auto at_case = [&](double t) {
    return 15.0 + recipe.swing_degc * std::sin(2.0 * std::numbers::pi * t / 7000.0);
  };
  constexpr double tau_s = 1900.0;
  constexpr int kSteps = 20;
  const auto f_of = [](double t) { return 4424.9 + t * (0.3716 + t * (-9.7e-4 + t * 1.53e-5)); };
  double degc = at_case(0.0), f_before = f_of(degc);
  const auto rows = static_cast<int>(recipe.length_s / recipe.step_s);
  for (int i = 0; i < rows; ++i) {
    const double t = i * recipe.step_s;
    for (int k = 0; k < kSteps && i > 0; ++k)
      degc +=
          (at_case(t - recipe.step_s * (1.0 - (k + 0.5) / kSteps)) - degc) * recipe.step_s / kSteps / tau_s;
    const double hz = f_of(degc), f = hz - 4432.0, df = (hz - f_before) / recipe.step_s;
    f_before = hz;
    const double a = recipe.dwell_s > 0.0 ? 1.0 + 0.1 * (static_cast<int>(t / recipe.dwell_s) % 3 - 1) : 1.0;
    const double values[] = {t,
                             std::round((at_case(t) + 0.01 * normal(random)) * 100.0) / 100.0,
                             at_case(t) + 5.0 + 0.02 * normal(random),
                             0.0,
                             0.0,
                             150.0,
                             0.0,
                             hz * (1.0 + recipe.duffing * (a * a - 1.0)) + 3e-5 * scale * normal(random),
                             a,
                             a * (2.0 + 0.004 * (degc - 20.0)) * (1.0 + recipe.leak_per_h * t / 3600.0) +
                                 2e-4 * scale * normal(random),
                             a * (0.8 + 0.002 * (degc - 20.0)) + 2e-4 * scale * normal(random),
                             1.5 + f * (0.2 - 0.004 * f) + 400.0 * df + 0.6 * scale * normal(random)};
    for (std::size_t c = 0; c < run.channels.size(); ++c) run.channels[c].values.push_back(values[c]);
  }
  return run;
}

constexpr const char* kModel = R"({
  "format": "hemi-model/1", "device": "test",
  "frequency": {"reference_degc": 0.0, "coefficients_hz": [4424.9, 0.3716, -9.7e-4, 1.53e-5]},
  "thermal": {"time_constant_s": 1900.0},
  "bias": {"reference_hz": 4432.0, "terms_dph": {"1": 1.5, "f": 0.2, "f^2": -0.004, "df": 400.0}},
  "scale_factor": 1.0,
  "drive": {"reference_degc": 20.0, "coefficients_v": [2.0, 0.004]},
  "quadrature": {"reference_degc": 20.0, "coefficients_v": [0.8, 0.002]},
  "amplitude": {"setpoint": 1.0},
  "noise": {"frequency_hz_rthz": 3e-5, "rate_dph_rthz": 0.6, "drive_v_rthz": 2e-4, "quadrature_v_rthz": 2e-4,
            "case_temp_degc": 0.01}})";

void remove(Recording& run, const std::string& channel) {
  std::erase_if(run.channels, [&](const auto& each) { return each.name == channel; });
}

class DiagnoseTelemetry : public ProgramTest {
 protected:
  void SetUp() override { file("unit.model.json", kModel); }

  Json diagnosed(const std::string& name, int code) {
    outcome_ = hemi({"diagnose", name, "--model", "unit.model.json", "-o", "out"});
    EXPECT_EQ(outcome_.code, code) << name << outcome_.out << outcome_.err;
    return recording::read_json_object(path("out/diagnosis.json"));
  }
  Json diagnosed(const Recording& run, int code) {
    recording::write_csv(path("run.csv"), run);
    return diagnosed("run.csv", code);
  }
  // Names as they are: the writer of recordings would refuse them.
  void write_text_csv(const Recording& run) const {
    std::string text;
    for (const auto& channel : run.channels) text += (text.empty() ? "" : ",") + channel.name;
    for (std::size_t i = 0; i < run.rows(); ++i)
      for (const auto& channel : run.channels)
        text += fmt::format("{}{}", &channel == run.channels.data() ? "\n" : ",", channel.values[i]);
    file("run.csv", text + "\n");
  }
  static Names named(const Json& json) {
    Names names;
    for (const auto& effect : json["effects"]) names.insert(effect["id"].get<std::string>());
    return names;
  }
  void expect_effects(const Json& json, const Names& effects) const {
    EXPECT_EQ(json["verdict"], effects.empty() ? "consistent" : "named");
    EXPECT_EQ(named(json), effects) << outcome_.out;
  }
  // In the JSON, on the terminal and in the report.
  void expect_not_testable(const Json& json, const std::string& id, const std::string& why) const {
    const auto& list = json["not_testable"];
    EXPECT_TRUE(std::ranges::any_of(list,
                                    [&](const Json& entry) {
                                      return entry["id"] == id &&
                                             entry["why"].get<std::string>().find(why) != std::string::npos;
                                    }))
        << id << " " << why << "\n"
        << list.dump(1);
    EXPECT_NE(outcome_.out.find(why), std::string::npos) << outcome_.out;
    EXPECT_NE(outcome_.out.find(id), std::string::npos) << outcome_.out;
    EXPECT_NE(content("out/report.html").find(why), std::string::npos);
  }
  Outcome outcome_;
};

struct Missing {
  std::vector<std::string> channels;
  Recipe recipe;  // one effect, that is still to be seen
  std::string found;
  std::vector<std::string> untestable;  // an effect a channel, that it would show
};
constexpr Recipe kLeak{.leak_per_h = 2e-3};
// Steps of an amplitude that is not recorded would be misfit of their own.
constexpr Recipe kLeakWithoutSteps{.dwell_s = 0.0, .leak_per_h = 2e-3};
constexpr Recipe kDuffing{.duffing = 1e-6};

class MissingChannels : public DiagnoseTelemetry, public ::testing::WithParamInterface<Missing> {};

TEST_P(MissingChannels, AreSaidAndTheRestIsDiagnosed) {
  const auto& [channels, recipe, found, untestable] = GetParam();
  auto run = telemetry(recipe);
  for (const auto& channel : channels) remove(run, channel);
  const Json json = diagnosed(run, 1);
  expect_effects(json, {found});
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto& absent = json["absent_channels"];
    EXPECT_EQ(std::count(absent.begin(), absent.end(), Json(channels[i])), 1);
    if (!untestable[i].empty())
      expect_not_testable(json, untestable[i], fmt::format("not recorded: {}", channels[i]));
  }
  EXPECT_EQ(json["absent_channels"].size(), channels.size());
}

INSTANTIATE_TEST_SUITE_P(
    Channels, MissingChannels,
    ::testing::Values(Missing{{"case_temp_degc"}, kLeak, "gas_leak", {"duffing"}},
                      Missing{{"amplitude"}, kLeakWithoutSteps, "gas_leak", {"damping_nonlinearity"}},
                      Missing{{"frequency_hz"}, kLeak, "gas_leak", {"thermal_second_time_constant"}},
                      Missing{{"drive_v"}, kDuffing, "duffing", {"gas_leak"}},
                      Missing{{"quadrature_v"}, kDuffing, "duffing", {"frequency_split"}},
                      Missing{{"rate_dph"}, kDuffing, "duffing", {"thermal_hysteresis"}},
                      Missing{{"board_temp_degc", "rate_in_dph", "accel_g", "supply_v", "quadrature_trim_v"},
                              kDuffing,
                              "duffing",
                              {"oscillator_temperature", "scale_factor_temperature", "g_sensitivity",
                               "electrostatic_softening", ""}}),
    [](const auto& each) { return each.param.channels.size() > 1 ? "options" : each.param.channels[0]; });

TEST_F(DiagnoseTelemetry, NothingIsNamedOnNothingWhateverIsMissing) {
  for (const Names& missing :
       std::vector<Names>{{"case_temp_degc"},
                          {"frequency_hz"},
                          {"drive_v", "quadrature_v", "board_temp_degc"},
                          {"rate_dph", "rate_in_dph", "accel_g", "supply_v", "quadrature_trim_v"}}) {
    auto run = telemetry(kNothing);
    for (const auto& channel : missing) remove(run, channel);
    SCOPED_TRACE(fmt::format("{}", fmt::join(missing, " ")));
    const Json json = diagnosed(run, 0);
    expect_effects(json, {});
    EXPECT_EQ(json["absent_channels"].size(), missing.size());
  }
}

TEST_F(DiagnoseTelemetry, TheCorrectedModelIsConsistentWithAnotherRunAndKeepsItsEffect) {
  Recipe recipe{.duffing = 1e-6};
  expect_effects(diagnosed(telemetry(recipe), 1), {"duffing"});
  recipe.seed = 2;
  recording::write_csv(path("other.csv"), telemetry(recipe));
  outcome_ = hemi({"diagnose", "other.csv", "--model", "out/corrected.model.json", "-o", "again"});
  EXPECT_EQ(outcome_.code, 0) << outcome_.out << outcome_.err;
  expect_effects(recording::read_json_object(path("again/diagnosis.json")), {});
  const Json corrected = recording::read_json_object(path("again/corrected.model.json"));
  ASSERT_EQ(corrected["effects"].size(), 1U);
  EXPECT_EQ(corrected["effects"][0]["id"], "duffing");
}

TEST_F(DiagnoseTelemetry, AnEffectWithNumbersThatItsFormHasNotIsRefused) {
  diagnosed(telemetry({.duffing = 1e-6}), 1);
  for (const char* bad :
       {R"({"shape": [], "coefficients": [1.0, 2.0]})", R"({"shape": [3.0], "coefficients": [1.0]})",
        R"({"shape": [], "coefficients": "many"})", R"({"coefficients": [1.0]})", "7"}) {
    Json model = recording::read_json_object(path("out/corrected.model.json"));
    model["effects"][0]["fit"] = Json::parse(bad);
    file("bad.model.json", model.dump());
    expect_bad({"diagnose", "run.csv", "--model", "bad.model.json", "-o", "out"},
               {"bad.model.json", "effects", "as hemi diagnose wrote it"});
  }
}

TEST_F(DiagnoseTelemetry, WithoutAnyThermometer) {
  auto run = telemetry(kNothing);
  for (const char* channel : {"case_temp_degc", "frequency_hz"}) remove(run, channel);
  recording::write_csv(path("run.csv"), run);
  expect_bad({"diagnose", "run.csv", "--model", "unit.model.json", "-o", "."},
             {"run.csv", "case_temp_degc", "frequency_hz"});
}

// Strong effect and nothing, each with the same damage.
class Damaged : public DiagnoseTelemetry {
 protected:
  void expect_both(const std::function<std::string(Recording&)>& damage, Recipe recipe = {}) {
    for (const double duffing : {1e-6, 0.0}) {
      SCOPED_TRACE(duffing);
      recipe.duffing = duffing;
      auto run = telemetry(recipe);
      const Json json = diagnosed(damage(run), duffing > 0.0 ? 1 : 0);
      expect_effects(json, duffing > 0.0 ? Names{"duffing"} : Names{});
    }
  }
  std::string csv(const Recording& run) const {
    recording::write_csv(path("run.csv"), run);
    return "run.csv";
  }
};

TEST_F(Damaged, Gaps) {
  expect_both([&](Recording& run) {
    for (auto& channel : run.channels) {
      auto& v = channel.values;
      v.erase(v.begin() + 1200, v.begin() + 1500);
      v.erase(v.begin() + 300, v.begin() + 320);
    }
    return csv(run);
  });
}

TEST_F(Damaged, MissingValues) {
  expect_both([&](Recording& run) {
    // Each channel elsewhere, the thermometer over three minutes.
    for (std::size_t c = 1; c < run.channels.size(); ++c) {
      const std::size_t length = run.channels[c].name == "case_temp_degc" ? 36 : 150;
      std::fill_n(run.channels[c].values.begin() + static_cast<std::ptrdiff_t>(140 * c), length,
                  std::nan(""));
    }
    return csv(run);
  });
}

TEST_F(Damaged, Hdf5) {
  expect_both([&](Recording& run) {
    recording::write_hdf5(path("run.h5"), run);
    return "run.h5";
  });
}

TEST_F(Damaged, ForeignNames) {
  expect_both([&](Recording& run) {
    Json columns;
    for (auto& channel : run.channels) {
      if (channel.name == "time_s") continue;
      const std::string foreign = "col " + channel.name + " [x]";
      columns[foreign] = channel.name;
      channel.name = foreign;
    }
    // Millivolts for volts, kelvin for degrees Celsius.
    columns["col drive_v [x]"] = {{"channel", "drive_v"}, {"scale", 1e-3}};
    columns["col case_temp_degc [x]"] = {{"channel", "case_temp_degc"}, {"offset", -273.15}};
    for (auto& channel : run.channels)
      for (double& value : channel.values) {
        if (channel.name == "col drive_v [x]") value *= 1e3;
        if (channel.name == "col case_temp_degc [x]") value += 273.15;
      }
    write_text_csv(run);
    file("run.json",
         Json{{"format", "hemi-recording/1"}, {"sample_rate_hz", 0.2}, {"columns", columns}}.dump());
    return "run.csv";
  });
}

// Five minutes; rows are averaged by two, and the diagnosis says what this hides.
TEST_F(Damaged, TwoHundredHertz) {
  expect_both([&](Recording& run) { return csv(run); },
              {.step_s = 0.005, .length_s = 300.0, .swing_degc = 2.0, .dwell_s = 25.0});
  expect_not_testable(recording::read_json_object(path("out/diagnosis.json")), "cycle_slip",
                      "rows were averaged");
}

// Eight hours at 1 Hz; early in the search, and late in it.
TEST_F(DiagnoseTelemetry, CtrlCEndsItWithinASecondAndLeavesNoFile) {
  recording::write_csv(path("run.csv"), telemetry({.step_s = 1.0, .length_s = 28800.0, .duffing = 1e-6}));
  const auto before = names();
  for (const int delay_ms : {500, 1500}) {
    SCOPED_TRACE(delay_ms);
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome =
        hemi_interrupted({"diagnose", "run.csv", "--model", "unit.model.json", "-o", "."}, delay_ms);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_EQ(outcome.err, "hemi: interrupted; nothing half-written is left\n");
    EXPECT_EQ(names(), before);
    // A second on a machine of one's own; ten where others work on it too.
    EXPECT_LT(taken.count(), 10.0 + 1e-3 * delay_ms);
    fmt::print("signal after {} ms: ended after {:.3f} s\n", delay_ms, taken.count());
  }
}

}  // namespace
}  // namespace hemi::cli::testing
