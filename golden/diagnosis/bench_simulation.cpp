// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/bench_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hemi::diagnosis {
namespace {

constexpr double kRunaway = 1e6;  // times the largest that a recording in volts holds

// columns: derivatives by parameters, padded so that the compiler can unroll them; 0: the motion alone.
template <int columns>
class Motion {
 public:
  using Columns = Eigen::Array<double, columns, 1>;
  struct State {
    double y, v;
    Columns sy, sv;
  };
  static constexpr bool with_columns = columns > 0;

  Motion(const BenchForm& form, const Eigen::VectorXd& parameters) : form_(form), p_(parameters) {}

  // Time derivative of the state under force u.
  State slope(const State& s, double u) const {
    State d{s.v, p_[kGain] * u + p_[kConstant] - p_[kDamping] * s.v - p_[kStiffness] * s.y, {}, {}};
    double by_y = -p_[kStiffness], by_v = -p_[kDamping];
    if constexpr (with_columns) d.sv.setZero();
    for (std::size_t j = 0; j < form_.terms.size(); ++j) {
      const Eigen::Index place = kLinear + static_cast<Eigen::Index>(j);
      const Shape f = shape(form_.terms[j], s.y, s.v, u);
      d.v -= p_[place] * f.value;
      by_y -= p_[place] * f.by_y;
      by_v -= p_[place] * f.by_v;
      if constexpr (with_columns) d.sv[place] = -f.value;
    }
    if constexpr (with_columns) {
      d.sy = s.sv;
      d.sv[kGain] = u;
      d.sv[kDamping] = -s.v;
      d.sv[kStiffness] = -s.y;
      d.sv[kConstant] = 1.0;
      d.sv += by_y * s.sy + by_v * s.sv;
    }
    return d;
  }

  static State moved(const State& s, const State& d, double h) {
    State next{s.y + h * d.y, s.v + h * d.v, {}, {}};
    if constexpr (with_columns) {
      next.sy = s.sy + h * d.sy;
      next.sv = s.sv + h * d.sv;
    }
    return next;
  }

  // One step of Runge and Kutta; force at its start, middle and end.
  void step(State& s, double h, double u0, double u1, double u2) const {
    const State a = slope(s, u0), b = slope(moved(s, a, h / 2), u1), c = slope(moved(s, b, h / 2), u1),
                d = slope(moved(s, c, h), u2);
    s.y += h / 6 * (a.y + 2 * b.y + 2 * c.y + d.y);
    s.v += h / 6 * (a.v + 2 * b.v + 2 * c.v + d.v);
    if constexpr (with_columns) {
      s.sy += h / 6 * (a.sy + 2 * b.sy + 2 * c.sy + d.sy);
      s.sv += h / 6 * (a.sv + 2 * b.sv + 2 * c.sv + d.sv);
    }
  }

 private:
  const BenchForm& form_;
  const Eigen::VectorXd& p_;
};

template <int columns>
Eigen::VectorXd run(const BenchInput& input, const BenchForm& form, const Eigen::VectorXd& parameters,
                    Eigen::MatrixXd* jacobian) {
  if (parameters.size() != form.size()) throw std::invalid_argument("parameters that do not fit the form");
  const Motion<columns> motion(form, parameters);
  const Eigen::Index first = form.start_row();
  typename Motion<columns>::State s{parameters[first], parameters[first + 1], {}, {}};
  if constexpr (columns > 0) {
    s.sy.setZero();
    s.sv.setZero();
    s.sy[first] = s.sv[first + 1] = 1.0;
    jacobian->resize(input.rows(), form.size());
  }
  const Eigen::Index parts = 2 * input.substeps();
  Eigen::VectorXd y(input.rows());
  for (Eigen::Index i = 0; i < input.rows(); ++i) {
    y[i] = s.y;
    if constexpr (columns > 0) jacobian->row(i) = s.sy.head(form.size()).matrix().transpose();
    if (i + 1 == input.rows()) break;
    if (!(std::abs(s.y) < kRunaway)) {
      y.tail(input.rows() - i).setConstant(std::nan(""));
      break;
    }
    for (Eigen::Index p = 0; p < parts; p += 2) {
      const double* u = input.fine().data() + i * parts + p;
      // At a sample the staircase jumps: the step before it ends on the old value.
      motion.step(s, input.step_s(), u[0], u[1], input.end_of_step(i * parts + p));
    }
  }
  return y;
}

}  // namespace

BenchInput::BenchInput(const Eigen::VectorXd& force_v, double sample_rate_hz, int substeps, Hold hold)
    : rows_(force_v.size()),
      substeps_(substeps),
      step_s_(1.0 / (sample_rate_hz * substeps)),
      staircase_(hold == Hold::zero_order),
      fine_(refine(force_v, substeps, hold)) {}

int substeps_for(double stiffness_per_s2, double sample_rate_hz) {
  const double turn = std::sqrt(std::abs(stiffness_per_s2)) / sample_rate_hz;
  const double step = std::pow(120.0 * 2e-6, 0.25);
  return std::clamp(static_cast<int>(std::ceil(turn / step)), 1, 32);
}

Eigen::VectorXd simulate(const BenchInput& input, const BenchForm& form, const Eigen::VectorXd& parameters) {
  return run<0>(input, form, parameters, nullptr);
}

Eigen::VectorXd simulate(const BenchInput& input, const BenchForm& form, const Eigen::VectorXd& parameters,
                         Eigen::MatrixXd& jacobian) {
  if (form.size() <= 8) return run<8>(input, form, parameters, &jacobian);
  if (form.size() <= 12) return run<12>(input, form, parameters, &jacobian);
  return run<kLinear + static_cast<int>(kTerms) + 2>(input, form, parameters, &jacobian);
}

}  // namespace hemi::diagnosis
