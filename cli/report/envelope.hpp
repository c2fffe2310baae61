// SPDX-License-Identifier: Apache-2.0
// Few points that look like many: the extremes of short stretches.
#ifndef HEMI_CLI_REPORT_ENVELOPE_HPP
#define HEMI_CLI_REPORT_ENVELOPE_HPP

#include <cstddef>
#include <span>
#include <vector>

namespace hemi::report {

/// Buckets a curve: two points each, twice what a screen of 2000 pixels can show.
inline constexpr std::size_t kBuckets = 4000;

struct Points {
  std::vector<double> x{}, y{};  ///< y NaN: the line is broken here
  std::size_t samples = 0;       ///< that it was made of
  double interval = 0.0;         ///< width of a bucket in x; 0 where every sample is there
};

/// x is cut into `buckets` stretches of equal width, and of each the smallest and the largest y are kept, in
/// the order of x, and the first and the last sample: every point is a sample with its own x, and every
/// extreme stays. Up to 2 * buckets samples are kept as they are. Missing values (NaN) and steps of x above
/// `longest_step` (where > 0) become one point with y = NaN where they last longer than a bucket, or where
/// every sample is kept.
///
/// x ascending and finite, y finite or NaN, both of one length (std::invalid_argument).
Points envelope(std::span<const double> x, std::span<const double> y, std::size_t buckets = kBuckets,
                double longest_step = 0.0);

/// The same of an envelope: extremes of extremes.
Points thinner(const Points& points, std::size_t buckets);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_ENVELOPE_HPP
