// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/diagnosis/bench_diagnosis.hpp"

namespace hemi::diagnosis {

/// The recording as the search sees it: one part, its blocks, the input of the simulation.
class BenchSearch {
 public:
  BenchSearch(const BenchPart& part, double sample_rate_hz, const BenchOptions& options, Hold hold,
              double stiffness_per_s2);

  /// Fit of a form from the parameters of another (terms by name; new ones start at zero).
  SimulationFit fit(const std::vector<Term>& terms, const SimulationFit& from) const;
  SimulationFit fit_from(const std::vector<Term>& terms, const Eigen::VectorXd& start) const;
  Eigen::VectorXd held_out(const SimulationFit& fit) const;
  /// All terms of the library that the fit does not hold, tried beside it.
  BenchStep step(const SimulationFit& model, const std::vector<Term>& aside) const;
  /// rms of the blocks left out with all terms of the library beside the fit, linearised.
  double floor_rms(const SimulationFit& model) const;
  /// Decoys of every term beside the fit that reach the critical value of the real ones: {made, accepted}.
  std::pair<std::size_t, std::size_t> decoys(const SimulationFit& model, int each) const;
  /// Five standard errors of each catalogue term that the fit does not hold.
  std::vector<Limit> limits(const SimulationFit& model) const;
  bool parts_agree(const SimulationFit& fit, Term term) const;

  const std::vector<calibration::RowRange>& blocks() const { return blocks_; }
  const BenchInput& input() const { return input_; }
  const BenchPart& part() const { return part_; }
  const BenchOptions& options() const { return options_; }

 private:
  struct Probe {
    SimulationFit all;         // the fit with every other term at strength zero
    std::vector<Term> absent;  // those others
    Eigen::MatrixXd model;     // columns of the fit
    Eigen::MatrixXd columns;   // columns of the others
  };
  Probe probe(const SimulationFit& model) const;
  Eigen::VectorXd linear_held_out(const Probe& probe, const std::vector<Eigen::Index>& with) const;
  void judge(BenchStep& step, const SimulationFit& model, const MaxT& test) const;

  const BenchPart& part_;
  const BenchOptions& options_;
  BenchInput input_;
  std::vector<calibration::RowRange> blocks_, folds_;
};

/// Terms whose traces overlap by more than this compete for the same remainder.
inline constexpr double kRivalOverlap = 0.5;

/// Place of a term's strength among the parameters of a form; -1 where it is absent.
Eigen::Index place_of(const BenchForm& form, Term term);

}  // namespace hemi::diagnosis
