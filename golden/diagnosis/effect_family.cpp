// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/effect_family.hpp"

#include <algorithm>

namespace hemi::diagnosis {

bool moves(const Eigen::VectorXd& input, double least) {
  return input.size() > 0 && input.maxCoeff() - input.minCoeff() > least;
}

std::optional<std::size_t> family_of(const std::vector<EffectFamily>& families, const std::string& effect,
                                     const std::string& form) {
  const auto found = std::ranges::find_if(
      families, [&](const EffectFamily& each) { return each.effect == effect && each.form == form; });
  if (found == families.end()) return std::nullopt;
  return static_cast<std::size_t>(found - families.begin());
}

std::vector<std::vector<double>> geometric_grid(double low, double high, double ratio) {
  std::vector<std::vector<double>> grid;
  for (double value = low; value <= high * (1.0 + 1e-9); value *= ratio) grid.push_back({value});
  return grid;
}

std::vector<EffectFamily> effect_families(const Simulation& simulation) {
  std::vector<EffectFamily> all;
  for (auto* part : {thermal_families, frequency_families, command_families, rate_families})
    for (auto& family : part(simulation)) all.push_back(std::move(family));
  return all;
}

}  // namespace hemi::diagnosis
