// SPDX-License-Identifier: Apache-2.0
// The envelope, the ticks, the spectrum and the markup, each against what it promises.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "cli/report/chain.hpp"
#include "cli/report/envelope.hpp"
#include "cli/report/markup.hpp"
#include "cli/report/plot_svg.hpp"
#include "cli/report/residuals.hpp"
#include "cli/report/ticks.hpp"
#include "hls/config.hpp"

namespace hemi::report {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

struct Samples {
  std::vector<double> x, y;
};
Samples noise(std::size_t rows, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Samples s;
  for (std::size_t i = 0; i < rows; ++i) {
    s.x.push_back(0.005 * static_cast<double>(i));
    s.y.push_back(normal(generator));
  }
  return s;
}

TEST(Envelope, EveryBucketKeepsItsExtremesAndEveryPointIsASample) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    Samples s = noise(10007, seed);
    // Rows that are not equally spaced as well.
    for (double& x : s.x) x = x * (1.0 + 0.1 * std::sin(0.01 * x));
    const std::size_t buckets = 137;
    const Points e = envelope(s.x, s.y, buckets);
    ASSERT_LE(e.x.size(), 2 * buckets + 2);
    EXPECT_EQ(e.x.front(), s.x.front());
    EXPECT_EQ(e.x.back(), s.x.back());
    EXPECT_EQ(e.samples, s.x.size());
    std::size_t row = 0;
    for (std::size_t i = 0; i < e.x.size(); ++i) {
      while (row < s.x.size() && s.x[row] < e.x[i]) ++row;
      ASSERT_LT(row, s.x.size());
      EXPECT_EQ(s.x[row], e.x[i]);
      EXPECT_EQ(s.y[row], e.y[i]);
    }
    const double width = (s.x.back() - s.x.front()) / static_cast<double>(buckets);
    for (std::size_t b = 0; b < buckets; ++b) {
      double low = 1e9, high = -1e9, kept_low = 1e9, kept_high = -1e9;
      const auto in = [&](double x) {
        return std::min(buckets - 1,
                        static_cast<std::size_t>((x - s.x.front()) / (width * static_cast<double>(buckets)) *
                                                 static_cast<double>(buckets))) == b;
      };
      for (std::size_t i = 0; i < s.x.size(); ++i)
        if (in(s.x[i])) low = std::min(low, s.y[i]), high = std::max(high, s.y[i]);
      for (std::size_t i = 0; i < e.x.size(); ++i)
        if (in(e.x[i])) kept_low = std::min(kept_low, e.y[i]), kept_high = std::max(kept_high, e.y[i]);
      ASSERT_EQ(kept_low, low) << b;
      ASSERT_EQ(kept_high, high) << b;
    }
  }
}

TEST(Envelope, FewSamplesAreAllKept) {
  const Samples s = noise(200, 1);
  const Points e = envelope(s.x, s.y, 100);
  EXPECT_EQ(e.x, s.x);
  EXPECT_EQ(e.y, s.y);
  EXPECT_EQ(e.interval, 0.0);
}

TEST(Envelope, BreaksWhereSamplesAreMissing) {
  Samples s = noise(1000, 1);
  s.y[10] = s.y[11] = kMissing;
  for (std::size_t i = 500; i < s.x.size(); ++i) s.x[i] += 1.0;
  const auto breaks = [](const Points& p) {
    return std::ranges::count_if(p.y, [](double v) { return std::isnan(v); });
  };
  EXPECT_EQ(breaks(envelope(s.x, s.y, 1000, 0.0075)), 2);
  EXPECT_EQ(breaks(envelope(s.x, s.y, 1000)), 1);
  // Buckets of 0.12 s: two samples of 5 ms are not seen, a second is.
  EXPECT_EQ(breaks(envelope(s.x, s.y, 50, 0.0075)), 1);
  EXPECT_EQ(envelope(s.x, s.y, 50, 0.0075).samples, 998U);
}

TEST(Envelope, OfAnEnvelopeKeepsTheExtremes) {
  Samples s = noise(100000, 4);
  s.y[77777] = 50.0;
  s.y[12345] = -40.0;
  const Points thin = thinner(envelope(s.x, s.y, 4000), 100);
  EXPECT_LE(thin.x.size(), 202U);
  EXPECT_EQ(std::ranges::max(thin.y), 50.0);
  EXPECT_EQ(std::ranges::min(thin.y), -40.0);
  EXPECT_EQ(thin.samples, s.x.size());
}

TEST(Envelope, RefusesWhatItCannotDraw) {
  const std::vector<double> up = {0, 1}, down = {1, 0},
                            endless = {0, std::numeric_limits<double>::infinity()}, one = {0};
  EXPECT_THROW(envelope(down, up), std::invalid_argument);
  EXPECT_THROW(envelope(up, endless), std::invalid_argument);
  EXPECT_THROW(envelope(endless, up), std::invalid_argument);
  EXPECT_THROW(envelope(up, one), std::invalid_argument);
  EXPECT_TRUE(envelope({}, {}).x.empty());
  const std::vector<double> missing = {kMissing, kMissing};
  EXPECT_TRUE(envelope(up, missing).x.empty());
}

TEST(Ticks, AreRoundAndInside) {
  for (const auto& [low, high] :
       {std::pair{0.0, 18000.0}, {-3.2, 7.9}, {4424.9001, 4424.9007}, {1e-9, 3e-9}, {-1e7, 5e7}}) {
    const auto ticks = linear_ticks(low, high, 6);
    ASSERT_GE(ticks.size(), 3U) << low;
    ASSERT_LE(ticks.size(), 14U) << low;
    for (const Tick& t : ticks)
      EXPECT_TRUE(t.value >= low - 1e-9 * (high - low) && t.value <= high + 1e-9 * (high - low));
    for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_NE(ticks[i].label, ticks[i - 1].label);
  }
  EXPECT_EQ(linear_ticks(0.0, 1.0, 5)[1].label, "0.2");
  EXPECT_EQ(linear_ticks(-1.0, 1.0, 4).front().label, "−1.0");
}

TEST(Ticks, OfDecades) {
  const auto ticks = log_ticks(0.01, 1e6);
  std::vector<std::string> labels;
  for (const Tick& t : ticks)
    if (!t.label.empty()) labels.push_back(t.label);
  EXPECT_EQ(labels,
            (std::vector<std::string>{"0.01", "0.1", "1", "10", "100", "1000", "10000", "10⁵", "10⁶"}));
}

TEST(Ticks, NumbersAsPeopleWriteThem) {
  EXPECT_EQ(nice_number(0.0), "0");
  EXPECT_EQ(nice_number(11800.0, 4), "11800");
  EXPECT_EQ(nice_number(-0.05), "−0.05");
  EXPECT_EQ(nice_number(3.14159, 3), "3.14");
  EXPECT_EQ(nice_number(3.1e-8), "3.1·10⁻⁸");
  EXPECT_EQ(nice_number(-1e12), "−1·10¹²");
}

TEST(Markup, NothingGetsOut) {
  EXPECT_EQ(escaped("<a href=\"x\">'&'</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
  EXPECT_EQ(escaped("\x01\x7f"), "\uFFFD\uFFFD");
  EXPECT_EQ(escaped("\xc3(").find('\xc3'), std::string::npos);
  EXPECT_EQ(escaped("°\n"), "°\n");
}

TEST(Markup, Base64OfDoubles) {
  // 1.0 is 00 00 00 00 00 00 f0 3f.
  const std::vector<double> one = {1.0}, three = {1.0, 1.0, 1.0};
  EXPECT_EQ(base64(one), "AAAAAAAA8D8=");
  EXPECT_EQ(base64(three), "AAAAAAAA8D8AAAAAAADwPwAAAAAAAPA/");
  EXPECT_EQ(base64({}), "");
}

TEST(Chain, KnowsEveryBlockOfTheCore) {
  for (const auto& tap : config::taps) {
    if (std::string_view(tap.block) == "input") continue;
    const auto stage = stage_of(tap.block);
    ASSERT_TRUE(stage.has_value()) << tap.block;
    const std::string svg = chain_svg({.marks = {{tap.block, "differs"}}, .note = {}});
    EXPECT_NE(svg.find(" marked\" data-stage=\"" + *stage + "\""), std::string::npos) << tap.block;
  }
  EXPECT_EQ(stage_of("Phase detector"), "phase_detector");
  EXPECT_EQ(stage_of("teapot"), std::nullopt);
  // Where a verdict leaves several open, all are marked, in the wide and in the narrow drawing.
  const std::string open = chain_svg({.marks = {{"resonator, oscillator or chamber", ""}}, .note = {}});
  std::size_t marked = 0;
  for (std::size_t at = open.find(" marked\""); at != std::string::npos; at = open.find(" marked\"", at + 1))
    ++marked;
  EXPECT_EQ(marked, 6U);
  EXPECT_EQ(chain_svg({.marks = {{"teapot", ""}}, .note = {}}).find(" marked"), std::string::npos);
}

TEST(Residuals, LongestRunStopsAtGapsAndMissingValues) {
  const std::vector<double> t = {0, 1, 2, 3, 4, 5, 9, 10, 11, 12, 13, 14, 15}, all(t.size(), 1.0);
  auto run = longest_run(t, all);
  EXPECT_EQ(run.first, 6U);
  EXPECT_EQ(run.rows, 7U);
  EXPECT_DOUBLE_EQ(run.step_s, 1.0);
  std::vector<double> holes = all;
  holes[9] = kMissing;
  run = longest_run(t, holes);
  EXPECT_EQ(run.first, 0U);
  EXPECT_EQ(run.rows, 6U);
}

TEST(Residuals, SpectrumOfWhiteNoiseIsFlatAtItsDensity) {
  // One-sided density of white noise of standard deviation s at interval d: s sqrt(2 d). The mean over the
  // spectrum of the power of n rows is known to sqrt(2 / n).
  const Samples s = noise(100000, 9);
  const auto spectrum = spectrum_series("s", s.x, s.y);
  ASSERT_TRUE(spectrum.has_value());
  double power = 0.0;
  for (const double d : spectrum->points.y) power += d * d / static_cast<double>(spectrum->points.y.size());
  EXPECT_NEAR(power, 2 * 0.005, 5 * 2 * 0.005 * std::sqrt(2.0 / 100000));
  EXPECT_NEAR(spectrum->points.x.back(), 100.0, 1e-6);
}

TEST(Residuals, SpectrumOfALineStandsAtItsFrequencyWithItsPower) {
  Samples s = noise(40000, 9);
  for (std::size_t i = 0; i < s.x.size(); ++i) s.y[i] = 3.0 * std::sin(2 * std::numbers::pi * 12.5 * s.x[i]);
  const auto spectrum = spectrum_series("s", s.x, s.y);
  ASSERT_TRUE(spectrum.has_value());
  const auto& y = spectrum->points.y;
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(y) - y.begin());
  EXPECT_NEAR(spectrum->points.x[peak], 12.5, 0.03);
  double power = 0.0;
  for (const double d : y) power += d * d * (spectrum->points.x[1] - spectrum->points.x[0]);
  // Half the square of the amplitude; Hann's side lobes beyond the ends are below 1e-6 of it.
  EXPECT_NEAR(power, 4.5, 1e-3);
}

TEST(PlotSvg, DrawsEmptyAndConstantPlots) {
  Plot plot{.title = "t", .x = {"time", "s"}, .y = {"v", "V"}};
  EXPECT_NE(plot_svg(plot, "p").find("<svg"), std::string::npos);
  plot.series.push_back(Series::line("c", {0, 1, 2}, {5, 5, 5}));
  const Extent e = extent_of(plot);
  EXPECT_LT(e.y0, 5.0);
  EXPECT_GT(e.y1, 5.0);
  const std::string svg = plot_svg(plot, "p");
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  plot.y.log = true;
  plot.series.push_back(Series::line("d", {0, 1, 2}, {-1, 0, kMissing}));
  EXPECT_EQ(plot_svg(plot, "p").find("nan"), std::string::npos);
}

}  // namespace
}  // namespace hemi::report
