// SPDX-License-Identifier: Apache-2.0
// Effects on the resonator's frequency, and on the clock that it is counted against.
#include <cmath>

#include "golden/concealed/effects.hpp"

namespace hemi::concealed {
namespace {

Form quartic(const Setting& in) {
  Form form;
  const double centre_degc = in.random.uniform(0.0, 20.0);
  const double skew = in.random.chance(0.3) ? in.random.uniform(-0.3, 0.3) : 0.0;
  form.name = skew == 0.0 ? "fourth order" : "fourth and fifth order";
  form.high = 2e-7;
  form.sign = in.random.sign();
  form.at = [=](double a4) {
    return acting(Stage::kFrequency, [=](State& s) {
      const Series x = s.shell_degc - centre_degc;
      s.frequency_hz += a4 * x.square().square() * (1.0 + skew * x / 30.0);
    });
  };
  form.parameters = [=](double a4) { return skew == 0.0 ? Values{{"a4", a4}} : Values{}; };
  return form;
}

/// 0 at the start, 1 at the end of the run that sizes it, concave; the last form hardly bends.
Series ageing_shape(const Setting& in, std::string& name) {
  Random& random = in.random;
  const Series &time_s = in.in.time_s, &first_s = in.sizing().in.time_s;
  const double end_s = first_s[first_s.size() - 1];
  const double t0_s = end_s * random.uniform(0.1, 0.6);
  std::function<Series(const Series&)> shape;
  switch (random.index(3)) {
    case 0:
      name = "logarithmic";
      shape = [=](const Series& t) -> Series { return (1.0 + t / t0_s).log(); };
      break;
    case 1:
      name = "stretched exponential";
      shape = [=](const Series& t) -> Series { return 1.0 - (-(t / t0_s).pow(0.7)).exp(); };
      break;
    default:
      name = "power law";
      shape = [end_s, power = random.uniform(0.3, 0.8)](const Series& t) -> Series {
        return ((t + 60.0) / end_s).pow(power);
      };
  }
  const Series first = shape(first_s);
  return (shape(time_s) - first[0]) / (first[first.size() - 1] - first[0]);
}

Form ageing(const Setting& in) {
  Form form;
  const Series shape = ageing_shape(in, form.name);
  form.high = 0.022;
  form.sign = in.random.sign();
  form.at = [shape](double total_hz) { return adding(Stage::kFrequency, kFrequency, shape, total_hz); };
  form.parameters = [](double total_hz) { return Values{{"total", total_hz}}; };
  return form;
}

Form scaled_frequency(const std::string& name, const Series& relative, double high, double sign,
                      const std::string& parameter, Stage stage = Stage::kFrequency) {
  Form form;
  form.name = name;
  form.high = high;
  form.sign = sign;
  form.at = [=](double strength) {
    return acting(stage, [=](State& s) { s.frequency_hz *= 1.0 + strength * relative; });
  };
  form.parameters = [parameter](double strength) { return Values{{parameter, strength}}; };
  return form;
}

Form duffing(const Setting& in) {
  return scaled_frequency("energy of the vibration", in.in.amplitude.square() - 1.0, 2e-6, in.random.sign(),
                          "relative_shift");
}

Form softening(const Setting& in) {
  const Series v = in.in.supply_v / 150.0;
  return scaled_frequency("spring of the field", 1.0 - v.square(), 2e-4, 1.0, "relative_shift");
}

/// Peak to peak 1 over the board temperatures of the run that sizes it.
Series oscillator_shape(const Setting& in, std::string& name) {
  Random& random = in.random;
  const double turn_degc = random.uniform(15.0, 35.0);
  std::function<Series(const Series&)> y;
  switch (random.index(3)) {
    case 0:
      name = "tuning fork";
      y = [](const Series& x) -> Series { return -x.square(); };
      break;
    case 1:
      name = "AT cut";
      y = [linear = random.uniform(-1.0, 0.4)](const Series& x) -> Series { return x * linear + x.cube(); };
      break;
    default:
      name = "compensated crystal";
      y = [phase = random.uniform(0.0, 1.0)](const Series& x) -> Series {
        return (2.2 * x + phase).sin() - 1.6 * x + 0.3 * x.cube();
      };
  }
  const Series first = y((in.sizing().in.board_degc - turn_degc) / 30.0);
  return y((in.in.board_degc - turn_degc) / 30.0) / std::max(first.maxCoeff() - first.minCoeff(), 1e-9);
}

Form oscillator_temperature(const Setting& in) {
  std::string name;
  const Series y = oscillator_shape(in, name);
  Form form = scaled_frequency(name, -1e-6 * y, 30.0, in.random.sign(), "ppm_span", Stage::kClock);
  form.parameters = [](double ppm) { return Values{{"ppm_span", std::abs(ppm)}}; };  // peak to peak
  return form;
}

Form oscillator_ageing(const Setting& in) {
  return scaled_frequency("linear", -1e-6 * in.in.time_s / 86400.0, 2.0, in.random.sign(), "rate",
                          Stage::kClock);
}

Form loop_lag(const Setting& in) {
  Form form;
  const bool second_order = in.random.chance(0.5);
  form.name = second_order ? "second order" : "first order";
  form.low = 0.01;
  form.high = 120.0;
  form.at = [=](double tau_s) {
    return acting(Stage::kClock, [=](State& s) {
      const double each_s = second_order ? 0.5 * tau_s : tau_s;
      for (int i = 0; i < (second_order ? 2 : 1); ++i)
        s.frequency_hz = lagged(s.frequency_hz, each_s, s.frequency_hz[0]);
    });
  };
  form.parameters = [](double) { return Values{}; };
  return form;
}

Form cycle_slips(const Setting& in) {
  Form form;
  form.name = "whole turns, one way or both";
  form.scalable = false;
  form.high = static_cast<double>(1 + in.random.index(12));
  const bool both = in.random.chance(0.5);
  Series pulses = Series::Zero(in.in.time_s.size());
  for (int i = 0; i < static_cast<int>(form.high); ++i) {
    const auto at =
        1 + static_cast<Eigen::Index>(in.random.index(static_cast<std::size_t>(pulses.size() - 3)));
    const double here = in.random.chance(0.7) ? 1.0 : in.random.uniform(0.2, 0.8);  // across two averages
    const double turn = both ? in.random.sign() : 1.0;
    pulses[at] += turn * here;
    pulses[at + 1] += turn * (1.0 - here);
  }
  form.at = [pulses](double) { return adding(Stage::kClock, kFrequency, pulses, 1.0); };
  form.parameters = [](double count) { return Values{{"count", count}}; };
  return form;
}

}  // namespace

std::vector<Kind> frequency_kinds() {
  return {{"frequency_polynomial_order", "frequency_hz", kBoardLoad, quartic, {}},
          {"frequency_ageing", "frequency_hz", 0, ageing, {"oscillator_ageing"}},
          {"duffing", "frequency_hz", kSteps, duffing, {}},
          {"electrostatic_softening", "frequency_hz", kSupply, softening, {}},
          {"oscillator_temperature", "frequency_hz", kBoardLoad, oscillator_temperature, {}},
          {"oscillator_ageing", "frequency_hz", 0, oscillator_ageing, {"frequency_ageing"}, true},
          {"pll_lag", "frequency_hz", 0, loop_lag, {"time_shift"}},
          {"cycle_slip", "frequency_hz", 0, cycle_slips, {}}};
}

}  // namespace hemi::concealed
