// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/budget.hpp"

#include <numbers>

namespace hemi::golden {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kScale = config::table_scale / 1048576.0;
constexpr double kImageAbsolute = 81.0 / 64.0;
constexpr double kImageGain = 49.0 / 64.0;

double square(double v) {
  return v * v;
}
/// Variance of what rounding to steps of 2^-fraction leaves.
double rounding_variance(int fraction) {
  return square(power_of_two(-fraction)) / 12.0;
}
double chord_angle() {
  return kPi / 2.0 / (1 << config::table_index_bits);
}

Budget nco_budget() {
  const double h2 = square(chord_angle());
  const int angle_bits = 2 + config::table_index_bits + config::table_fine_bits;
  const double worst = h2 / 8.0 + power_of_two(-21) + power_of_two(-config::sine.fraction - 1) +
                       kPi * power_of_two(-angle_bits);
  const double variance = square(h2 / 2.0) / 180.0 / 2.0 + rounding_variance(20) * 2.0 / 3.0 +
                          rounding_variance(config::sine.fraction) +
                          square(2.0 * kPi) * rounding_variance(angle_bits) / 2.0;
  return {worst, std::sqrt(variance)};
}

Budget product_budget(const Budget& nco, double amplitude) {
  return {amplitude * nco.worst + power_of_two(-config::product.fraction - 1),
          std::sqrt(square(amplitude * nco.rms) / 2.0 + rounding_variance(config::product.fraction))};
}

/// Error of a baseband word, and its mean square when summed over ticks with given weights.
struct Decimated {
  int decimation;
  double cic_gain;
  double worst(const Budget& product) const {
    const double half_step = power_of_two(-config::baseband.fraction - 1);
    return kImageAbsolute * (cic_gain * product.worst + half_step) + half_step;
  }
  double variance(const Budget& product, const Eigen::VectorXd& tick_weights) const {
    Eigen::VectorXd image(5);
    for (Eigen::Index i = 0; i < 5; ++i)
      image[i] = config::image_taps[i] * power_of_two(-config::image_shift);
    const double from_samples = spread(baseband_response(decimation), tick_weights, decimation).squaredNorm();
    const double from_cic = spread(image, tick_weights, 1).squaredNorm();
    return square(product.rms) * from_samples +
           rounding_variance(config::baseband.fraction) * (from_cic + tick_weights.squaredNorm());
  }
};

double cordic_drop_worst() {
  return config::cordic_iterations * std::sqrt(2.0) * power_of_two(-32);
}
double cordic_drop_variance() {
  return config::cordic_iterations * square(power_of_two(-32)) / 3.0;
}

}  // namespace

Eigen::VectorXd spread(const Eigen::VectorXd& response, const Eigen::VectorXd& tick_weights, int decimation) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(response.size() + (tick_weights.size() - 1) * decimation);
  for (Eigen::Index t = 0; t < tick_weights.size(); ++t) {
    sum.segment(t * decimation, response.size()) += tick_weights[t] * response;
  }
  return sum;
}

Eigen::VectorXd baseband_response(int decimation) {
  Eigen::VectorXd taps(5);
  for (Eigen::Index i = 0; i < 5; ++i) taps[i] = config::image_taps[i] * power_of_two(-config::image_shift);
  const double gain = power_of_two(-config::growth_bits(decimation, config::cic_order));
  return spread(gain * cic_coefficients(decimation), taps, decimation);
}

Eigen::VectorXd frequency_tick_weights() {
  Eigen::VectorXd weights(2 * config::ticks_per_output);
  weights << Eigen::VectorXd::Ones(config::ticks_per_output),
      -Eigen::VectorXd::Ones(config::ticks_per_output);
  return weights;
}

Eigen::VectorXd triangular_tick_weights() {
  return spread(Eigen::VectorXd::Ones(config::ticks_per_output),
                Eigen::VectorXd::Ones(config::ticks_per_output), 1);
}

ChainBudget quantisation_budget(const OperatingPoint& point, const RegisterValues& values) {
  const int decimation = point.instrument.decimation;
  const double cic_gain = std::pow(decimation, config::cic_order) /
                          power_of_two(config::growth_bits(decimation, config::cic_order));
  const Decimated decimated{decimation, cic_gain};
  const double length = point.primary_amplitude / 2.0 * kScale * cic_gain * kImageGain;
  const double turn = 2.0 * kPi;
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const Eigen::VectorXd both = Eigen::VectorXd::Ones(Eigen::Index{2} * config::ticks_per_output);
  constexpr double kHzPerTurn = static_cast<double>(config::output_rate_hz) / config::ticks_per_output;
  const double ticks = static_cast<double>(both.size());

  ChainBudget budget{};
  budget.nco = nco_budget();
  const Budget product = product_budget(budget.nco, point.primary_amplitude);
  budget.baseband = {decimated.worst(product), std::sqrt(decimated.variance(product, one))};

  const double residue_turns = power_of_two(1 - config::cordic_iterations) / turn;
  const double angle_step = power_of_two(-config::angle.fraction);
  const double detector_worst =
      (std::sqrt(2.0) * budget.baseband.worst + cordic_drop_worst()) / length / turn + residue_turns +
      config::cordic_iterations * angle_step / 2.0;
  const double cordic_variance = square(residue_turns) / 3.0 +
                                 cordic_drop_variance() / square(length * turn) +
                                 config::cordic_iterations * square(angle_step) / 12.0;
  const auto phase_variance = [&](const Eigen::VectorXd& weights, double a_tick) {
    return decimated.variance(product, weights) / square(length * turn) + a_tick * weights.squaredNorm();
  };
  budget.detector_turns = {detector_worst, std::sqrt(phase_variance(one, cordic_variance))};

  const double total_variation = 1.0 + 2.0 * std::exp(-2.0);
  const double at_detector =
      detector_worst + power_of_two(-config::increment.fraction - 1) / values[config::reg_loop_integral];
  const double nco_difference = total_variation * at_detector;
  const double error_difference = (1.0 + total_variation) * at_detector;
  const double misfit = 1.5 * values[config::reg_loop_proportional] * error_difference;
  const double floor_step = power_of_two(-config::tick_phase.fraction);
  budget.frequency_hz = {kHzPerTurn * ticks * (detector_worst + misfit + floor_step),
                         kHzPerTurn * std::sqrt(phase_variance(frequency_tick_weights(),
                                                               cordic_variance + square(floor_step) / 12.0))};
  budget.phase_error_sum_turns = {ticks * error_difference, std::sqrt(phase_variance(both, cordic_variance))};

  const double gain = cordic_gain();
  const double chord = square(chord_angle()) / 12.0;
  budget.amplitude_sum = {
      ticks * gain *
          (std::sqrt(2.0) * budget.baseband.worst + cordic_drop_worst() + length * power_of_two(-46)),
      gain * std::sqrt(square(ticks * length * chord) + decimated.variance(product, both) +
                       ticks * cordic_drop_variance())};

  const Budget product_y = product_budget(budget.nco, point.secondary_amplitude);
  const Eigen::VectorXd triangle = triangular_tick_weights();
  const double rate_gain = std::abs(values[config::reg_rate_gain]);
  const double c = values[config::reg_demodulation_cos];
  const double s = values[config::reg_demodulation_sin];
  const double length_y = point.secondary_amplitude / 2.0 * kScale * cic_gain * kImageGain;
  const double turned = turn * nco_difference * length_y;
  const double word = power_of_two(-config::baseband.fraction - 1);
  const double in_phase_worst = (std::abs(c) + std::abs(s)) * (decimated.worst(product_y) + turned) + word;
  const double in_phase =
      length_y * std::abs(c * std::cos(point.secondary_phase_rad) + s * std::sin(point.secondary_phase_rad));
  const bool control = modulo(values[config::reg_control], 2.0) != 0.0;
  const double source_gain = control ? std::abs(values[config::reg_rebalance_proportional]) : 1.0;
  const Budget part{power_of_two(-config::command_integral.fraction - 1),
                    std::sqrt(rounding_variance(config::command_integral.fraction))};
  const double command_step = power_of_two(-config::command.fraction);
  const double source_worst = source_gain * in_phase_worst + (control ? part.worst + command_step : 0.0);
  const double source_variance =
      control ? square(part.rms) + rounding_variance(config::command.fraction) : 0.0;
  // Both have the same sign for a positive command.
  const double source_constant = source_gain * in_phase * chord + (control ? command_step / 2.0 : 0.0);
  const double in_phase_variance = (square(c) + square(s)) * decimated.variance(product_y, triangle) +
                                   rounding_variance(config::baseband.fraction) * triangle.squaredNorm();
  budget.rate_dph = {
      triangle.sum() * (rate_gain * source_worst + power_of_two(-config::rate_tick.fraction - 1)) +
          power_of_two(-config::rate.fraction - 1),
      std::sqrt(square(rate_gain) *
                    (square(source_gain) * in_phase_variance + source_variance * triangle.squaredNorm() +
                     square(triangle.sum() * source_constant)) +
                rounding_variance(config::rate_tick.fraction) * triangle.squaredNorm() +
                rounding_variance(config::rate.fraction))};
  return budget;
}

}  // namespace hemi::golden
