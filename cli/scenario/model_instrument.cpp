// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/model_instrument.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "cli/recording/error.hpp"
#include "golden/calibration/frequency_polynomial.hpp"
#include "golden/physics/converters.hpp"
#include "golden/physics/noise.hpp"
#include "golden/physics/slow_twin_loops.hpp"
#include "hls/config.hpp"

namespace hemi::scenario {
namespace {

using physics::Instrument;
using physics::kReferenceDegc;
using physics::kTwoPi;
using Coefficients = std::vector<double>;

constexpr double kAdcFullScaleLsb = 32768.0;  // noise is given in LSB of 16 bits
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// The same polynomial about reference + shift: repeated synthetic division.
Coefficients shifted(Coefficients c, double shift) {
  for (std::size_t i = 0; i + 1 < c.size(); ++i) {
    for (std::size_t j = c.size() - 1; j > i; --j) c[j - 1] += shift * c[j];
  }
  return c;
}

Coefficients scaled(Coefficients c, double factor) {
  for (double& coefficient : c) coefficient *= factor;
  return c;
}

void add(Coefficients& sum, const Coefficients& term, double factor) {
  sum.resize(std::max(sum.size(), term.size()));
  for (std::size_t i = 0; i < term.size(); ++i) sum[i] += factor * term[i];
}

double axis_cos(double axis_deg) {
  return std::cos(2.0 * axis_deg * kRadPerDeg);
}
double axis_sin(double axis_deg) {
  return std::sin(2.0 * axis_deg * kRadPerDeg);
}

/// What the primary mode's frequency has below f(T), about the reference of f(T).
Coefficients half_split_hz(const Instrument& i) {
  return scaled(shifted(i.relative_split, i.frequency_reference_degc - kReferenceDegc),
                0.5 * i.split_hz * axis_cos(i.split_axis_deg));
}

/// Steady drive over 1/tau at nominal amplitude.
double mode_damping(const Instrument& i) {
  return 1.0 + 0.5 * i.damping_mismatch * axis_cos(i.damping_axis_deg);
}

/// Bias of the damping mismatch as a cubic in f - reference [deg/h]: least squares on Chebyshev's points.
std::array<double, 4> mismatch_bias_dph(const Instrument& i, const TemperatureRange& range) {
  const Eigen::Map<const Eigen::VectorXd> c(i.frequency_hz.data(),
                                            static_cast<Eigen::Index>(i.frequency_hz.size()));
  const calibration::FrequencyPolynomial f(c, i.frequency_reference_degc, range.low_degc, range.high_degc);
  if (!f.monotone()) throw std::invalid_argument("f(T) is not monotonic over the temperatures of the run");
  constexpr int kPoints = 64;
  Eigen::MatrixXd powers(kPoints, 4);
  Eigen::VectorXd bias(kPoints);
  for (int k = 0; k < kPoints; ++k) {
    const double unit = std::cos(std::numbers::pi * (k + 0.5) / kPoints);
    const double degc =
        std::midpoint(range.low_degc, range.high_degc) + 0.5 * (range.high_degc - range.low_degc) * unit;
    const physics::Parameters p = i.at(degc);
    const double offset_hz = f.frequency_hz(degc) - i.bias_reference_hz;
    powers.row(k) << 1.0, offset_hz, offset_hz * offset_hz, offset_hz * offset_hz * offset_hz;
    bias[k] = p.mismatch_sin_per_s / (2.0 * i.kappa) / physics::kRadPerSecondPerDph;
  }
  const Eigen::Vector4d fit = powers.colPivHouseholderQr().solve(bias);
  return {fit[0], fit[1], fit[2], fit[3]};
}

recording::VoltageModel drive_model(const Instrument& i) {
  return {kReferenceDegc, scaled(i.relative_damping,
                                 i.drive_full_scale_v / i.drive_full_scale_over_steady * mode_damping(i))};
}

recording::VoltageModel quadrature_model(const Instrument& i) {
  return {kReferenceDegc,
          scaled(i.relative_split, i.quadrature_full_scale_v * i.split_hz * axis_sin(i.split_axis_deg) /
                                       i.quadrature_full_scale_hz)};
}

/// What averages over an interval fold down of pickoff noise that reaches up to `bandwidth_hz`: the factor on
/// its density.
double folding(double bandwidth_hz, double interval_s) {
  return std::sqrt(std::max(1.0, 2.0 * bandwidth_hz * interval_s));
}

/// Noise bandwidth of K (s + z) / (s^2 + K s + K z): (K + z) / 4.
double noise_bandwidth_hz(double closed_loop_3db_hz) {
  const auto gains = physics::LoopGains::of_bandwidth(closed_loop_3db_hz);
  return 0.25 * (gains.k_per_s + gains.z_per_s);
}

/// Densities of docs/scenarios.md.
std::map<std::string, recording::NoiseModel> noise_model(const Instrument& i, double setpoint,
                                                         const TelemetryMaking& making) {
  const physics::Parameters p = i.at(kReferenceDegc);
  const double dph = physics::kRadPerSecondPerDph;
  const double force_per_s = i.kappa * i.force_noise_dph_rthz * dph;
  // one of the two demodulated components, in nominal amplitudes
  const double rounding_lsb = 1.0 / std::sqrt(12.0);
  const double pickoff = std::hypot(i.pickoff_noise_lsb, rounding_lsb) *
                         std::sqrt(2.0 * 2.0 / physics::AdcConfiguration::reference().rate_hz) /
                         (kAdcFullScaleLsb * i.pickoff_full_scale_per_amplitude);
  const double phase_rad = pickoff / setpoint;
  const double dt_s = making.interval_s;
  const double drive_v_s = i.drive_full_scale_v / p.drive_per_s;
  const double quadrature_v_s = 2.0 * i.quadrature_full_scale_v / p.quadrature_span_rad_s / setpoint;
  const double frequency_hz = p.omega_rad_s / kTwoPi;
  return {
      {"frequency_hz_rthz",
       {.white = std::hypot(force_per_s / setpoint / kTwoPi, frequency_hz * i.oscillator_noise_rthz),
        .differenced = phase_rad * folding(0.5 * config::output_rate_hz, dt_s)}},
      {"rate_dph_rthz",
       {.white = i.force_noise_dph_rthz / setpoint,
        .flicker = std::sqrt(physics::FlickerNoise::h_of_floor(i.rate_flicker_dph)),
        .differenced = kTwoPi * phase_rad / i.kappa / dph *
                       folding(noise_bandwidth_hz(making.loops.rebalance_hz), dt_s)}},
      {"drive_v_rthz",
       {.white = force_per_s * drive_v_s,
        .differenced =
            kTwoPi * pickoff * drive_v_s * folding(noise_bandwidth_hz(making.loops.amplitude_hz), dt_s)}},
      {"quadrature_v_rthz",
       {.white = force_per_s * quadrature_v_s,
        .differenced = kTwoPi * pickoff * quadrature_v_s *
                       folding(noise_bandwidth_hz(making.loops.quadrature_hz), dt_s)}},
      {"amplitude_rthz", {.white = pickoff}},
      {"case_temp_degc",
       {.white = std::hypot(i.case_thermometer_noise_degc, i.case_thermometer_step_degc / std::sqrt(12.0))}}};
}

[[noreturn]] void refuse(const recording::InstrumentModel& model, const char* key, const char* problem) {
  throw recording::InputError({.path = model.path, .channel = key}, problem, "correct the model");
}

void take_drive(const recording::InstrumentModel& model, Instrument& i) {
  const Coefficients c = shifted(model.drive->coefficients_v, kReferenceDegc - model.drive->reference_degc);
  if (!(c[0] > 0.0)) refuse(model, "drive.coefficients_v", "the drive at 20 degC is not above zero");
  i.drive_full_scale_v = c[0] * i.drive_full_scale_over_steady / mode_damping(i);
  i.relative_damping = scaled(c, 1.0 / c[0]);
}

void take_quadrature(const recording::InstrumentModel& model, Instrument& i) {
  const Coefficients c =
      shifted(model.quadrature->coefficients_v, kReferenceDegc - model.quadrature->reference_degc);
  if (c[0] == 0.0) refuse(model, "quadrature.coefficients_v", "the quadrature at 20 degC is zero");
  const double sine = axis_sin(i.split_axis_deg);
  if (i.split_hz * std::abs(sine) < 1e-9 * i.quadrature_full_scale_hz) {
    refuse(model, "quadrature", "the instrument has no split that would need a quadrature voltage");
  }
  // Turned to the other side where the sign asks for it; the cosine stays.
  if (c[0] * sine < 0.0) i.split_axis_deg = -i.split_axis_deg;
  i.quadrature_full_scale_v = std::abs(c[0] * i.quadrature_full_scale_hz / (i.split_hz * sine));
  i.relative_split = scaled(c, 1.0 / c[0]);
}

void take_noise(const recording::InstrumentModel& model, Instrument& i) {
  if (const auto rate = model.noise.find("rate_dph_rthz"); rate != model.noise.end()) {
    i.force_noise_dph_rthz = rate->second.white;
    i.rate_flicker_dph = rate->second.flicker / std::sqrt(physics::FlickerNoise::h_of_floor(1.0));
  }
  if (const auto temperature = model.noise.find("case_temp_degc"); temperature != model.noise.end()) {
    const double step = i.case_thermometer_step_degc / std::sqrt(12.0);
    const double all = temperature->second.white;
    i.case_thermometer_noise_degc = all > step ? std::sqrt(all * all - step * step) : 0.0;
  }
}

}  // namespace

recording::InstrumentModel nominal_model(const Instrument& instrument, double setpoint, double scale_factor,
                                         const TemperatureRange& range, const TelemetryMaking& making) {
  recording::InstrumentModel model;
  Coefficients frequency = instrument.frequency_hz;
  add(frequency, half_split_hz(instrument), -1.0);
  model.frequency = recording::FrequencyModel{instrument.frequency_reference_degc, std::move(frequency)};
  model.thermal_time_constant_s = instrument.shell_time_constant_s;
  model.bias = recording::BiasModel{instrument.bias_reference_hz, instrument.bias_terms_dph};
  const auto mismatch = mismatch_bias_dph(instrument, range);
  for (std::size_t k = 0; k < mismatch.size(); ++k) model.bias->terms_dph[k] += mismatch[k];
  model.scale_factor = scale_factor;
  model.amplitude_setpoint = setpoint;
  model.drive = drive_model(instrument);
  model.quadrature = quadrature_model(instrument);
  model.noise = noise_model(instrument, setpoint, making);
  return model;
}

Instrument instrument_of(const recording::InstrumentModel& model, const Instrument& base,
                         const TemperatureRange& range) {
  if (model.bench) refuse(model, "bench", "is a driven resonator, no gyro");
  Instrument i = base;
  if (model.drive) take_drive(model, i);
  if (model.quadrature) take_quadrature(model, i);
  if (model.frequency) {
    i.frequency_reference_degc = model.frequency->reference_degc;
    i.frequency_hz = model.frequency->coefficients_hz;
    add(i.frequency_hz, half_split_hz(i), 1.0);
  }
  if (model.thermal_time_constant_s) i.shell_time_constant_s = *model.thermal_time_constant_s;
  if (model.bias) {
    i.bias_reference_hz = model.bias->reference_hz;
    i.bias_terms_dph = model.bias->terms_dph;
    try {
      const auto mismatch = mismatch_bias_dph(i, range);
      for (std::size_t k = 0; k < mismatch.size(); ++k) i.bias_terms_dph[k] -= mismatch[k];
    } catch (const std::invalid_argument&) {
      refuse(model, "frequency.coefficients_hz", "f(T) is not monotonic over the temperatures of the run");
    }
  }
  take_noise(model, i);
  return i;
}

std::vector<physics::ActiveEffect> effects_of(const recording::InstrumentModel& model) {
  std::vector<physics::ActiveEffect> effects;
  if (!model.effects.is_array()) return effects;
  for (const recording::Json& item : model.effects) {
    if (!item.is_object() || !item.contains("id") || !item["id"].is_string())
      refuse(model, "effects", "an entry without an id");
    physics::ActiveEffect effect{item["id"].get<std::string>(), {}};
    const recording::Json parameters = item.value("parameters", recording::Json::object());
    for (const auto& [name, entry] : parameters.items()) {
      const recording::Json& value = entry.is_object() && entry.contains("value") ? entry["value"] : entry;
      if (!value.is_number()) refuse(model, "effects", "a parameter that is no number");
      effect.values[name] = value.get<double>();
    }
    effects.push_back(std::move(effect));
  }
  return effects;
}

}  // namespace hemi::scenario
