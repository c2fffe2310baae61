// SPDX-License-Identifier: Apache-2.0
// The comparison's page where engines differ: named in the verdict, marked in the chain, both curves drawn.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/pages.hpp"

namespace hemi::cli {
namespace {

recording::Recording outputs(double step) {
  recording::Recording out{.sample_rate_hz = 200.0};
  out.channels = {{"time_s", "s", {}}, {"frequency_hz", "Hz", {}}, {"rate_dph", "deg/h", {}}};
  for (int i = 0; i < 400; ++i) {
    out.channels[0].values.push_back(i / 200.0);
    out.channels[1].values.push_back(4425.0 + (i >= 250 ? step : 0.0));
    out.channels[2].values.push_back(2.0 + 0.01 * (i % 7));
  }
  return out;
}

TEST(ComparePage, FirstDifferenceIsNamedAndMarked) {
  ComparePage page{.recording = "capture.raw.csv"};
  page.pairs = {{.first = "golden", .second = "hls", .records = 400, .words = 90000},
                {.first = "golden",
                 .second = "rtl",
                 .equal = false,
                 .records = 400,
                 .differing_records = 150,
                 .words = 70000,
                 .block = "cic",
                 .word = "cic_yq",
                 .sample = 125019,
                 .report = "cic, word cic_yq, sample 125019\n  golden 0x0001f3\n  rtl    0x0001f2\n"}};
  page.outputs = outputs(0.0);
  page.other_outputs = outputs(2e-6);
  page.differing = "rtl";
  const auto directory = std::filesystem::path(HEMI_BINARY_DIR) / "tests/cli/report/pages/compare";
  const std::string path = write_compare_page(directory.string(), page);
  std::ifstream file(path, std::ios::binary);
  const std::string html{std::istreambuf_iterator<char>(file), {}};
  for (const char* words : {"golden and rtl differ first in cic, in its word cic_yq at sample 125019.",
                            " marked\" data-stage=\"cic\"", "golden and hls", "no differing bit", "0x0001f2",
                            "<span>rtl</span>", "<span>golden</span>"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  // In both drawings of the chain, and no other block.
  std::size_t marks = 0;
  for (auto at = html.find(" marked\" data-stage"); at != std::string::npos;
       at = html.find(" marked\" data-stage", at + 1))
    ++marks;
  EXPECT_EQ(marks, 2U);
}

}  // namespace
}  // namespace hemi::cli
