// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "cli/commands.hpp"
#include "cli/engines.hpp"
#include "cli/output.hpp"
#include "cli/recording/channels.hpp"
#include "cli/recording/json.hpp"
#include "hls/config.hpp"

namespace hemi::cli {
namespace {

std::string q_notation(const config::Format& f) {
  return fmt::format("Q{}.{}", f.width - f.fraction, f.fraction);
}

recording::Json as_json() {
  recording::Json json;
  json["version"] = HEMI_VERSION;
  for (std::size_t i = 0; i < engine_names().size(); ++i)
    json["engines"][engine_names()[i]] = engine_meanings()[i];
  for (const bool wide : {false, true}) {
    const Sampling s = sampling(wide);
    json["instruments"][wide ? "wide" : "reference"] = {
        {"adc_bits", s.adc_bits},
        {"adc_rate_hz", s.adc_rate_hz},
        {"decimation", s.decimation},
        {"samples_per_output", s.decimation * config::ticks_per_output}};
  }
  for (const auto& r : config::registers) {
    json["registers"].push_back({{"name", r.name},
                                 {"width", r.format.width},
                                 {"fraction", r.format.fraction},
                                 {"unit", r.unit},
                                 {"meaning", r.meaning}});
  }
  for (int i = 0; i < config::status_bits; ++i) json["status_bits"].push_back(config::status_names[i]);
  return json;
}

void print_text() {
  fmt::print("hemi {}\n\nEngines\n", HEMI_VERSION);
  for (std::size_t i = 0; i < engine_names().size(); ++i)
    fmt::print("  {:<8} {}\n", engine_names()[i], engine_meanings()[i]);
  fmt::print("\nInstruments\n");
  for (const bool wide : {false, true}) {
    const Sampling s = sampling(wide);
    fmt::print(
        "  {:<10} {} bit, {:.0f} samples/s nominal, outputs every {} samples; amplitude word of a full-scale "
        "tone {:.6f}\n",
        wide ? "wide" : "reference", s.adc_bits, s.adc_rate_hz, s.decimation * config::ticks_per_output,
        full_scale_amplitude(s));
  }
  fmt::print("\nBlocks, their output words and formats\n");
  for (const auto& tap : config::taps)
    fmt::print("  {:<22} {:<22} {:<8} {}\n", tap.block, tap.name, q_notation(tap.format), tap.unit);
  fmt::print("\nRegisters\n");
  for (int i = 0; i < config::register_count; ++i) {
    const auto& r = config::registers[i];
    fmt::print("  {:>2} {:<22} {:<8} {:<18} {}\n", i, r.name, q_notation(r.format), r.unit, r.meaning);
  }
  fmt::print("\nStatus bits (live; sticky {} higher)\n", config::status_shift);
  for (int i = 0; i < config::status_bits; ++i) fmt::print("  {:>2} {}\n", i, config::status_names[i]);
  fmt::print("\nChannels of recordings\n");
  for (const auto& c : recording::known_channels())
    fmt::print("  {:<22} {:<6} {}\n", c.name, c.unit, c.meaning);
}

}  // namespace

void add_info(CLI::App& app, Job& job) {
  auto json = std::make_shared<bool>(false);
  auto* command =
      app.add_subcommand("info", "Engines, instruments, word formats, registers, status bits, channels");
  command->add_flag("--json", *json, "as JSON");
  command->footer("Example: hemi info --json");
  command->callback([json, &job] {
    job = [json] {
      if (*json)
        fmt::print("{}\n", recording::json_text(as_json(), 2));
      else
        print_text();
      return exit_good;
    };
  });
}

}  // namespace hemi::cli
