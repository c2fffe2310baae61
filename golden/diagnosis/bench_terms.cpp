// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/bench_terms.hpp"

#include <array>

namespace hemi::diagnosis {
namespace {

constexpr std::array<TermInfo, kTerms> kInfos = {{
    {Term::stiffness_cubic, "y^3", "duffing", "k3", "1/(V^2 s^2)"},
    {Term::stiffness_square, "y^2", "quadratic_stiffness", "k2", "1/(V s^2)"},
    {Term::damping_quadratic, "y' |y'|", "damping_nonlinearity", "c2", "1/V"},
    {Term::damping_cubic, "y'^3", "damping_nonlinearity", "c3", "s/V^2"},
    {Term::stiffness_modulus, "y |y|", "", "km", "1/(V s^2)"},
    {Term::stiffness_quintic, "y^5", "", "k5", "1/(V^4 s^2)"},
    {Term::damping_position, "y y'", "", "d1", "1/(V s)"},
    {Term::damping_amplitude, "y^2 y'", "", "d2", "1/(V^2 s)"},
    {Term::gain_position, "u y", "", "b1", "1/(V s^2)"},
    {Term::gain_square, "u^2", "", "b2", "1/(V s^2)"},
    {Term::gain_cubic, "u^3", "", "b3", "1/(V^2 s^2)"},
}};

}  // namespace

std::span<const TermInfo, kTerms> bench_terms() {
  return kInfos;
}

const TermInfo& info(Term term) {
  return kInfos[static_cast<std::size_t>(term)];
}

}  // namespace hemi::diagnosis
