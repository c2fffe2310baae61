// SPDX-License-Identifier: Apache-2.0
// Effects of where the heat is: more than one node between case and resonator.
#include <cmath>

#include "golden/concealed/effects.hpp"
#include "golden/concealed/hysteresis.hpp"

namespace hemi::concealed {
namespace {

/// Shell behind stem behind case, the shell loading the stem; poles tau1 and tau2. Runge-Kutta, 1 s.
Series through_stem(const Series& case_degc, double tau1_s, double tau2_s, double offset_degc) {
  const double sum = tau1_s + tau2_s, product = tau1_s * tau2_s;
  const double load = 0.3 * (sum - 2.0 * std::sqrt(product));
  const double root = std::sqrt((sum - load) * (sum - load) - 4.0 * product);
  const double stem_s = 0.5 * (sum - load - root), shell_s = product / stem_s;
  const double back_per_s = load / product;
  Series shell(case_degc.size());
  double x = case_degc[0] + offset_degc, y = x;
  shell[0] = y;
  const auto stem_rate = [&](double c, double p, double q) {
    return (c - p) / stem_s + (q - p) * back_per_s;
  };
  for (Eigen::Index i = 1; i < shell.size(); ++i) {
    const double c0 = case_degc[i - 1], c2 = case_degc[i], c1 = 0.5 * (c0 + c2);
    const double k1 = stem_rate(c0, x, y), l1 = (x - y) / shell_s;
    const double k2 = stem_rate(c1, x + 0.5 * k1, y + 0.5 * l1), l2 = (x + 0.5 * k1 - y - 0.5 * l1) / shell_s;
    const double k3 = stem_rate(c1, x + 0.5 * k2, y + 0.5 * l2), l3 = (x + 0.5 * k2 - y - 0.5 * l2) / shell_s;
    const double k4 = stem_rate(c2, x + k3, y + l3), l4 = (x + k3 - y - l3) / shell_s;
    x += (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
    y += (l1 + 2.0 * l2 + 2.0 * l3 + l4) / 6.0;
    shell[i] = y;
  }
  return shell;
}

Form second_time_constant(const Setting& in) {
  Form form;
  if (in.random.chance(0.6)) {
    form.name = "stem between case and shell";
    form.high = 500.0;
    form.at = [](double tau2_s) {
      return acting(Stage::kShell, [=](State& s) {
        const double offset = s.shell_degc[0] - s.in->case_ahead_degc[0];
        s.shell_degc = through_stem(s.in->case_ahead_degc, s.model->time_constant_s - tau2_s,
                                    std::max(tau2_s, 1.0), offset);
      });
    };
    form.parameters = [](double tau2_s) { return Values{{"second_time_constant", tau2_s}}; };
  } else {
    form.name = "slow body seen beside the case";
    const double slow_s = in.random.uniform(4500.0, 10800.0);
    form.high = 0.25;
    form.at = [slow_s](double share) {
      return acting(Stage::kShell, [=](State& s) {
        s.shell_degc =
            (1.0 - share) * s.shell_degc + share * lagged(s.in->case_ahead_degc, slow_s, s.shell_degc[0]);
      });
    };
    form.parameters = [slow_s](double) { return Values{{"second_time_constant", slow_s}}; };
  }
  return form;
}

Form self_heating(const Setting& in) {
  Form form;
  const double tau_s = in.random.uniform(600.0, 3500.0);
  const bool two = in.random.chance(0.4);
  form.name = two ? "electronics box and stem" : "one body";
  const Series heat =
      two ? Series(0.8 * lagged(in.in.power, tau_s, 0.0) + 0.2 * lagged(in.in.power, 0.15 * tau_s, 0.0))
          : lagged(in.in.power, tau_s, 0.0);
  form.high = 5.0;
  form.at = [heat](double rise_degc) {
    return acting(Stage::kShell, [=](State& s) { s.shell_degc += rise_degc * heat; });
  };
  form.parameters = [=](double rise_degc) {
    Values values{{"rise", rise_degc}};
    if (!two) values["time_constant"] = tau_s;
    return values;
  };
  return form;
}

Form gradient(const Setting& in) {
  Form form;
  const double node_s = in.random.uniform(100.0, 700.0);
  const double first_s = in.random.chance(0.5) ? 0.0 : in.random.uniform(15.0, 60.0);
  form.name = first_s > 0.0 ? "two nodes behind the case" : "case and one node";
  form.high = 6.0;
  form.sign = in.random.sign();
  const Series& outer = in.in.case_ahead_degc;
  const Series near = first_s > 0.0 ? lagged(outer, first_s, outer[0]) : outer;
  const Series difference = near - lagged(near, node_s, near[0]);
  form.at = [difference](double gain) { return adding(Stage::kRate, kRate, difference, gain); };
  form.parameters = [=](double gain) { return Values{{"gain", gain}, {"node_time_constant", node_s}}; };
  return form;
}

Form hysteresis(const Setting& in) {
  Form form;
  Memory memory;
  const Series &shell = in.baseline.shell_degc, &first = in.sizing().baseline.shell_degc;
  switch (in.random.index(3)) {
    case 0:
      form.name = "Preisach";
      memory = preisach(shell, first, in.random.uniform(0.1, 0.5), in.random.uniform(0.1, 0.3));
      break;
    case 1:
      form.name = "Duhem";
      memory = duhem(shell, first, in.random.uniform(1.5, 8.0));
      break;
    default:
      form.name = "Bouc-Wen";
      memory = bouc_wen(shell, first, in.random.uniform(1.5, 6.0), in.random.uniform(0.55, 0.9));
  }
  form.high = 2.0;
  form.sign = in.random.sign();
  form.at = [memory](double height) { return adding(Stage::kRate, kRate, memory.along, height); };
  form.parameters = [memory](double height) {
    return Values{{"loop_height", std::abs(height) * memory.opening}};
  };
  return form;
}

}  // namespace

std::vector<Kind> thermal_kinds() {
  return {{"thermal_second_time_constant", "frequency_hz", 0, second_time_constant, {}},
          {"self_heating", "frequency_hz", kPower, self_heating, {}},
          {"thermal_gradient_bias", "rate_dph", 0, gradient, {}},
          {"thermal_hysteresis", "rate_dph", 0, hysteresis, {}}};
}

}  // namespace hemi::concealed
