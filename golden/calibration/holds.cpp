// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/holds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

namespace hemi::calibration {
namespace {

constexpr double kMeanSeconds = 30.0;

// Means of a stretch, and what a block lasts.
struct Means {
  std::vector<double> value;
  Eigen::Index length;
  double seconds;
};

struct Window {
  std::size_t begin;
  std::size_t end;
};

Means means_of(const ThermalStretch& stretch) {
  const Eigen::Index rows = stretch.time_s.size();
  const double step_s =
      rows > 1 ? (stretch.time_s[rows - 1] - stretch.time_s[0]) / static_cast<double>(rows - 1) : 1.0;
  Means means;
  means.length = std::max<Eigen::Index>(1, std::lround(kMeanSeconds / step_s));
  means.seconds = step_s * static_cast<double>(means.length);
  for (Eigen::Index i = 0; i + means.length <= rows; i += means.length)
    means.value.push_back(stretch.case_degc.segment(i, means.length).mean());
  return means;
}

// Longest run inside `within` whose largest and smallest value differ by at most `width`.
Window longest_run(const std::vector<double>& v, Window within, double width) {
  Window best{within.begin, within.begin};
  std::deque<std::size_t> largest, smallest;  // candidates in order of time, the extreme one in front
  std::size_t begin = within.begin;
  for (std::size_t i = within.begin; i < within.end; ++i) {
    while (!largest.empty() && v[largest.back()] <= v[i]) largest.pop_back();
    while (!smallest.empty() && v[smallest.back()] >= v[i]) smallest.pop_back();
    largest.push_back(i);
    smallest.push_back(i);
    while (v[largest.front()] - v[smallest.front()] > width) {
      ++begin;
      if (largest.front() < begin) largest.pop_front();
      if (smallest.front() < begin) smallest.pop_front();
    }
    if (i + 1 - begin > best.end - best.begin) best = {begin, i + 1};
  }
  return best;
}

void collect(const Means& means, Window within, double width, double least_s, std::vector<Window>& found) {
  const Window run = longest_run(means.value, within, width);
  if (static_cast<double>(run.end - run.begin) * means.seconds < least_s || run.end == run.begin) return;
  collect(means, {within.begin, run.begin}, width, least_s, found);
  found.push_back(run);
  collect(means, {run.end, within.end}, width, least_s, found);
}

Hold hold_of(const std::vector<ThermalStretch>& stretches, std::size_t which, const Means& means,
             Window run) {
  const ThermalStretch& stretch = stretches[which];
  Hold hold{};
  hold.stretch = which;
  hold.begin = static_cast<Eigen::Index>(run.begin) * means.length;
  hold.count = static_cast<Eigen::Index>(run.end - run.begin) * means.length;
  hold.from_s = stretch.time_s[hold.begin];
  hold.to_s = stretch.time_s[hold.begin + hold.count - 1];
  const Eigen::VectorXd later = stretch.case_degc.segment(hold.begin + hold.count / 2, hold.count / 2);
  hold.case_degc = later.mean();
  const double step = reading_step(stretch.case_degc);
  const double measured = reading_noise(later);
  // What rounding itself adds to the measured noise is not there to dither it.
  const double noise = std::sqrt(std::max(0.0, measured * measured - step * step / 12.0));
  hold.case_error_degc =
      std::hypot(measured / std::sqrt(static_cast<double>(later.size())), rounding_of_the_mean(step, noise));
  return hold;
}

RefusedHold refused(const Hold& hold, std::string why) {
  return {hold.stretch, hold.from_s, hold.to_s, hold.case_degc, std::move(why)};
}

}  // namespace

double reading_step(const Eigen::VectorXd& readings) {
  double step = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 1; i < readings.size(); ++i) {
    const double difference = std::abs(readings[i] - readings[i - 1]);
    // Printed steps come back with the rounding of binary numbers.
    if (difference > 1e-9) step = std::min(step, difference);
  }
  return std::isfinite(step) ? step : 0.0;
}

double reading_noise(const Eigen::VectorXd& readings) {
  const Eigen::Index n = readings.size() - 1;
  if (n < 1) return 0.0;
  return std::sqrt((readings.tail(n) - readings.head(n)).squaredNorm() / (2.0 * static_cast<double>(n)));
}

double rounding_of_the_mean(double step, double noise) {
  if (!(step > 0.0)) return 0.0;
  const double ratio = std::numbers::pi * noise / step;
  return std::min(step / std::sqrt(12.0), noise > 0.0 ? step / (std::numbers::pi * std::numbers::sqrt2) *
                                                            std::exp(-2.0 * ratio * ratio)
                                                      : step / std::sqrt(12.0));
}

Holds find_holds(const std::vector<ThermalStretch>& stretches, const HoldOptions& options) {
  Holds holds;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const Means means = means_of(stretches[s]);
    std::vector<Window> tight;
    collect(means, {0, means.value.size()}, options.width_degc, 0.5 * options.least_s, tight);
    std::size_t free = 0;
    const auto name_loose = [&](std::size_t end) {
      std::vector<Window> loose;
      collect(means, {free, end}, options.loose_width_degc, options.least_s, loose);
      for (const Window& run : loose) {
        const auto [low, high] =
            std::minmax_element(means.value.begin() + static_cast<std::ptrdiff_t>(run.begin),
                                means.value.begin() + static_cast<std::ptrdiff_t>(run.end));
        holds.refused.push_back(
            refused(hold_of(stretches, s, means, run),
                    fmt::format("the case temperature moves by {:.2f} degC, a hold by {:.2g} at most",
                                *high - *low, options.width_degc)));
      }
    };
    for (const Window& run : tight) {
      name_loose(run.begin);
      free = run.end;
      const Hold hold = hold_of(stretches, s, means, run);
      if (hold.to_s - hold.from_s + means.seconds >= options.least_s)
        holds.used.push_back(hold);
      else
        holds.refused.push_back(refused(hold, fmt::format("it lasts {:.0f} s, a hold {:.0f} at least",
                                                          hold.to_s - hold.from_s, options.least_s)));
    }
    name_loose(means.value.size());
  }
  return holds;
}

}  // namespace hemi::calibration
