// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "golden/calibration/rows.hpp"
#include "golden/diagnosis/memory_columns.hpp"
#include "golden/diagnosis/memory_families.hpp"

namespace hemi::diagnosis {

inline constexpr std::size_t kFamilies = std::size(kMemoryFamilies);

/// The best form of a family by cross-validation over the blocks of some rows, and its fit to all of them.
struct ChosenForm {
  MemoryForm form;
  Eigen::VectorXd coefficients;     ///< one a column of the form [deg/h]
  Eigen::VectorXd block_squares;    ///< sum of squares of each block when left out [(deg/h)^2]
  Eigen::MatrixXd without_a_block;  ///< columns x blocks: the fits behind them
};

/// One selection: on all blocks, or on all but the one that is held out.
struct Selection {
  std::array<ChosenForm, kFamilies> best;  ///< of each family
  MemoryFamily chosen = MemoryFamily::polynomial;
};

struct NestedSelection {
  std::vector<MemoryColumns> columns;  ///< one an assumption about the time before the first row
  std::vector<double> past_s;
  std::vector<calibration::RowRange> blocks;
  std::vector<Selection> folds;  ///< without block 0, 1, ...
  Selection whole;
  std::array<Eigen::VectorXd, kFamilies>
      held_out;                                  ///< observed - predicted, each row by its own fold [deg/h]
  Eigen::VectorXd chosen_held_out;               ///< by the family that the fold chose
  std::array<Eigen::VectorXd, kFamilies> train;  ///< by the fit to all rows

  /// The rate [deg/h] that a form with its coefficients gives.
  Eigen::VectorXd predict(const MemoryForm& form, const Eigen::VectorXd& coefficients) const;
};

/// Cross-validation over `blocks` contiguous blocks in which all that is chosen (degree, number and kind of
/// the memories, time constants, strength of the ridge, the past, the family) is chosen inside each fold, by
/// a second cross-validation over the blocks that are left to it. Nodes and plays follow the measured
/// temperature, an input, through all rows.
///
/// The family: the one effect that leaves least in the inner folds, if it leaves less than the polynomial; a
/// second beside it where the block bootstrap's 95 % interval of the inner gain lies above zero.
///
/// Throws std::invalid_argument as memory_columns does. `tick` is called often and may throw. Source: Varma
/// and Simon, BMC Bioinformatics 7 (2006) 91; Hastie, Tibshirani and Friedman, chapters 3 and 7.
NestedSelection nested_selection(const CaseRows& rows, Eigen::Index blocks,
                                 const std::function<void()>& tick);

/// Held-out residual [deg/h] of the same procedure where lag and hysteresis follow a temperature that has
/// nothing to do with the rate, the polynomial the measured one. decoy_degc: one a row.
Eigen::VectorXd decoy_residual(const CaseRows& rows, const Eigen::VectorXd& decoy_degc, Eigen::Index blocks,
                               const std::function<void()>& tick);

}  // namespace hemi::diagnosis
