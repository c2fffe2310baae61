// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/instrument.hpp"

namespace hemi::concealed {
namespace {

// Rounded as a person would write it into a model file, so that the file holds the truth to the last digit.
double rounded(double value, double step) {
  const double per_unit = std::round(1.0 / step);
  return std::round(value * per_unit) / per_unit;
}

// Three to five terms besides the constant, df always: an instrument without it would be no HRG of the paper.
std::array<double, 10> random_bias(Random& random) {
  std::array<double, 10> terms{};
  terms[0] = rounded(random.uniform(-5.0, 5.0), 1e-4);
  terms[1] = rounded(random.sign() * random.uniform(0.02, 0.6), 1e-5);
  terms[4] = rounded(random.sign() * random.uniform(150.0, 1000.0), 1e-2);
  if (random.chance(0.7)) terms[2] = rounded(random.uniform(-0.01, 0.01), 1e-6);
  if (random.chance(0.5)) terms[3] = rounded(random.uniform(-3e-4, 3e-4), 1e-8);
  if (random.chance(0.6)) terms[7] = rounded(random.uniform(-25.0, 25.0), 1e-3);
  return terms;
}

NoiseLevel random_noise(Random& random, double white, bool phase_derived) {
  NoiseLevel noise;
  noise.white = white;
  if (random.chance(0.3)) noise.flicker = white * std::sqrt(random.log_uniform(3e-4, 5e-3));
  if (phase_derived && random.chance(0.4)) noise.differenced = white * random.uniform(0.5, 3.0);
  if (random.chance(0.15))
    noise.shape = NoiseLevel::Shape::kHeavyTailed;
  else if (random.chance(0.1))
    noise.shape = NoiseLevel::Shape::kLaplace;
  return noise;
}

Nuisance random_nuisance(Random& random) {
  Nuisance nuisance;
  if (random.chance(0.5)) nuisance.lag_s = random.uniform(0.0, 0.95);
  if (random.chance(0.3)) nuisance.start_offset_degc = random.normal();
  nuisance.case_step_degc = random.pick(std::vector<double>{0.01, 0.01, 0.01, 0.02, 0.05});
  nuisance.case_noise_degc = random.uniform(0.4, 1.2) * std::max(nuisance.case_step_degc, 0.01);
  nuisance.rate_step_dph = random.pick(std::vector<double>{1e-4, 1e-4, 1e-3, 1e-2});
  return nuisance;
}

}  // namespace

Series polynomial(const std::vector<double>& coefficients, const Series& x) {
  Series sum = Series::Zero(x.size());
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) sum = sum * x + *c;
  return sum;
}

Series bias(const Model& model, const Series& frequency_hz, const Series& slope_hz_per_s) {
  const auto& k = model.bias_dph;
  const Series f = frequency_hz - model.reference_hz;
  const Series& d = slope_hz_per_s;
  return k[0] + f * (k[1] + f * (k[2] + f * k[3])) +
         d * (k[4] + d * (k[5] + d * k[6]) + f * (k[7] + f * k[8] + d * k[9]));
}

Instrument random_instrument(Random& random) {
  Instrument unit;
  unit.model.frequency_hz = {4424.90095 + rounded(random.normal() * 0.5, 1e-5),
                             rounded(0.371555556 * (1.0 + 0.02 * random.normal()), 1e-12),
                             rounded(-9.70238095e-4 * (1.0 + 0.05 * random.normal()), 1e-12),
                             rounded(1.52777778e-5 * (1.0 + 0.05 * random.normal()), 1e-12)};
  unit.model.time_constant_s = rounded(random.uniform(1400.0, 2700.0), 1.0);
  unit.model.bias_dph = random_bias(random);
  if (random.chance(0.2)) unit.model.scale_factor = rounded(1.0 + 2e-3 * random.normal(), 1e-7);
  unit.model.drive_v = {rounded(random.uniform(1.6, 2.4), 1e-4), rounded(random.uniform(0.002, 0.007), 1e-5)};
  if (random.chance(0.3)) unit.model.drive_v.push_back(rounded(random.uniform(-3e-5, 3e-5), 1e-8));
  unit.model.quadrature_v = {rounded(random.uniform(0.3, 1.3), 1e-4),
                             rounded(random.uniform(-0.003, 0.005), 1e-5)};
  if (random.chance(0.3)) unit.model.quadrature_v.push_back(rounded(random.uniform(-2e-5, 2e-5), 1e-8));
  unit.noise[kFrequency] = random_noise(random, random.log_uniform(2e-5, 1e-4), true);
  unit.noise[kRate] = random_noise(random, random.uniform(0.4, 0.9), true);
  unit.noise[kDrive] = random_noise(random, random.log_uniform(1e-4, 4e-4), false);
  unit.noise[kQuadrature] = random_noise(random, random.log_uniform(1e-4, 4e-4), false);
  unit.amplitude_noise.white = 1e-5;
  unit.nuisance = random_nuisance(random);
  unit.board_lag_s = random.uniform(200.0, 900.0);
  unit.board_rise_degc = random.uniform(3.0, 7.0);
  return unit;
}

}  // namespace hemi::concealed
