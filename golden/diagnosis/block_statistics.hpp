// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "golden/calibration/rows.hpp"

namespace hemi::diagnosis {

/// Share of catalogues with no effect in them that are given a name.
inline constexpr double kFamilyWise = 0.01;

/// Root mean squares before and after, and their difference with its 95 % interval (percentiles of a
/// bootstrap over whole blocks).
struct Gain {
  double before_rms = 0.0;
  double after_rms = 0.0;
  double low = 0.0;
  double high = 0.0;
  double gain() const { return before_rms - after_rms; }
};
Gain bootstrap_gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                    const std::vector<calibration::RowRange>& blocks, std::uint64_t seed);

/// Share of block resamples in which residual `best` has fewer squares than every one of `others`, (k + 1) /
/// (n + 2).
double share_won(const Eigen::VectorXd& best, const std::vector<Eigen::VectorXd>& others,
                 const std::vector<calibration::RowRange>& blocks, std::uint64_t seed);

/// Partial autocorrelations of the autoregression that whitens a residual (order by Akaike, 12 at most).
Eigen::VectorXd whitener_of(const Eigen::VectorXd& residual);

/// Tests of many columns against one residual, all whitened.
struct MaxT {
  Eigen::VectorXd
      statistic;      ///< e' s / (|s| sigma) of each column s, what the model's own columns explain taken off
  Eigen::VectorXd p;  ///< corrected for all columns: share of permutations whose largest |T| reaches it
  double critical = 0.0;    ///< largest |T| of a permutation that 1 % exceed
  Eigen::VectorXd norm;     ///< |s| / sigma: 1 / standard error of the column's coefficient
  Eigen::MatrixXd overlap;  ///< cosines between the columns, the model's own taken off
};

/// Residual and columns are whitened by `partial`; under the null the whitened residual's blocks may change
/// places. `model`: the fitted model's own columns. `extra` columns are tested against the critical value of
/// the others. Source: Westfall and Young, Resampling-Based Multiple Testing (1993), single-step max-T.
MaxT max_t(const Eigen::VectorXd& residual, const Eigen::MatrixXd& model, const Eigen::MatrixXd& columns,
           Eigen::Index extra, const Eigen::VectorXd& partial, Eigen::Index blocks, std::uint64_t seed);

/// A copy of a column that has its spectrum and no tie to the recording: moved around a circle by a random
/// share of the record, a tenth at least (`randomise` false), or with random phases.
Eigen::VectorXd decoy_of(const Eigen::VectorXd& column, bool randomise, std::uint64_t seed);

}  // namespace hemi::diagnosis
