// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/compensation_score.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hemi::calibration {
namespace {

struct Averages {
  std::vector<double> before, after, slope;
};

Averages averages_of(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                     const Eigen::VectorXd& slope, const std::vector<RowRange>& segments,
                     Eigen::Index length) {
  Averages out;
  for (const RowRange& range : segments) {
    for (Eigen::Index i = 0; i + length <= range.count; i += length) {
      out.before.push_back(before.segment(range.begin + i, length).mean());
      out.after.push_back(after.segment(range.begin + i, length).mean());
      out.slope.push_back(slope.segment(range.begin + i, length).mean());
    }
  }
  return out;
}

double mean_of(const std::vector<double>& v) {
  return Eigen::VectorXd::Map(v.data(), static_cast<Eigen::Index>(v.size())).mean();
}

template <class Belongs>
StabilityPair score(const Averages& a, Belongs belongs, double lost) {
  const double before_mean = mean_of(a.before), after_mean = mean_of(a.after);
  StabilityPair pair;
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < a.before.size(); ++i) {
    if (!belongs(a.slope[i])) continue;
    ++pair.averages;
    before += (a.before[i] - before_mean) * (a.before[i] - before_mean);
    after += (a.after[i] - after_mean) * (a.after[i] - after_mean);
  }
  const double count = std::max(static_cast<double>(pair.averages) - lost, 1.0);
  pair.before_dph = std::sqrt(before / count);
  pair.after_dph = std::sqrt(after / count);
  return pair;
}

}  // namespace

CompensationScore score_compensation(const Eigen::VectorXd& before_dph, const Eigen::VectorXd& after_dph,
                                     const Eigen::VectorXd& slope_hz_per_s,
                                     const std::vector<RowRange>& segments, double interval_s,
                                     double average_s, double slope_threshold_hz_per_s) {
  const auto length = std::max<Eigen::Index>(1, std::lround(average_s / interval_s));
  const Averages a = averages_of(before_dph, after_dph, slope_hz_per_s, segments, length);
  if (a.before.size() < 2) throw std::invalid_argument("bias stability needs two averages at least");
  const double limit = slope_threshold_hz_per_s;
  return {score(
              a, [](double) { return true; }, 1.0),
          score(
              a, [&](double slope) { return slope > limit; }, 0.0),
          score(
              a, [&](double slope) { return slope < -limit; }, 0.0),
          score(
              a, [&](double slope) { return std::abs(slope) <= limit; }, 0.0)};
}

}  // namespace hemi::calibration
