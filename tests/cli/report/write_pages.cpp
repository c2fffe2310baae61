// SPDX-License-Identifier: Apache-2.0
// write_pages DIRECTORY small|large: the pages that browser_test.mjs opens, and what must be found in them.
#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <filesystem>

#include "cli/recording/write.hpp"
#include "cli/report/prove_report.hpp"
#include "tests/cli/report/pages.hpp"

int main(int argc, char** argv) {
  using namespace hemi;
  if (argc != 3) return 2;
  const std::filesystem::path directory(argv[1]);
  std::filesystem::create_directories(directory);
  const bool large = std::strcmp(argv[2], "large") == 0;
  // Five hours at 200 Hz.
  const auto telemetry = large ? report_test::telemetry(3600000, 200.0) : report_test::telemetry(30000, 10.0);
  const auto start = std::chrono::steady_clock::now();
  const std::string name = large ? "large" : "telemetry";
  report::write_report((directory / (name + ".html")).string(), report_test::telemetry_report(telemetry));
  fmt::print("{}.html in {:.2f} s\n", name,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  recording::Json spikes = recording::Json::array();
  for (const auto& s : telemetry.spikes)
    spikes.push_back({{"channel", s.channel}, {"time_s", s.time_s}, {"value", s.value}});
  recording::write_text((directory / (name + ".spikes.json")).string(), recording::json_text(spikes));
  if (large) return 0;
  report::write_report((directory / "mixed.html").string(), report_test::mixed_report());
  report::write_prove_report((directory / "prove.html").string(), report_test::proof_json());
  report::write_diagnosis_report((directory / "diagnosis.html").string(), report_test::diagnosis_json(),
                                 report_test::diagnosis_series(),
                                 {.command = "hemi diagnose chamber-14.csv -m HRG-A17.model.json -o out"});
}
