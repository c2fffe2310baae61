// SPDX-License-Identifier: Apache-2.0
// hemi report, and --report of the other commands: a page with the verdict, or a refusal that leaves nothing.
#include <fmt/format.h>

#include <filesystem>
#include <regex>

#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class ReportPages : public ProgramTest {
 protected:
  std::string verdict(const std::string& page) const {
    const std::string html = content(page);
    std::smatch found;
    if (!std::regex_search(html, found, std::regex("<h1 id=\"verdict\"[^>]*>([^<]*)</h1>")))
      return "none in " + page;
    return found[1];
  }
  bool holds(const std::string& page, const std::string& text) const {
    return content(page).find(text) != std::string::npos;
  }
};

TEST_F(ReportPages, RecordingAndAStretchOfItAsThePageSays) {
  write_telemetry(20000, 5000, 5010);
  const auto whole = good({"report", "chamber.csv", "-o", "whole.html", "--json"}).json();
  EXPECT_EQ(whole["verdict"], verdict("whole.html"));
  EXPECT_NE(verdict("whole.html").find("10 rows missing in 1 gap"), std::string::npos)
      << verdict("whole.html");
  EXPECT_TRUE(holds("whole.html", "extremes of short stretches"));
  // The command that the page prints, with the ends of the whole.
  std::smatch found;
  const std::string html = content("whole.html");
  ASSERT_TRUE(std::regex_search(
      html, found,
      std::regex(
          "<code>hemi report chamber.csv --from ([0-9.]+) --to ([0-9.]+) --full -o stretch.html</code>")));
  EXPECT_EQ(found[1], "0");
  good({"report", "chamber.csv", "--from", found[1], "--to", found[2], "--full", "-o", "stretch.html"});
  EXPECT_TRUE(holds("stretch.html", "every sample"));
  EXPECT_GT(content("stretch.html").size(), content("whole.html").size());
  good({"report", "chamber.csv", "--from", "10", "--to", "20", "-c", "rate_dph", "-o", "part"});
  EXPECT_EQ(verdict("part/report.html"), "1 channel from 10 s to 20 s, 101 rows at 10 Hz, no row missing.");
}

TEST_F(ReportPages, RawCapture) {
  write_tone(30000);
  good({"report", "tone.raw.csv", "--from", "0.1", "--to", "0.12", "--full", "-o", "tone.html"});
  EXPECT_NE(verdict("tone.html").find("2 channels from 0.1 s to 0.12 s, 2001 rows at 100000 Hz"),
            std::string::npos)
      << verdict("tone.html");
}

TEST_F(ReportPages, EveryCommandWritesItsPage) {
  write_tone(60000);
  write_model();
  write_telemetry(6000);
  good({"run", "tone.raw.csv", "-f", "4425", "-o", "out.csv", "--report", "pages"});
  EXPECT_TRUE(verdict("pages/run.html").starts_with("Locked for ")) << verdict("pages/run.html");
  EXPECT_TRUE(holds("pages/run.html", "hemi report out.csv --from "));
  const auto run = good({"run", "chamber.csv", "-m", "hrg.model.json", "--report", "pages", "--json"}).json();
  EXPECT_EQ(run["report"], "pages/run.html");
  EXPECT_TRUE(verdict("pages/run.html").starts_with("Compensation ")) << verdict("pages/run.html");
  good({"compare", "tone.raw.csv", "-f", "4425", "-e", "golden,hls,ideal", "--report", "pages/c.html"});
  EXPECT_TRUE(verdict("pages/c.html").starts_with("golden = hls: no differing bit in "))
      << verdict("pages/c.html");
  EXPECT_TRUE(holds("pages/c.html", "ideal against golden"));
  const auto allan = good({"allan", "chamber.csv", "--report", "pages", "--json"}).json();
  EXPECT_EQ(allan["report"], "pages/allan.html");
  EXPECT_NE(verdict("pages/allan.html").find("bias instability of rate_dph"), std::string::npos);
  const std::string table = std::string(HEMI_SOURCE_DIR) + "/tests/data/paper_table1.csv";
  good({"calibrate", table, "--order", "3", "--report", "pages"});
  EXPECT_TRUE(
      verdict("pages/calibration.html").starts_with("f(T) of order 3 passes the settled points within "));
  EXPECT_TRUE(holds("pages/calibration.html", "--order 3 --report pages</code>"));
}

TEST_F(ReportPages, Refusals) {
  write_telemetry(500);
  expect_bad({"report", "chamber.csv", "--from", "1000", "-o", "a.html"}, {"chamber.csv", "no row"});
  expect_bad({"report", "chamber.csv", "-c", "rate_dhp", "-o", "a.html"}, {"rate_dhp"});
  expect_bad({"report", "chamber.csv", "--from", "9", "--to", "3", "-o", "a.html"}, {"--from"});
  expect_bad({"report", "absent.csv", "-o", "a.html"}, {"absent.csv"});
  expect_bad({"report", "chamber.csv", "-o", "absent/a.html"}, {"absent/a.html"});
  expect_bad({"allan", "chamber.csv", "--report", "chamber.csv"}, {"chamber.csv", "another name"});
}

}  // namespace
}  // namespace hemi::cli::testing
