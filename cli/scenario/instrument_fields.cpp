// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/instrument_fields.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "cli/recording/model.hpp"

namespace hemi::scenario {
namespace {

using physics::Instrument;

constexpr double kTiny = 1e-12;  // of what must not be zero
constexpr Quantity kTimeConstant = {"s", 0.0, 1e7};
constexpr Quantity kAngle = {"deg", -360.0, 360.0};
constexpr Quantity kDensity = {"1", 0.0, 1e6};

constexpr std::array kNumbers = {
    NumberField{"frequency_reference_degc", {"degC", -273.15, 1000.0}, &Instrument::frequency_reference_degc},
    NumberField{"quality_factor", {"1", 10.0, 1e10}, &Instrument::quality_factor},
    NumberField{"kappa", {"1", kTiny, 2.0}, &Instrument::kappa},
    NumberField{"centrifugal", {"1", -2.0, 2.0}, &Instrument::centrifugal},
    NumberField{"damping_mismatch", {"1", 0.0, 1.0}, &Instrument::damping_mismatch},
    NumberField{"damping_axis_deg", kAngle, &Instrument::damping_axis_deg},
    NumberField{"split_hz", {"Hz", 0.0, 1.0}, &Instrument::split_hz},
    NumberField{"split_axis_deg", kAngle, &Instrument::split_axis_deg},
    NumberField{"rebalance_full_scale_dps", {"1", kTiny, 1e5}, &Instrument::rebalance_full_scale_dps},
    NumberField{"drive_full_scale_over_steady", {"1", kTiny, 1e6}, &Instrument::drive_full_scale_over_steady},
    NumberField{"quadrature_full_scale_hz", {"Hz", kTiny, 100.0}, &Instrument::quadrature_full_scale_hz},
    NumberField{"drive_full_scale_v", {"V", kTiny, 1e6}, &Instrument::drive_full_scale_v},
    NumberField{"quadrature_full_scale_v", {"V", kTiny, 1e6}, &Instrument::quadrature_full_scale_v},
    NumberField{"pickoff_full_scale_per_amplitude",
                {"1", kTiny, 10.0},
                &Instrument::pickoff_full_scale_per_amplitude},
    NumberField{"pickoff_noise_lsb", {"LSB", 0.0, 1e4}, &Instrument::pickoff_noise_lsb},
    NumberField{"force_noise_dph_rthz", kDensity, &Instrument::force_noise_dph_rthz},
    NumberField{"rate_flicker_dph", {"deg/h", 0.0, 1e6}, &Instrument::rate_flicker_dph},
    NumberField{"oscillator_noise_rthz", {"1", 0.0, 1e-3}, &Instrument::oscillator_noise_rthz},
    NumberField{"case_thermometer_noise_degc", {"1", 0.0, 100.0}, &Instrument::case_thermometer_noise_degc},
    NumberField{"case_thermometer_step_degc", {"1", 0.0, 100.0}, &Instrument::case_thermometer_step_degc},
    NumberField{"case_time_constant_s", kTimeConstant, &Instrument::case_time_constant_s},
    NumberField{"stem_time_constant_s", kTimeConstant, &Instrument::stem_time_constant_s},
    NumberField{"shell_time_constant_s", kTimeConstant, &Instrument::shell_time_constant_s},
    NumberField{"board_rise_degc", {"1", -100.0, 200.0}, &Instrument::board_rise_degc},
    NumberField{"board_time_constant_s", kTimeConstant, &Instrument::board_time_constant_s}};

const std::array kPolynomials = {PolynomialField{"frequency_hz", "Hz", &Instrument::frequency_hz},
                                 PolynomialField{"relative_damping", "1", &Instrument::relative_damping},
                                 PolynomialField{"relative_split", "1", &Instrument::relative_split}};

// Coefficients of all powers share one unit-less range: what is possible depends on the temperatures.
constexpr double kLargestCoefficient = 1e9;

void read_bias(const Section& section, Instrument& instrument) {
  std::vector<std::string_view> known = {"reference_hz"};
  known.insert(known.end(), recording::kBiasTerms.begin(), recording::kBiasTerms.end());
  section.allow(known);
  instrument.bias_reference_hz =
      section.quantity("reference_hz", {"Hz", 0.0, 1e7}, instrument.bias_reference_hz);
  for (std::size_t i = 0; i < recording::kBiasTerms.size(); ++i) {
    double& term = instrument.bias_terms_dph[i];
    term = section.quantity(recording::kBiasTerms[i],
                            {i == 0 ? "deg/h" : "1", -kLargestCoefficient, kLargestCoefficient}, term);
  }
}

}  // namespace

std::span<const NumberField> number_fields() {
  return kNumbers;
}

std::span<const PolynomialField> polynomial_fields() {
  return kPolynomials;
}

Instrument read_instrument(const Section& section, const Instrument& base) {
  std::vector<std::string_view> known = {"model", "bias"};
  for (const PolynomialField& field : kPolynomials) known.push_back(field.name);
  for (const NumberField& field : kNumbers) known.push_back(field.name);
  section.allow(known);
  Instrument instrument = base;
  for (const PolynomialField& field : kPolynomials) {
    if (!section.has(field.name)) continue;
    instrument.*field.member =
        section.quantities(field.name, {field.unit, -kLargestCoefficient, kLargestCoefficient});
  }
  for (const NumberField& field : kNumbers)
    instrument.*field.member = section.quantity(field.name, field.quantity, instrument.*field.member);
  read_bias(section.section("bias"), instrument);
  return instrument;
}

Instrument without_noise(Instrument instrument) {
  instrument.pickoff_noise_lsb = 0.0;
  instrument.force_noise_dph_rthz = 0.0;
  instrument.rate_flicker_dph = 0.0;
  instrument.oscillator_noise_rthz = 0.0;
  instrument.case_thermometer_noise_degc = 0.0;
  instrument.case_thermometer_step_degc = 0.0;
  return instrument;
}

}  // namespace hemi::scenario
