// SPDX-License-Identifier: Apache-2.0
// Drive and quadrature commands.
#include <Eigen/QR>
#include <cmath>

#include "golden/diagnosis/effect_family.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Shape = std::vector<double>;
constexpr double kCommandHour_s = 3600.0;
constexpr double kBoardReference_degc = 25.0;

Trace in(Output output, const ArrayXd& column) {
  Trace trace;
  trace[output] = column;
  return trace;
}

ArrayXd command(const Simulation& s, Output output) {
  return s.nominal[output];
}

// How a command may leave its polynomial in T: local ones have a centre and a width, as shares of T's range.
enum class Course { bump, step, square, cube };

ArrayXd course_of(const Simulation& s, Course course, const Shape& shape) {
  if (course == Course::square || course == Course::cube)
    return ((s.smooth_degc - 20.0) / 30.0).pow(course == Course::square ? 2 : 3);
  const double range = span(s.smooth_degc);
  const ArrayXd x = (s.smooth_degc - s.smooth_degc.minCoeff() - shape[0] * range) / (shape[1] * range);
  if (course == Course::bump) return (-0.5 * x.square()).exp();
  return x.tanh();
}

const char* text_of(Course course) {
  switch (course) {
    case Course::bump:
      return " += A p exp(-((T - Tc) / w)^2 / 2)";
    case Course::step:
      return " += A p tanh((T - Tc) / w)";
    case Course::square:
      return " += A p (T - T0)^2";
    default:
      return " += A p (T - T0)^3";
  }
}

std::vector<Shape> local_grid() {
  std::vector<Shape> grid;
  for (const double width : {0.07, 0.13, 0.25})
    for (double centre = 0.001; centre < 1.01; centre += width == 0.07 ? 0.09 : 0.125)
      grid.push_back({centre, width});
  return grid;
}

// What is left of a deviation after the model's polynomial took its part: that is what can be called
// beyond it.
ArrayXd beyond_polynomial(const Simulation& s, const ArrayXd& deviation, std::size_t terms) {
  Eigen::MatrixXd powers(deviation.size(), static_cast<Eigen::Index>(terms));
  const ArrayXd t = (s.smooth_degc - s.smooth_degc.mean()) / span(s.smooth_degc);
  for (Eigen::Index i = 0; i < powers.cols(); ++i) powers.col(i) = t.pow(static_cast<double>(i));
  const Eigen::VectorXd rest = deviation.matrix();
  return rest - powers * powers.colPivHouseholderQr().solve(rest);
}

EffectFamily deviation(const char* effect, Output output, Course course) {
  EffectFamily family;
  family.effect = effect;
  const bool drive = output == Output::drive;
  family.form = std::string(drive ? "drive" : "quadrature") + text_of(course);
  if (course == Course::bump || course == Course::step) {
    family.grid = local_grid();
    family.spacing = {1.15, 1.35};
  }
  const auto shift = [course](const Simulation& s, const Shape& shape) {
    return course_of(s, course, shape);
  };
  family.columns = [shift, output](const Simulation& s, const Shape& shape) {
    return std::vector<Trace>{in(output, s.telemetry->amplitude.array() * shift(s, shape))};
  };
  family.figures = [shift, drive](const Simulation& s, const Shape& c, const Shape& shape) {
    const auto& polynomial = drive ? s.model.drive_v : s.model.quadrature_v;
    const ArrayXd rest = c[0] * beyond_polynomial(s, shift(s, shape), polynomial.coefficients.size());
    if (!drive) return std::vector<Figure>{{"span", "V", span(rest)}};
    return std::vector<Figure>{{"peak", "1", (rest / polynomial.at(s.smooth_degc)).abs().maxCoeff()}};
  };
  return family;
}

// Towards the pressure outside, in 80 hours as good as in a straight line.
EffectFamily gas_leak() {
  EffectFamily family;
  family.effect = "gas_leak";
  family.form = "drive = drive (1 + r t0 (1 - exp(-t / t0)))";
  family.grid = geometric_grid(5.0, 80.0, 2.0);
  family.spacing = {2.0};
  family.columns = [](const Simulation& s, const Shape& shape) {
    const ArrayXd hours = s.time_s / kCommandHour_s;
    return std::vector<Trace>{
        in(Output::drive, command(s, Output::drive) * shape[0] * (1.0 - (-hours / shape[0]).exp()))};
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape&) {
    return std::vector<Figure>{{"rate", "1/h", c[0]}};
  };
  family.possible = [](const Simulation&, const Shape& c, const Shape&) { return c[0] > 0.0; };
  return family;
}

EffectFamily damping_nonlinearity(int exponent) {
  EffectFamily family;
  family.effect = "damping_nonlinearity";
  family.form = exponent == 1 ? "drive = drive (1 + c (A - 1))" : "drive = drive (1 + c (A^2 - 1))";
  family.columns = [exponent](const Simulation& s, const Shape&) {
    const ArrayXd amplitude = s.telemetry->amplitude;
    return std::vector<Trace>{in(Output::drive, command(s, Output::drive) * (amplitude.pow(exponent) - 1.0))};
  };
  family.figures = [exponent](const Simulation&, const Shape& c, const Shape&) {
    return std::vector<Figure>{{"relative", "1", exponent == 1 ? 0.5 * c[0] : c[0]}};
  };
  return family;
}

EffectFamily split_in_time() {
  EffectFamily family;
  family.effect = "frequency_split";
  family.form = "quadrature += A r t";
  family.columns = [](const Simulation& s, const Shape&) {
    return std::vector<Trace>{
        in(Output::quadrature, s.telemetry->amplitude.array() * s.time_s / kCommandHour_s)};
  };
  family.figures = [](const Simulation& s, const Shape& c, const Shape&) {
    return std::vector<Figure>{{"span", "V", std::abs(c[0]) * span(s.time_s) / kCommandHour_s}};
  };
  return family;
}

// True amplitude A / (1 + e), e = k (Tb - 25): force commands fall with it, and so does the Coriolis force.
EffectFamily pickoff_gain(bool rate, bool quadrature) {
  EffectFamily family;
  family.effect = "pickoff_gain";
  family.form = "e = k (Tb - 25), drive /= 1 + e";
  if (quadrature) family.form += ", quadrature /= 1 + e";
  if (rate) family.form += ", rate /= 1 + e";
  family.columns = [rate, quadrature](const Simulation& s, const Shape&) {
    const ArrayXd e = s.board_degc - kBoardReference_degc;
    Trace trace = in(Output::drive, -command(s, Output::drive) * e);
    if (quadrature)
      trace[Output::quadrature] = -(command(s, Output::quadrature) - s.telemetry->trim_v.array()) * e;
    if (rate) trace[Output::rate] = -s.telemetry->rate_in_dph.array() * e;
    return std::vector<Trace>{trace};
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape&) {
    return std::vector<Figure>{{"per_degc", "1/degC", c[0]}};
  };
  return family;
}

void add_drive(std::vector<EffectFamily>& families, const Telemetry& t) {
  families.push_back(gas_leak());
  if (moves(t.case_degc, 1.0)) {
    for (const Course course : {Course::bump, Course::square, Course::cube})
      families.push_back(deviation("damping_temperature", Output::drive, course));
  }
  if (moves(t.amplitude, 1e-3))
    for (const int exponent : {1, 2}) families.push_back(damping_nonlinearity(exponent));
  if (!t.has_board || !moves(t.board_degc, 0.5)) return;
  const bool turning = t.has(Output::rate) && moves(t.rate_in_dph, 1.0);
  for (const bool quadrature : {false, true}) {
    families.push_back(pickoff_gain(false, quadrature));
    if (turning) families.push_back(pickoff_gain(true, quadrature));
  }
}

}  // namespace

std::vector<EffectFamily> command_families(const Simulation& s) {
  std::vector<EffectFamily> families;
  const Telemetry& t = *s.telemetry;
  if (t.has(Output::drive)) add_drive(families, t);
  if (!t.has(Output::quadrature)) return families;
  families.push_back(split_in_time());
  if (moves(t.case_degc, 1.0))
    for (const Course course : {Course::bump, Course::step, Course::square, Course::cube})
      families.push_back(deviation("frequency_split", Output::quadrature, course));
  return families;
}

}  // namespace hemi::diagnosis
