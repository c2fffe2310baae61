// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "golden/diagnosis/nominal_simulation.hpp"

namespace hemi::diagnosis {

/// Powers of a rate are told in shares of this.
inline constexpr double kFullRate_dph = 1e5;

/// A figure of an effect, by the name and unit of the catalogue.
struct Figure {
  std::string name;
  std::string unit;
  double value = 0.0;
};

/// One form of an effect: outputs change by sum_i c_i columns_i(shape), c linear and free, shape a point
/// of a grid and refined from there.
struct EffectFamily {
  std::string effect;                            ///< id of the catalogue
  std::string form;                              ///< equation in words of the recording's channels
  std::vector<std::vector<double>> grid = {{}};  ///< shapes to begin with; every one > 0 where refined
  std::vector<double> spacing;  ///< ratio of neighbours on the grid, one a shape; empty: not refined
  std::function<std::vector<Trace>(const Simulation&, const std::vector<double>& shape)> columns;
  std::function<std::vector<Figure>(const Simulation&, const std::vector<double>& coefficients,
                                    const std::vector<double>& shape)>
      figures;
  /// Sign and size that this physics can have; absent: any.
  std::function<bool(const Simulation&, const std::vector<double>& coefficients,
                     const std::vector<double>& shape)>
      possible;
  /// The first figure may be larger by what the start temperature lies below the case's: a part of this
  /// effect has the trace of a resonator that begins at another temperature.
  bool start_may_hold = false;
};

/// All forms that this recording could show: a channel that is not recorded, or an input that never moves,
/// leaves out what needs it.
std::vector<EffectFamily> thermal_families(const Simulation& simulation);
std::vector<EffectFamily> frequency_families(const Simulation& simulation);
std::vector<EffectFamily> command_families(const Simulation& simulation);
std::vector<EffectFamily> rate_families(const Simulation& simulation);
std::vector<EffectFamily> effect_families(const Simulation& simulation);

/// Place of the family of an effect in one form; nothing where this recording cannot show it.
std::optional<std::size_t> family_of(const std::vector<EffectFamily>& families, const std::string& effect,
                                     const std::string& form);

/// Whether an input moves by more than `least` over the recording.
bool moves(const Eigen::VectorXd& input, double least);

/// low, low ratio, low ratio^2, ... up to high.
std::vector<std::vector<double>> geometric_grid(double low, double high, double ratio);

}  // namespace hemi::diagnosis
