// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/stage/core_faults.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "tb/registers.hpp"
#include "tests/cli/stage/mutant_core.hpp"

namespace hemi::tests {
namespace {

// Registers whose value reaches a recorded word of a capture that starts up and settles.
constexpr std::array kBreakable = {config::reg_loop_proportional,
                                   config::reg_loop_integral,
                                   config::reg_demodulation_cos,
                                   config::reg_rate_gain,
                                   config::reg_frequency_reference,
                                   config::reg_slope_gain,
                                   config::reg_thermometer_0,
                                   config::reg_thermometer_1,
                                   config::reg_thermometer_2,
                                   config::reg_bias_0,
                                   config::reg_bias_f,
                                   config::reg_bias_df,
                                   config::reg_scale_correction,
                                   config::reg_amplitude_setpoint,
                                   config::reg_amplitude_proportional,
                                   config::reg_amplitude_integral,
                                   config::reg_drive_start,
                                   config::reg_quadrature_proportional,
                                   config::reg_quadrature_integral,
                                   config::reg_rebalance_proportional,
                                   config::reg_rebalance_integral};

class MutantEngine : public tb::Engine {
 public:
  explicit MutantEngine(const Mutant& mutant) : core_(mutant.make()) {}
  std::string name() const override { return "mutant"; }
  void reset(const tb::RegisterValues& values) override { core_->reset(tb::to_image(values).data()); }
  void samples(std::span<const tb::SamplePair> input, std::vector<tb::Record>& output) override {
    for (const auto& pair : input) step(pair, output);
  }
  tb::DacWords step(const tb::SamplePair& pair, std::vector<tb::Record>& output) override {
    std::array<std::int64_t, config::record_words> words{};
    std::array<std::int32_t, 3> dacs{};
    if (core_->step(pair.x, pair.y, words.data(), dacs.data())) output.push_back(tb::to_record(words));
    return {dacs[0], dacs[1], dacs[2]};
  }
  void telemetry(double, double, bool, std::vector<tb::Record>&) override {}
  void set_taps(tb::TapSink*) override {}

 private:
  std::unique_ptr<MutantCore> core_;
};

std::string break_register(double pick, double strength, tb::RegisterValues& values) {
  const double place = pick * kBreakable.size();
  const auto index = kBreakable[static_cast<std::size_t>(place)];
  const double rest = place - std::floor(place);
  const config::Register& about = config::registers[index];
  const double nominal = tb::to_value(tb::to_raw(values[index], about.format, about.name), about.format);
  if (rest < 1.0 / 3.0) {
    // a bit of the lower half of those in use
    const auto raw = tb::to_raw(nominal, about.format, about.name);
    int used = 0;
    while (used < about.format.width - 2 && (std::abs(raw) >> used) != 0) ++used;
    const int bit = std::max(0, used - 2 - static_cast<int>((1.0 - strength) * 8.0));
    values[index] = tb::to_value(raw ^ (std::int64_t{1} << bit), about.format);
  } else {
    const double change = 1e-3 * std::pow(300.0, strength) * (rest < 2.0 / 3.0 ? 1.0 : -1.0);
    values[index] = nominal == 0.0 ? change * 0.05 : nominal * (1.0 + change);
  }
  return fmt::format("register {}: {:.9g} instead of {:.9g}", about.name, values[index], nominal);
}

}  // namespace

std::string break_core(double which, double strength, tb::RegisterValues& registers,
                       std::unique_ptr<tb::Engine>& engine) {
  constexpr double in_register = 0.6;
  if (which < in_register || mutants().empty())
    return break_register(std::min(which / in_register, 0.999), strength, registers);
  const double part = (which - in_register) / (1.0 - in_register);
  const Mutant& mutant = mutants()[std::min(
      static_cast<std::size_t>(part * static_cast<double>(mutants().size())), mutants().size() - 1)];
  engine = std::make_unique<MutantEngine>(mutant);
  return fmt::format("{} ({})", mutant.change, mutant.block);
}

}  // namespace hemi::tests
