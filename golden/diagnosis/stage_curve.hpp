// SPDX-License-Identifier: Apache-2.0
// Which static curve makes the harmonics of a pickoff: its own, a clipped top, the converter's codes, an
// offset.
#pragma once

#include <string_view>

#include "golden/diagnosis/stage_tones.hpp"

namespace hemi::diagnosis {

enum class Curve {
  none,
  offset,     ///< a constant and no harmonic
  stiffness,  ///< c2 = -c0/3: x'' + w^2 (x + k2 x^2) moves its own mean the other way
  smooth,     ///< a2 v^2 + .. + a5 v^5, nothing at v = 0
  flat_top,   ///< what is beyond a level is cut or bent
  codes       ///< anything else that goes with the value of the signal
};
std::string_view name(Curve curve);

/// One curve fitted to the harmonics: chi^2 of what is left, and how much of the chi^2 of no curve it takes.
struct CurveFit {
  Curve curve = Curve::none;
  int parameters = 0;
  double chi2 = 0.0;
  double p = 1.0;          ///< of chi2, by the chi^2 distribution
  double explained = 0.0;  ///< 1 - chi2 / chi2 of no curve
  double strength =
      0.0;  ///< offset [LSB]; k2 A; largest |v| part of the polynomial over A; level over A; rms [LSB]
  double strength_sigma = 0.0;
  double second = 0.0;      ///< smooth: a2 A, relative change of gain at the top
  double third = 0.0;       ///< smooth: a3 A^2
  double offset_lsb = 0.0;  ///< smooth with offset, flat_top: the constant beside the curve
  double offset_sigma_lsb = 0.0;
};

struct CurveChoice {
  double chi2 = 0.0;  ///< of no curve
  int freedom = 0;
  double p = 1.0;
  CurveFit chosen;
  std::vector<CurveFit> tried;
  double in_quadrature_p = 1.0;  ///< of the sine parts, which no static curve makes
};

/// `significance`: below this p there is a curve. A form is taken where it leaves nothing (p > 1e-3) or,
/// strong effects being larger than any form is exact, takes 99.5 % (flat_top: 90 %) of the chi^2; the one
/// with the fewest parameters goes first. smooth is tried without and with an offset. Docs: docs/stage.md.
CurveChoice choose_curve(const Harmonics& harmonics, double significance);

}  // namespace hemi::diagnosis
