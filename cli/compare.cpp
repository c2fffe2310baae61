// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cli/chain_run.hpp"
#include "cli/commands.hpp"
#include "cli/engines.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/pages.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/progress.hpp"
#include "cli/waves_file.hpp"
#include "tb/registers.hpp"
#include "tb/scoreboard.hpp"

namespace hemi::cli {
namespace {

struct CompareOptions {
  std::string recording;
  std::vector<std::string> engines = {"golden", "hls", "rtl", "systemc"};
  std::string model;
  std::optional<double> frequency_hz;
  std::optional<double> adc_rate_hz;
  EngineOptions engine;
  std::string report;
  bool json = false;
};

/// What the engines are fed with: one of the two.
struct Input {
  Setup setup;
  std::vector<tb::SamplePair> pairs;
  std::optional<TelemetryInput> telemetry;
};

Input read_input(const CompareOptions& options) {
  std::optional<recording::InstrumentModel> model;
  if (!options.model.empty()) model = recording::read_model(options.model);
  Input input;
  if (recording::is_raw(options.recording)) {
    recording::RawOptions raw;
    raw.sample_rate_hz = options.adc_rate_hz;
    const auto capture = recording::read_raw_capture(options.recording, raw);
    input.setup = capture_setup(capture, model ? &*model : nullptr, options.frequency_hz, std::nullopt);
    require_an_output(capture, input.setup);
    print_notes(capture.notes);
    print_gaps(capture.gaps);
    input.pairs = sample_pairs(capture);
    return input;
  }
  if (!model) {
    throw recording::InputError({options.recording},
                                "telemetry goes through thermometer and bias model, and no model is given",
                                "give --model M.model.json; hemi calibrate makes one");
  }
  const auto recording = recording::read_recording(options.recording);
  input.setup = telemetry_setup(recording.sample_rate_hz, *model, std::nullopt);
  input.telemetry = telemetry_input(recording, *model);
  print_notes(input.telemetry->notes);
  print_gaps(recording.gaps);
  return input;
}

/// Telemetry itself is no output of a block: not every engine sends it to its taps.
class WithoutInputs : public tb::TapSink {
 public:
  explicit WithoutInputs(tb::TapSink& sink) : sink_(sink) {}
  void tap(config::TapIndex index, std::int64_t raw) override {
    if (index != config::tap_frequency && index != config::tap_rate) sink_.tap(index, raw);
  }

 private:
  tb::TapSink& sink_;
};

/// Only the rtl engine leaves waves.
EngineOptions for_engine(const std::string& name, EngineOptions options) {
  if (name != "rtl") options.waves.clear();
  return options;
}

struct PairResult {
  std::optional<tb::Mismatch> mismatch;
  std::uint64_t records = 0;
  std::uint64_t differing_records = 0;
  std::uint64_t words = 0;
  std::vector<tb::Record> first_records, second_records;
};

/// Both engines in step over the same chunks, until the end or the first difference.
PairResult compare_pair(const Input& input, const std::string& first, const std::string& second,
                        const EngineOptions& options) {
  const auto a = make_engine(first, input.setup.wide, for_engine(first, options));
  const auto b = make_engine(second, input.setup.wide, for_engine(second, options));
  tb::Scoreboard scoreboard(input.telemetry ? 0 : sampling(input.setup.wide).decimation);
  a->reset(input.setup.values);
  b->reset(input.setup.values);
  WithoutInputs first_outputs(scoreboard.first()), second_outputs(scoreboard.second());
  a->set_taps(input.telemetry ? &first_outputs : &scoreboard.first());
  b->set_taps(input.telemetry ? &second_outputs : &scoreboard.second());
  const std::size_t total = input.telemetry ? input.telemetry->time_s.size() : input.pairs.size();
  constexpr std::size_t chunk = 5000;
  recording::Progress progress(first + " and " + second,
                               static_cast<double>(std::max<std::size_t>(total, 1)));
  std::vector<tb::Record> ra, rb;
  PairResult result;
  for (std::size_t i = 0; i < total && !scoreboard.mismatch(); i += chunk) {
    const std::size_t n = std::min(chunk, total - i);
    for (auto [engine, records] : {std::pair{a.get(), &ra}, std::pair{b.get(), &rb}}) {
      if (!input.telemetry) engine->samples({input.pairs.data() + i, n}, *records);
      for (std::size_t k = i; input.telemetry && k < i + n; ++k) {
        engine->telemetry(input.telemetry->frequency_hz[k], input.telemetry->rate_dph[k],
                          input.telemetry->frequency_valid[k], *records);
      }
    }
    scoreboard.compare();
    progress.update(static_cast<double>(i + n));
    recording::check_interrupt();
  }
  scoreboard.finish();
  result.mismatch = scoreboard.mismatch();
  result.words = scoreboard.compared();
  result.records = std::max(ra.size(), rb.size());
  result.differing_records = result.records - std::min(ra.size(), rb.size());
  for (std::size_t i = 0; i < std::min(ra.size(), rb.size()); ++i)
    result.differing_records += ra[i] == rb[i] ? 0 : 1;
  result.first_records = std::move(ra);
  result.second_records = std::move(rb);
  return result;
}

constexpr std::array word_names = {"frequency",   "temperature", "derivative", "amplitude",
                                   "phase_error", "bias",        "rate",       "compensated"};
constexpr std::array word_units = {"Hz", "degC", "full scale", "1", "turns", "deg/h", "deg/h", "deg/h"};

struct WordDifference {
  double largest = 0.0;
  double rms = 0.0;
};
using Differences = std::array<WordDifference, word_names.size()>;

/// The ideal chain has no bits to compare: largest and rms difference of each word, once the frequency is
/// valid.
Differences ideal_differences(const Input& input, const std::string& other) {
  std::array<std::vector<tb::Record>, 2> records;
  const std::array names = {std::string("ideal"), other};
  for (int k = 0; k < 2; ++k) {
    const auto engine = make_engine(names[k], input.setup.wide);
    engine->reset(input.setup.values);
    records[k] = input.telemetry ? run_telemetry(*engine, *input.telemetry, input.setup)
                                 : run_samples(*engine, input.pairs);
  }
  Differences differences;
  for (std::size_t w = 0; w < word_names.size(); ++w) {
    double largest = 0, square = 0;
    std::size_t n = 0;
    for (std::size_t i = 2; i < std::min(records[0].size(), records[1].size()); ++i, ++n) {
      const double d = records[1][i].words[w] - records[0][i].words[w];
      largest = std::max(largest, std::abs(d));
      square += d * d;
    }
    differences[w] = {largest, std::sqrt(square / static_cast<double>(std::max<std::size_t>(n, 1)))};
  }
  return differences;
}

std::string differences_text(const Differences& differences, const std::string& other) {
  std::string text = fmt::format("ideal against {}: differences after the start\n", other);
  for (std::size_t w = 0; w < word_names.size(); ++w)
    text += fmt::format("  {:<12} largest {:.3g}, rms {:.3g} {}\n", word_names[w], differences[w].largest,
                        differences[w].rms, word_units[w]);
  return text;
}

recording::Json differences_json(const Differences& differences) {
  recording::Json json;
  for (std::size_t w = 0; w < word_names.size(); ++w)
    json[word_names[w]] = {
        {"unit", word_units[w]}, {"largest", differences[w].largest}, {"rms", differences[w].rms}};
  return json;
}

void check(const CompareOptions& options) {
  const auto& engines = options.engines;
  for (auto name = engines.begin(); name != engines.end(); ++name) {
    check_engine_name(*name);
    if (std::find(engines.begin(), name, *name) == name) continue;
    throw recording::InputError({}, fmt::format("engine {} is named twice", *name), "name it once");
  }
  if (engines.size() < 2) {
    throw recording::InputError({}, "one engine has nothing to be compared with",
                                "name two or more: --engines golden,hls");
  }
  if (!options.engine.waves.empty() && std::find(engines.begin(), engines.end(), "rtl") == engines.end()) {
    throw recording::InputError({}, "--waves shows the rtl engine, which is not among the engines",
                                "add rtl to --engines");
  }
  refuse_settled_points(options.recording);
  refuse_overwriting({options.engine.waves, options.report}, {options.recording, options.model});
}

/// Records as channels over time; of telemetry at its own times.
recording::Recording outputs(const Input& input, const std::vector<tb::Record>& records) {
  std::vector<double> time_s(records.size());
  for (std::size_t i = 0; i < records.size(); ++i)
    time_s[i] = input.telemetry ? input.telemetry->time_s[i] : output_time_s(i, input.setup);
  return to_recording(records, time_s, input.setup, input.telemetry.has_value());
}

/// Notes a pair for the report; the outputs of the first pair, or of the first one that differs.
void note(const Input& input, const std::string& first, const std::string& second, const PairResult& result,
          ComparePage& page) {
  ComparedPair pair{first,
                    second,
                    !result.mismatch && result.differing_records == 0,
                    result.records,
                    result.differing_records,
                    result.words,
                    {},
                    {},
                    0,
                    {}};
  if (result.mismatch) {
    pair.block = config::taps[result.mismatch->tap].block;
    pair.word = config::taps[result.mismatch->tap].name;
    pair.sample = result.mismatch->sample;
    pair.report = result.mismatch->report(first, second);
  }
  const bool first_to_differ = !pair.equal && page.differing.empty();
  if (page.pairs.empty() || first_to_differ) page.outputs = outputs(input, result.first_records);
  if (first_to_differ) {
    page.other_outputs = outputs(input, result.second_records);
    page.differing = second;
  }
  page.pairs.push_back(std::move(pair));
}

int compare(CompareOptions options) {
  check(options);
  const Input input = read_input(options);
  const bool ideal =
      std::find(options.engines.begin(), options.engines.end(), "ideal") != options.engines.end();
  std::erase(options.engines, "ideal");
  WavesFile waves(options.engine.waves);
  options.engine.waves = waves.partial();
  int code = exit_good;
  ComparePage page{.recording = options.recording};
  recording::Json json = recording::Json::array();
  for (std::size_t k = 1; k < options.engines.size(); ++k) {
    const auto& first = options.engines[0];
    const auto& second = options.engines[k];
    const PairResult result = compare_pair(input, first, second, options.engine);
    recording::Json entry{{"engines", {first, second}},
                          {"records", result.records},
                          {"words", result.words},
                          {"equal", !result.mismatch}};
    if (!result.mismatch && result.differing_records == 0) {
      if (!options.json)
        fmt::print("{} = {}: no differing bit in {} records, {} words of all blocks compared\n", first,
                   second, result.records, result.words);
    } else {
      code = exit_difference;
      entry["equal"] = false;
      if (result.mismatch) {
        entry["sample"] = result.mismatch->sample;
        entry["block"] = config::taps[result.mismatch->tap].block;
        entry["word"] = config::taps[result.mismatch->tap].name;
      }
      if (!options.json) {
        fmt::print("{} and {} differ: {} of {} records before the comparison stopped\n{}", first, second,
                   result.differing_records, result.records,
                   result.mismatch ? result.mismatch->report(first, second)
                                   : "  although all blocks agree: the record itself\n");
      }
    }
    json.push_back(entry);
    if (!options.report.empty()) note(input, first, second, result, page);
  }
  waves.commit();
  if (ideal) {
    const auto differences = ideal_differences(input, options.engines.front());
    json.push_back(
        {{"engines", {"ideal", options.engines.front()}}, {"differences", differences_json(differences)}});
    page.ideal = differences_text(differences, options.engines.front());
    if (!options.json) fmt::print("{}", page.ideal);
  }
  if (!options.report.empty()) {
    const std::string path = write_compare_page(options.report, page);
    if (!options.json) fmt::print("wrote {}\n", path);
  }
  if (options.json) fmt::print("{}\n", recording::json_text(json, 2));
  return code;
}

}  // namespace

void add_compare(CLI::App& app, Job& job) {
  auto options = std::make_shared<CompareOptions>();
  auto* command = app.add_subcommand(
      "compare", "A recording through several engines, word by word: the first difference, where and why");
  command->add_option("recording", options->recording, "raw capture or telemetry")->required();
  command
      ->add_option("-e,--engines", options->engines,
                   "two or more of ideal, golden, hls, rtl, systemc; each is compared with the first")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("-m,--model", options->model, "instrument model (hemi-model/1)");
  command
      ->add_option("-f,--frequency", options->frequency_hz,
                   "where the nco starts [Hz]; default: the model's at 20 degC")
      ->check(positive_number());
  command
      ->add_option("--adc-rate", options->adc_rate_hz,
                   "ADC rate of a capture that does not say it [samples/s]")
      ->check(positive_number());
  command
      ->add_option("--gaps", options->engine.gap_probability,
                   "chance of a clock without input (rtl, systemc)")
      ->check(number_between(0.0, 0.99));
  command
      ->add_option("--back-pressure", options->engine.back_pressure_probability,
                   "chance of a clock without output (rtl, systemc)")
      ->check(number_between(0.0, 0.99));
  command->add_option("--seed", options->engine.seed, "of gaps and back-pressure")->capture_default_str();
  command->add_option("--waves", options->engine.waves, "FST file of the rtl engine's signals");
  command->add_option("--report", options->report, report_option_help);
  command->add_flag("--json", options->json, "result as JSON");
  command->footer(
      "Example: hemi compare capture.raw.csv --frequency 4425 --engines golden,hls,rtl --gaps 0.2 "
      "--back-pressure 0.3\n"
      "Exit code 1 when a bit differs. The ideal engine has no bits: its differences are printed as "
      "figures.");
  command->callback([options, &job] { job = [options] { return compare(*options); }; });
}

}  // namespace hemi::cli
