// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hemi::recording {
namespace {

// A clock printed in decimals yields 99999.99999999999 for 100000: within 1e-9, which no oscillator keeps,
// the rate is taken to be the round number of millihertz.
double without_rounding(double rate_hz) {
  const double round = std::round(rate_hz * 1e3) / 1e3;
  return std::abs(round - rate_hz) <= 1e-9 * rate_hz ? round : rate_hz;
}

void check_order(const Table& table, const std::vector<double>& time_s) {
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const Place place =
        std::isnan(time_s[i]) || (i > 0 && !(time_s[i] > time_s[i - 1])) ? table.place(i, "time_s") : Place{};
    if (place.path.empty()) continue;
    if (std::isnan(time_s[i])) {
      throw InputError(place, "the time is missing", "fill it in, or remove the row: gaps are survived");
    }
    if (time_s[i] == time_s[i - 1]) {
      throw InputError(place, fmt::format("the time {} is repeated", time_s[i]),
                       "remove the doubled row, or write time with more digits");
    }
    throw InputError(place, fmt::format("time runs backwards, from {} to {}", time_s[i - 1], time_s[i]),
                     "put the rows in order, or map time_s to null and state sample_rate_hz in the sidecar");
  }
}

}  // namespace

Clock examine_clock(const Table& table, const std::vector<double>& time_s) {
  check_order(table, time_s);
  Clock clock;
  if (time_s.size() < 2) return clock;
  std::vector<double> steps(time_s.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = time_s[i + 1] - time_s[i];
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double nominal_s = *middle;
  double missing = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] < 0.5 * nominal_s) ++clock.short_steps;
    if (!(steps[i] > 1.5 * nominal_s)) continue;
    const double lost = std::max(std::round(steps[i] / nominal_s) - 1.0, 1.0);
    clock.gaps.push_back({time_s[i], time_s[i + 1], i, static_cast<std::size_t>(std::min(lost, 1e18))});
    missing += lost;
  }
  const double intervals = static_cast<double>(steps.size()) + missing;
  clock.rate_hz = without_rounding(intervals / (time_s.back() - time_s.front()));
  return clock;
}

std::vector<double> time_from_rate(std::size_t rows, double rate_hz) {
  std::vector<double> time_s(rows);
  for (std::size_t i = 0; i < rows; ++i) time_s[i] = static_cast<double>(i) / rate_hz;
  return time_s;
}

double stated_rate(const Json& object, const std::string& path, const std::string& context) {
  const double rate_hz = number_or(object, "sample_rate_hz", 0.0, path, context);
  if (object.contains("sample_rate_hz") && !(rate_hz > 0.0)) {
    throw InputError(
        {.path = path, .channel = context.empty() ? "sample_rate_hz" : context + ".sample_rate_hz"},
        "a sample rate must be above zero", "correct it");
  }
  return rate_hz;
}

}  // namespace hemi::recording
