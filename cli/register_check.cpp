// SPDX-License-Identifier: Apache-2.0
#include "cli/register_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/recording/error.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

using recording::InputError;

bool fits(double value, config::Format format) {
  try {
    tb::to_raw(value, format, "");
    return true;
  } catch (const tb::FormatError&) {
    return false;
  }
}

double limit(const config::Register& r) {
  return std::ldexp(1.0, r.format.width - 1 - r.format.fraction);
}

[[noreturn]] void refuse_bias(int index, double value, const recording::InstrumentModel& model) {
  const auto& r = config::registers[index];
  const auto term = static_cast<std::size_t>(index - config::reg_bias_0);
  const std::string name(recording::kBiasTerms[term]);
  const double coefficient = model.bias->terms_dph[term];
  throw InputError({model.path, 0, 0, "bias.terms_dph." + name},
                   fmt::format("{:g} makes {:.4g} deg/h at the full scales of f and df (register {}, +-{:g})",
                               coefficient, value, r.name, limit(r)),
                   fmt::format("keep it below {:.4g} in size", std::abs(coefficient / value) * limit(r)));
}

[[noreturn]] void refuse_thermometer(int index, double value, const recording::InstrumentModel& model) {
  const auto& r = config::registers[index];
  throw InputError({model.path, 0, 0, "frequency.coefficients_hz"},
                   fmt::format("f(T) is so flat that its inverse asks for {:.4g} degC (register {}, +-{:g})",
                               value, r.name, limit(r)),
                   "check the coefficients: Hz per degC, ascending, about reference_degc");
}

[[noreturn]] void refuse_scale(double value, const recording::InstrumentModel& model) {
  const auto& r = config::registers[config::reg_scale_correction];
  throw InputError({model.path, 0, 0, "scale_factor"},
                   fmt::format("{:g} asks for a correction of {:+.4g} (register {}, +-{:g})",
                               model.scale_factor, value, r.name, limit(r)),
                   fmt::format("give {:.4f} to {:.4f}, and put the rest into \"columns\" of the sidecar: "
                               "\"scale\" of rate_dph",
                               1.0 / (1.0 + limit(r)), 1.0 / (1.0 - limit(r))));
}

}  // namespace

void check_registers(const Setup& setup, const recording::InstrumentModel* model) {
  for (int i = 0; i < config::register_count; ++i) {
    const auto& r = config::registers[i];
    if (i == config::reg_parity || fits(setup.values[i], r.format)) continue;
    if (model != nullptr) {
      if (i >= config::reg_bias_0 && i <= config::reg_bias_f_df2) refuse_bias(i, setup.values[i], *model);
      if (i >= config::reg_thermometer_0 && i <= config::reg_thermometer_5)
        refuse_thermometer(i, setup.values[i], *model);
      if (i == config::reg_scale_correction) refuse_scale(setup.values[i], *model);
    }
    throw InputError({model != nullptr ? model->path : std::string()},
                     fmt::format("{:.6g} {} is more than register {} holds, +-{:g}: {}", setup.values[i],
                                 r.unit, r.name, limit(r), r.meaning),
                     "check the sample rate and the frequencies of the model");
  }
}

}  // namespace hemi::cli
