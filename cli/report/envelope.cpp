// SPDX-License-Identifier: Apache-2.0
#include "cli/report/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace hemi::report {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Smallest and largest row of the bucket at hand.
struct Extremes {
  std::size_t smallest, largest;
};

void put(Points& out, double x, double y) {
  out.x.push_back(x);
  out.y.push_back(y);
}

void put(Points& out, std::span<const double> x, std::span<const double> y, const Extremes& e) {
  const auto [first, last] = std::minmax(e.smallest, e.largest);
  put(out, x[first], y[first]);
  if (last != first) put(out, x[last], y[last]);
}

void check(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) throw std::invalid_argument("a curve needs one y for each x");
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || std::isinf(y[i]))
      throw std::invalid_argument("a curve has an infinite value");
    if (i > 0 && x[i] < x[i - 1]) throw std::invalid_argument("the x of a curve must ascend");
  }
}

}  // namespace

Points envelope(std::span<const double> x, std::span<const double> y, std::size_t buckets,
                double longest_step) {
  check(x, y);
  if (buckets == 0) throw std::invalid_argument("an envelope needs a bucket");
  Points out;
  if (x.empty()) return out;
  const bool whole = x.size() <= 2 * buckets;
  const double span = x.back() - x.front();
  out.interval = whole ? 0.0 : span / static_cast<double>(buckets);
  const auto bucket_of = [&](std::size_t i) {
    if (whole || !(span > 0.0)) return whole ? i : std::size_t{0};
    return std::min(buckets - 1,
                    static_cast<std::size_t>((x[i] - x.front()) / span * static_cast<double>(buckets)));
  };
  std::optional<Extremes> open;
  std::size_t open_bucket = 0, first = 0, before = 0;
  bool missing = false, any = false;
  const auto close = [&] {
    if (open) put(out, x, y, *open);
    open.reset();
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(y[i])) {
      missing = true;
      continue;
    }
    ++out.samples;
    const double step = any ? x[i] - x[before] : 0.0;
    const bool broken = any && (missing || (longest_step > 0.0 && step > longest_step));
    if (broken && (whole || step > out.interval)) {
      close();
      put(out, 0.5 * (x[before] + x[i]), kNone);
    }
    const std::size_t bucket = bucket_of(i);
    if (open && bucket != open_bucket) close();
    if (!open) {
      open = Extremes{i, i};
      open_bucket = bucket;
    }
    if (y[i] < y[open->smallest]) open->smallest = i;
    if (y[i] > y[open->largest]) open->largest = i;
    if (!any) first = i;
    before = i;
    missing = false;
    any = true;
  }
  close();
  if (any && out.x.front() != x[first]) {
    out.x.insert(out.x.begin(), x[first]);
    out.y.insert(out.y.begin(), y[first]);
  }
  if (any && out.x.back() != x[before]) put(out, x[before], y[before]);
  return out;
}

Points thinner(const Points& points, std::size_t buckets) {
  Points out = envelope(points.x, points.y, buckets);
  if (out.interval == 0.0) return points;
  out.interval = std::max(out.interval, points.interval);
  out.samples = points.samples;
  return out;
}

}  // namespace hemi::report
