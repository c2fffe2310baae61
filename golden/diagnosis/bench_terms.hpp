// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace hemi::diagnosis {

/// Forces that a driven resonator may have beside the linear ones; strength times shape(y, y', u) stands on
/// the left of y'' + d y' + k1 y + ... = b u + c. y: displacement [V], y': its derivative [V/s], u: force
/// [V].
enum class Term {
  stiffness_cubic,    ///< y^3
  stiffness_square,   ///< y^2
  damping_quadratic,  ///< y' |y'|
  damping_cubic,      ///< y'^3
  stiffness_modulus,  ///< y |y|
  stiffness_quintic,  ///< y^5
  damping_position,   ///< y y'
  damping_amplitude,  ///< y^2 y'
  gain_position,      ///< u y
  gain_square,        ///< u^2
  gain_cubic,         ///< u^3
};
inline constexpr std::size_t kTerms = 11;

struct TermInfo {
  Term term;
  std::string_view shape;  ///< formula
  std::string_view
      effect;  ///< id in the catalogue; empty: a rival that no effect of the catalogue stands for
  std::string_view parameter;  ///< name of its strength
  std::string_view unit;       ///< of its strength
};

std::span<const TermInfo, kTerms> bench_terms();
const TermInfo& info(Term term);

/// Shape and its derivatives by displacement and velocity.
struct Shape {
  double value;
  double by_y;
  double by_v;
};

inline Shape shape(Term term, double y, double v, double u) {
  const double size_y = y < 0.0 ? -y : y;
  const double size_v = v < 0.0 ? -v : v;
  switch (term) {
    case Term::stiffness_cubic:
      return {y * y * y, 3.0 * y * y, 0.0};
    case Term::stiffness_square:
      return {y * y, 2.0 * y, 0.0};
    case Term::damping_quadratic:
      return {v * size_v, 0.0, 2.0 * size_v};
    case Term::damping_cubic:
      return {v * v * v, 0.0, 3.0 * v * v};
    case Term::stiffness_modulus:
      return {y * size_y, 2.0 * size_y, 0.0};
    case Term::stiffness_quintic:
      return {y * y * y * y * y, 5.0 * y * y * y * y, 0.0};
    case Term::damping_position:
      return {y * v, v, y};
    case Term::damping_amplitude:
      return {y * y * v, 2.0 * y * v, y * y};
    case Term::gain_position:
      return {u * y, u, 0.0};
    case Term::gain_square:
      return {u * u, 0.0, 0.0};
    case Term::gain_cubic:
      return {u * u * u, 0.0, 0.0};
  }
  return {0.0, 0.0, 0.0};
}

}  // namespace hemi::diagnosis
