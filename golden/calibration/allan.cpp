// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/allan.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <stdexcept>

namespace hemi::calibration {
namespace {

// Minimum of the Allan deviation of flicker noise over its coefficient: sqrt(2 ln 2 / pi).
constexpr double kFlickerFloor = 0.664;
constexpr double kSlopeTolerance = 0.1;
constexpr double kLeastDecades = 0.9;  // 1 to 8 intervals: what octaves have next to a decade

void check(const Eigen::VectorXd& rate, double interval_s, Eigen::Index least) {
  if (rate.size() < least) throw std::invalid_argument("Allan deviation: too few samples");
  if (!rate.allFinite()) throw std::invalid_argument("Allan deviation: samples are not all finite");
  if (!(interval_s > 0.0) || !std::isfinite(interval_s)) {
    throw std::invalid_argument("Allan deviation: the sample interval must be positive");
  }
}

AllanPoint allan_point(const Eigen::VectorXd& angle, double interval_s, Eigen::Index averaged) {
  const Eigen::Index samples = angle.size() - 1;
  const Eigen::Index pairs = samples - 2 * averaged + 1;
  const double sum =
      (angle.tail(pairs) - 2.0 * angle.segment(averaged, pairs) + angle.head(pairs)).squaredNorm();
  const auto length = static_cast<double>(averaged);
  AllanPoint point{};
  point.tau_s = length * interval_s;
  point.averaged = averaged;
  point.pairs = pairs;
  point.deviation = std::sqrt(sum / (2.0 * static_cast<double>(pairs))) / length;
  point.degrees_of_freedom = white_degrees_of_freedom(samples, averaged);
  const boost::math::chi_squared_distribution<double> distribution(point.degrees_of_freedom);
  const double tail = 0.5 * std::erfc(std::sqrt(0.5));
  point.lower =
      point.deviation * std::sqrt(point.degrees_of_freedom /
                                  boost::math::quantile(boost::math::complement(distribution, tail)));
  point.upper =
      point.deviation * std::sqrt(point.degrees_of_freedom / boost::math::quantile(distribution, tail));
  return point;
}

// Relative standard deviation of a deviation, and of the slope between two neighbours taken as independent,
// which overstates it: neighbours share their samples.
double slope_uncertainty(const AllanPoint& a, const AllanPoint& b) {
  return std::sqrt(0.5 / a.degrees_of_freedom + 0.5 / b.degrees_of_freedom) / std::log(b.tau_s / a.tau_s);
}

bool falls_as_white(const AllanPoint& a, const AllanPoint& b) {
  if (!(a.deviation > 0.0) || !(b.deviation > 0.0)) return false;
  const double slope = std::log(b.deviation / a.deviation) / std::log(b.tau_s / a.tau_s);
  return std::abs(slope + 0.5) <= kSlopeTolerance && slope_uncertainty(a, b) <= kSlopeTolerance;
}

std::optional<AngleRandomWalk> find_angle_random_walk(const std::vector<AllanPoint>& points) {
  std::size_t best_first = 0;
  std::size_t best_last = 0;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first;
    while (last + 1 < points.size() && falls_as_white(points[last], points[last + 1])) ++last;
    if (last - first > best_last - best_first) {
      best_first = first;
      best_last = last;
    }
    first = last + 1;
  }
  if (best_last == best_first ||
      std::log10(points[best_last].tau_s / points[best_first].tau_s) < kLeastDecades) {
    return std::nullopt;
  }
  double weight_sum = 0.0;
  double sum = 0.0;
  for (std::size_t i = best_first; i <= best_last; ++i) {
    const double weight = points[i].degrees_of_freedom;
    weight_sum += weight;
    sum += weight * points[i].deviation * points[i].deviation * points[i].tau_s;
  }
  return AngleRandomWalk{std::sqrt(sum / weight_sum), points[best_first].tau_s, points[best_last].tau_s};
}

}  // namespace

double white_degrees_of_freedom(Eigen::Index samples, Eigen::Index averaged) {
  const Eigen::Index pairs = samples - 2 * averaged + 1;
  // Differences of neighbouring averages m long, k apart: correlation (2m - 3k)/2m up to m, -(2m - k)/2m up
  // to 2m.
  const auto m = static_cast<double>(averaged);
  double sum = static_cast<double>(pairs);
  for (Eigen::Index lag = 1; lag < std::min(2 * averaged, pairs); ++lag) {
    const auto k = static_cast<double>(lag);
    const double correlation = (lag <= averaged ? 2.0 * m - 3.0 * k : k - 2.0 * m) / (2.0 * m);
    sum += 2.0 * static_cast<double>(pairs - lag) * correlation * correlation;
  }
  return static_cast<double>(pairs) * static_cast<double>(pairs) / sum;
}

AllanResult allan_deviation(const Eigen::VectorXd& rate, double interval_s, TauSpacing spacing) {
  check(rate, interval_s, 3);
  // Of the differences the mean drops out; taken out first it does not cost digits of the running sum.
  const double mean = rate.mean();
  Eigen::VectorXd angle(rate.size() + 1);
  angle(0) = 0.0;
  for (Eigen::Index i = 0; i < rate.size(); ++i) angle(i + 1) = angle(i) + (rate(i) - mean);

  AllanResult result;
  const Eigen::Index factor = spacing == TauSpacing::kOctave ? 2 : 10;
  for (Eigen::Index averaged = 1; 2 * averaged <= rate.size(); averaged *= factor) {
    result.points.push_back(allan_point(angle, interval_s, averaged));
  }
  result.angle_random_walk = find_angle_random_walk(result.points);
  const AllanPoint* least = &result.points.front();
  for (const AllanPoint& point : result.points) {
    if (point.deviation < least->deviation) least = &point;
  }
  result.bias_instability = least->deviation / kFlickerFloor;
  result.bias_instability_tau_s = least->tau_s;
  result.bias_instability_is_bound = least == &result.points.back();
  return result;
}

double bias_stability(const Eigen::VectorXd& rate, double interval_s, double average_s) {
  check(rate, interval_s, 2);
  if (!(average_s >= interval_s * (1.0 - 1e-9))) {
    throw std::invalid_argument("bias stability: the averaging time is shorter than a sample");
  }
  const auto averaged = static_cast<Eigen::Index>(std::llround(average_s / interval_s));
  const Eigen::Index blocks = rate.size() / averaged;
  if (blocks < 2) throw std::invalid_argument("bias stability: the recording does not hold two averages");
  Eigen::VectorXd means(blocks);
  for (Eigen::Index i = 0; i < blocks; ++i) means(i) = rate.segment(i * averaged, averaged).mean();
  return std::sqrt((means.array() - means.mean()).square().sum() / static_cast<double>(blocks - 1));
}

}  // namespace hemi::calibration
