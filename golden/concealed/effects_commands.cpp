// SPDX-License-Identifier: Apache-2.0
// Effects on the two slow commands: drive and quadrature.
#include <cmath>

#include "golden/concealed/effects.hpp"

namespace hemi::concealed {
namespace {

Form scaled_drive(const std::string& name, const Series& relative, double high, double sign,
                  const std::string& parameter) {
  Form form;
  form.name = name;
  form.high = high;
  form.sign = sign;
  form.at = [=](double strength) {
    return acting(Stage::kDrive, [=](State& s) { s.drive_v *= 1.0 + strength * relative; });
  };
  form.parameters = [parameter](double strength) { return Values{{parameter, strength}}; };
  return form;
}

/// The pressure outside is finite: growth bends over a day or two.
Form gas_leak(const Setting& in) {
  const double fill_h = in.random.uniform(20.0, 60.0);
  const Series hours = in.in.time_s / 3600.0;
  return scaled_drive("towards the outer pressure", fill_h * (1.0 - (-hours / fill_h).exp()), 0.02, 1.0,
                      "rate");
}

/// Thermoelastic or activated loss: a peak in temperature, less what the nominal polynomial takes of it.
Form damping_peak(const Setting& in) {
  const Sized shell{in.baseline.shell_degc, in.sizing().baseline.shell_degc};
  const double low = shell.first.minCoeff(), high = shell.first.maxCoeff();
  const double centre = in.random.uniform(low + 0.2 * (high - low), high - 0.2 * (high - low));
  const double width = in.random.uniform(0.1, 0.3) * std::max(high - low, 1.0);
  const bool activated = in.random.chance(0.5);
  const auto bump = [&](const Series& degc) -> Series {
    const Series x = (degc - centre) / width;
    return activated ? Series(1.0 / x.cosh()) : Series(1.0 - x.tanh().square());
  };
  const Sized rest =
      beyond_polynomial({bump(shell.here), bump(shell.first)}, shell, in.model.drive_v.size() - 1);
  const Series shape = rest.here / std::max(rest.first.abs().maxCoeff(), 1e-9);
  return scaled_drive(activated ? "activated loss" : "squared hyperbolic tangent", shape, 0.02, 1.0, "peak");
}

Form damping_nonlinearity(const Setting& in) {
  const bool quadratic = in.random.chance(0.4);
  const Series& a = in.in.amplitude;
  const Series relative = quadratic ? Series(2.0 * (a - 1.0)) : Series(a.square() - 1.0);
  return scaled_drive(quadratic ? "force ~ v |v|" : "force ~ v^3", relative, 0.02, 1.0, "relative");
}

Form pickoff_gain(const Setting& in) {
  Form form;
  form.name = "gain of the first pickoff";
  form.high = 1e-3;
  form.sign = in.random.sign();
  const Series warm = in.in.board_degc - 25.0;
  class Gain : public Effect {
   public:
    explicit Gain(Series error) : error_(std::move(error)) {}
    void act(State& s, Stage stage) const override {
      if (stage == Stage::kDrive) s.drive_v /= error_;
      if (stage == Stage::kOutput) s.rate_dph /= error_;
    }

   private:
    Series error_;
  };
  form.at = [warm](double per_degc) { return std::make_shared<Gain>(1.0 + per_degc * warm); };
  form.parameters = [](double per_degc) { return Values{{"per_degc", per_degc}}; };
  return form;
}

Form split(const Setting& in) {
  Form form;
  const Sized shell{in.baseline.shell_degc, in.sizing().baseline.shell_degc};
  const double centre = shell.first.mean();
  const double half = std::max(0.5 * (shell.first.maxCoeff() - shell.first.minCoeff()), 0.5);
  const Sized x{(shell.here - centre) / half, (shell.first - centre) / half};
  std::function<Series(const Series&)> bend;
  switch (in.random.index(3)) {
    case 0:
      form.name = "axis turns with temperature";
      bend = [turn = in.random.uniform(1.5, 3.5), from = in.random.uniform(0.0, 3.0)](const Series& at) {
        return Series((turn * at + from).sin());
      };
      break;
    case 1:
      form.name = "saturating strain";
      bend = [steep = in.random.uniform(2.0, 6.0), from = in.random.uniform(-0.4, 0.4)](const Series& at) {
        return Series((steep * (at - from)).atan());
      };
      break;
    default:
      form.name = "exponential in temperature";
      bend = [steep = in.random.sign() * in.random.uniform(1.5, 3.0)](const Series& at) {
        return Series((steep * at).exp());
      };
  }
  const Series shape =
      beyond_polynomial({bend(x.here), bend(x.first)}, shell, in.model.quadrature_v.size() - 1).here;
  form.high = 0.05;
  form.sign = in.random.sign();
  form.at = [shape](double span_v) { return adding(Stage::kQuadrature, kQuadrature, shape, span_v); };
  form.parameters = [](double span_v) { return Values{{"span", std::abs(span_v)}}; };
  return form;
}

}  // namespace

std::vector<Kind> command_kinds() {
  return {{"gas_leak", "drive_v", 0, gas_leak, {}},
          {"damping_temperature", "drive_v", 0, damping_peak, {}},
          {"damping_nonlinearity", "drive_v", kSteps, damping_nonlinearity, {}},
          {"pickoff_gain", "", kTurn | kBoardLoad, pickoff_gain, {}},
          {"frequency_split", "quadrature_v", 0, split, {}}};
}

}  // namespace hemi::concealed
