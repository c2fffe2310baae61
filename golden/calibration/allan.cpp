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

constexpr double kLevelOctaves = 1.9;  // two octaves

void check(const Eigen::VectorXd& rate, const std::vector<RowRange>& stretches, double interval_s,
           Eigen::Index least) {
  Eigen::Index longest = 0;
  for (const RowRange& stretch : stretches) {
    if (stretch.begin < 0 || stretch.count < 0 || stretch.begin + stretch.count > rate.size())
      throw std::invalid_argument("Allan deviation: a stretch reaches beyond the samples");
    longest = std::max(longest, stretch.count);
    if (!rate.segment(stretch.begin, stretch.count).allFinite())
      throw std::invalid_argument("Allan deviation: samples are not all finite");
  }
  if (longest < least) throw std::invalid_argument("Allan deviation: too few samples");
  if (!(interval_s > 0.0) || !std::isfinite(interval_s)) {
    throw std::invalid_argument("Allan deviation: the sample interval must be positive");
  }
}

// Running sums of each stretch. Of the differences the mean drops out; taken out first it does not cost
// digits.
std::vector<Eigen::VectorXd> running_sums(const Eigen::VectorXd& rate,
                                          const std::vector<RowRange>& stretches) {
  std::vector<Eigen::VectorXd> sums;
  for (const RowRange& stretch : stretches) {
    if (stretch.count < 2) continue;
    const auto part = rate.segment(stretch.begin, stretch.count);
    const double mean = part.mean();
    Eigen::VectorXd& sum = sums.emplace_back(stretch.count + 1);
    sum(0) = 0.0;
    for (Eigen::Index i = 0; i < stretch.count; ++i) sum(i + 1) = sum(i) + (part(i) - mean);
  }
  return sums;
}

struct Squares {
  double sum = 0.0;
  Eigen::Index pairs = 0;
  double degrees_of_freedom = 0.0;
};

Squares squares_of(const Eigen::VectorXd& angle, Eigen::Index averaged, AllanEstimator estimator) {
  const Eigen::Index samples = angle.size() - 1;
  if (samples < 2 * averaged) return {};
  if (estimator == AllanEstimator::kOverlapping) {
    const Eigen::Index pairs = samples - 2 * averaged + 1;
    return {(angle.tail(pairs) - 2.0 * angle.segment(averaged, pairs) + angle.head(pairs)).squaredNorm(),
            pairs, white_degrees_of_freedom(samples, averaged)};
  }
  const Eigen::Index averages = samples / averaged;
  Squares squares{0.0, averages - 1, white_degrees_of_freedom(averages, 1)};
  for (Eigen::Index i = 0; i < squares.pairs; ++i) {
    const double difference =
        angle((i + 2) * averaged) - 2.0 * angle((i + 1) * averaged) + angle(i * averaged);
    squares.sum += difference * difference;
  }
  return squares;
}

AllanPoint allan_point(const std::vector<Eigen::VectorXd>& angles, double interval_s, Eigen::Index averaged,
                       AllanEstimator estimator) {
  Squares all;
  double spread = 0.0;  // of the mean square, over twice its square: sum of pairs^2 / edf
  for (const Eigen::VectorXd& angle : angles) {
    const Squares part = squares_of(angle, averaged, estimator);
    if (part.pairs == 0) continue;
    all.sum += part.sum;
    all.pairs += part.pairs;
    spread += static_cast<double>(part.pairs) * static_cast<double>(part.pairs) / part.degrees_of_freedom;
  }
  const auto pairs = static_cast<double>(all.pairs);
  const auto length = static_cast<double>(averaged);
  AllanPoint point{};
  point.tau_s = length * interval_s;
  point.averaged = averaged;
  point.pairs = all.pairs;
  point.deviation = std::sqrt(all.sum / (2.0 * pairs)) / length;
  point.degrees_of_freedom = pairs * pairs / spread;
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

bool has_slope(const AllanPoint& a, const AllanPoint& b, double slope) {
  if (!(a.deviation > 0.0) || !(b.deviation > 0.0)) return false;
  const double found = std::log(b.deviation / a.deviation) / std::log(b.tau_s / a.tau_s);
  return std::abs(found - slope) <= kSlopeTolerance && slope_uncertainty(a, b) <= kSlopeTolerance;
}

// The longest stretch of a slope, where it is long enough; its coefficient c by sigma^2 = c^2 tau^(2 slope),
// each point weighted by its degrees of freedom.
std::optional<NoiseReading> reading_of_slope(const std::vector<AllanPoint>& points, double slope,
                                             double least_decades) {
  std::size_t best_first = 0;
  std::size_t best_last = 0;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first;
    while (last + 1 < points.size() && has_slope(points[last], points[last + 1], slope)) ++last;
    if (last - first > best_last - best_first) {
      best_first = first;
      best_last = last;
    }
    first = last + 1;
  }
  if (best_last == best_first ||
      std::log10(points[best_last].tau_s / points[best_first].tau_s) < least_decades) {
    return std::nullopt;
  }
  double weight_sum = 0.0;
  double sum = 0.0;
  for (std::size_t i = best_first; i <= best_last; ++i) {
    const double weight = points[i].degrees_of_freedom;
    weight_sum += weight;
    sum += weight * points[i].deviation * points[i].deviation / std::pow(points[i].tau_s, 2.0 * slope);
  }
  return NoiseReading{std::sqrt(sum / weight_sum), points[best_first].tau_s, points[best_last].tau_s};
}

void read_noise(AllanResult& result) {
  if (const auto white = reading_of_slope(result.points, -0.5, kLeastDecades))
    result.angle_random_walk = AngleRandomWalk{white->coefficient, white->from_s, white->to_s};
  result.flicker = reading_of_slope(result.points, 0.0, kLevelOctaves * std::log10(2.0));
  if (result.flicker) result.flicker->coefficient /= kFlickerFloor;
  result.rate_random_walk = reading_of_slope(result.points, 0.5, kLeastDecades);
  if (result.rate_random_walk) result.rate_random_walk->coefficient *= std::sqrt(3.0);
  const AllanPoint* least = &result.points.front();
  for (const AllanPoint& point : result.points) {
    if (point.deviation < least->deviation) least = &point;
  }
  result.bias_instability = least->deviation / kFlickerFloor;
  result.bias_instability_tau_s = least->tau_s;
  result.bias_instability_is_bound = least == &result.points.back();
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

AllanResult allan_deviation(const Eigen::VectorXd& rate, const std::vector<RowRange>& stretches,
                            double interval_s, TauSpacing spacing, AllanEstimator estimator) {
  check(rate, stretches, interval_s, 3);
  const auto angles = running_sums(rate, stretches);
  Eigen::Index longest = 0;
  for (const RowRange& stretch : stretches) longest = std::max(longest, stretch.count);
  AllanResult result;
  const Eigen::Index factor = spacing == TauSpacing::kOctave ? 2 : 10;
  for (Eigen::Index averaged = 1; 2 * averaged <= longest; averaged *= factor)
    result.points.push_back(allan_point(angles, interval_s, averaged, estimator));
  read_noise(result);
  return result;
}

AllanResult allan_deviation(const Eigen::VectorXd& rate, double interval_s, TauSpacing spacing,
                            AllanEstimator estimator) {
  return allan_deviation(rate, {{0, rate.size()}}, interval_s, spacing, estimator);
}

double bias_stability(const Eigen::VectorXd& rate, const std::vector<RowRange>& stretches, double interval_s,
                      double average_s) {
  check(rate, stretches, interval_s, 2);
  if (!(average_s >= interval_s * (1.0 - 1e-9))) {
    throw std::invalid_argument("bias stability: the averaging time is shorter than a sample");
  }
  const auto averaged = static_cast<Eigen::Index>(std::llround(average_s / interval_s));
  std::vector<double> means;
  for (const RowRange& stretch : stretches) {
    for (Eigen::Index i = 0; (i + 1) * averaged <= stretch.count; ++i)
      means.push_back(rate.segment(stretch.begin + i * averaged, averaged).mean());
  }
  if (means.size() < 2)
    throw std::invalid_argument("bias stability: the recording does not hold two averages");
  const Eigen::Map<const Eigen::ArrayXd> all(means.data(), static_cast<Eigen::Index>(means.size()));
  return std::sqrt((all - all.mean()).square().sum() / static_cast<double>(means.size() - 1));
}

double bias_stability(const Eigen::VectorXd& rate, double interval_s, double average_s) {
  return bias_stability(rate, {{0, rate.size()}}, interval_s, average_s);
}

}  // namespace hemi::calibration
