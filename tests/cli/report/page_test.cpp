// SPDX-License-Identifier: Apache-2.0
// Whole pages as text: nothing from elsewhere, everything of the document there, limits of size.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "cli/recording/error.hpp"
#include "cli/report/prove_report.hpp"
#include "tests/cli/report/pages.hpp"

namespace hemi::report {
namespace {

namespace fs = std::filesystem;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

fs::path scratch(const std::string& name) {
  const fs::path directory = fs::path(testing::TempDir()) / ("hemi_report_" + name);
  fs::remove_all(directory);
  fs::create_directories(directory);
  return directory;
}

std::string text_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Page, NamesNothingOutsideItself) {
  const std::string html = to_html(report_test::mixed_report());
  // Addresses occur in the comment of uPlot's licence alone, and nowhere as something to load.
  const std::regex loads(R"((src|href)\s*=\s*["'](?!#|data:)|url\((?!#)|@import|<link[^>]*https?:)");
  std::smatch found;
  EXPECT_FALSE(std::regex_search(html, found, loads)) << found.str();
  EXPECT_EQ(count(html, "default-src 'none'"), 1U);
}

TEST(Page, TextOfADocumentIsNoMarkup) {
  const std::string html = to_html(report_test::mixed_report());
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("<i>no markup"), std::string::npos);
  EXPECT_EQ(html.find("<em>text"), std::string::npos);
  // Three data blocks, uPlot and the page's own: every script that opens is closed once.
  EXPECT_EQ(count(html, "<script"), 5U);
  EXPECT_EQ(count(html, "</script>"), 5U);
}

TEST(Page, DiagnosisSaysAllThatTheJsonHolds) {
  const auto directory = scratch("diagnosis");
  const std::string path = (directory / "report.html").string();
  write_diagnosis_report(path, report_test::diagnosis_json(), report_test::diagnosis_series(),
                         {.command = "hemi diagnose x"});
  const std::string html = text_of_file(path);
  for (const char* words :
       {"The model leaves out thermal gradient bias: with it the residual of rate_dph falls on rows left out "
        "of the fit "
        "from 3.11 to 0.655 deg/h rms (floor 0.6).",
        "83.0 %", "2400 to 5200 s; 9000 to 11800 s", "case_temp_degc −20 to −5, cooling", "R += g (T1 - T2)",
        "1.71 to 1.95", "deg/h/degC", "2.1 to 2.8", "0 of 54", "3.1·10⁻⁸", "cannot be excluded",
        "thermal hysteresis", "the same cycle at half the ramp rate", "corrected.model.json",
        "hemi diagnose x", "p = 0.4", " marked\" data-stage=\"thermal\"", "Allan deviation of the residual",
        "Spectrum of the residual"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  // Two stretches shaded in one plot, and the rows left out.
  EXPECT_EQ(count(html, "<rect class=\"shade\""), 2U);
  EXPECT_EQ(count(html, "<rect class=\"shade quiet\""), 1U);
}

TEST(Page, DiagnosisOfEveryVerdictAndOfBrokenJson) {
  const auto directory = scratch("verdicts");
  const std::string path = (directory / "report.html").string();
  for (const char* verdict : {"consistent", "recalibrate", "named", "ambiguous", "unknown", "", "else"}) {
    recording::Json json = {{"verdict", verdict}};
    write_diagnosis_report(path, json, {});
    EXPECT_NE(text_of_file(path).find("<h1 id=\"verdict\""), std::string::npos) << verdict;
    // Keys of other types than the format's are passed over.
    for (const char* key :
         {"located", "effects", "alternatives", "improvement", "detection_limits", "residual_after"})
      for (const recording::Json& odd :
           {recording::Json(3), recording::Json("x"), recording::Json::array({1, "y", nullptr}),
            recording::Json({{"z", 1}})}) {
        json[key] = odd;
        EXPECT_NO_THROW(write_diagnosis_report(path, json, {})) << verdict << ' ' << key << ' ' << odd;
      }
  }
  ReportSeries uneven{.channel = "rate_dph", .unit = "deg/h", .time_s = {0, 1}, .before = {1}};
  EXPECT_THROW(write_diagnosis_report(path, report_test::diagnosis_json(), {uneven}), std::invalid_argument);
}

TEST(Page, ProofShowsFiguresTargetsAndConfusion) {
  const auto directory = scratch("proof");
  const std::string path = (directory / "prove.html").string();
  write_prove_report(path, report_test::proof_json());
  const std::string html = text_of_file(path);
  for (const char* words :
       {"1 of 4 figures misses its target over 60 concealed recordings: right name first, effect at 10 x its "
        "limit and more.",
        "0.742 to 0.977", "≥ 95 %", "missed", "not measured", "lasso", "0.625", "single-013"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  EXPECT_EQ(count(html, "class=\"stands-out\""), 1U);
  // Three truths of the program and one of the rival stand among the answers.
  EXPECT_EQ(count(html, "<td class=\"same\""), 4U);
  // A target of two numbers has two ticks.
  EXPECT_EQ(count(html, "class=\"target\""), 5U);
  recording::Json held = report_test::proof_json();
  held["rows"][1]["held"] = true;
  write_prove_report(path, held);
  EXPECT_NE(text_of_file(path).find("All 4 figures with a target hold over 60 concealed recordings."),
            std::string::npos);
  for (const char* key : {"rows", "classes", "confusion", "failures", "rivals"})
    for (const recording::Json& odd :
         {recording::Json(3), recording::Json("x"), recording::Json::array({1, "y", nullptr}),
          recording::Json({{"z", 1}})}) {
      recording::Json broken = report_test::proof_json();
      broken[key] = odd;
      EXPECT_NO_THROW(write_prove_report(path, broken)) << key << ' ' << odd;
    }
}

TEST(Page, SixLongChannelsStayBelowTwoMegabytes) {
  const auto t = report_test::telemetry(400000, 200.0);
  const std::string html = to_html(report_test::telemetry_report(t));
  EXPECT_LT(html.size(), 2000000U);
  // Many more curves are thinned together.
  Report many = report_test::telemetry_report(t);
  for (int i = 0; i < 4; ++i) many.sections.push_back(many.sections.front());
  EXPECT_LT(to_html(many).size(), 3000000U);
}

TEST(Page, WritesWholeOrNotAtAll) {
  const auto directory = scratch("paths");
  EXPECT_EQ(report_path((directory / "a.html").string(), "run"), (directory / "a.html").string());
  EXPECT_EQ(report_path((directory / "new" / "deep").string(), "run"),
            (directory / "new" / "deep" / "run.html").string());
  EXPECT_TRUE(fs::is_directory(directory / "new" / "deep"));
  EXPECT_THROW(write_report((directory / "absent" / "a.html").string(), report_test::mixed_report()),
               recording::OutputError);
  std::ofstream(directory / "file") << "x";
  EXPECT_THROW(report_path((directory / "file").string(), "run"), recording::OutputError);
  write_report((directory / "a.html").string(), report_test::mixed_report());
  EXPECT_EQ(std::distance(fs::directory_iterator(directory), fs::directory_iterator{}), 3);
}

TEST(Page, CommandsCanBeTypedAgain) {
  EXPECT_EQ(command_line({"hemi", "run", "a b.csv", "it's", "", "-o", "x.html"}),
            "hemi run 'a b.csv' 'it'\\''s' '' -o x.html");
}

}  // namespace
}  // namespace hemi::report
