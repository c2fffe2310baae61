// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/stage/concealed.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

#include "cli/capture_replay.hpp"
#include "golden/loops/control.hpp"
#include "golden/physics/plant.hpp"
#include "tb/hls_engine.hpp"
#include "tb/registers.hpp"
#include "tests/cli/stage/core_faults.hpp"
#include "tests/tb/signals.hpp"

namespace hemi::tests {
namespace {

constexpr double kFullScale = 32768.0;
constexpr double kTurn = 2.0 * std::numbers::pi;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed * 0x9e3779b97f4a7c15ULL + 12345) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits_); }
  double sign() { return uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0; }
  int integer(int count) { return std::uniform_int_distribution<int>(0, count - 1)(bits_); }
  double normal() { return normal_(bits_); }

 private:
  std::mt19937_64 bits_;
  std::normal_distribution<double> normal_;
};

double between(double low, double high, double strength) {
  return low * std::pow(high / low, strength);
}

/// Pickoffs and converters of the writer.
struct FrontEnd {
  // pickoff: current of a capacitor whose gap the motion changes, or a bridge that saturates; slope 1 at 0
  enum class Form { straight, gap, bridge } form = Form::straight;
  double ratio = 0.0, bias = 0.0;
  double leak = 0.0;
  double level_up = 2.0, level_down = 2.0, give = 0.0;  // above the level a share `give` still passes
  std::vector<double> inl_lsb;                          // between equally spaced codes
  double offset_x_lsb = 0.0, offset_y_lsb = 0.0;
  double lead_rad = 0.0;
  double noise_lsb = 0.5;

  double pickoff(double x) const {
    const double u = ratio * x;
    if (form == Form::gap) return ((1.0 / (1.0 - u - bias * u * u) - 1.0)) / ratio;
    if (form == Form::bridge) {
      const double slope = 1.0 / (1.0 + bias * bias);
      return (std::atan(u + bias) - std::atan(bias)) / (ratio * slope);
    }
    return x;
  }
  double clip(double v) const {
    if (v > level_up) return level_up + give * (v - level_up);
    if (v < -level_down) return -level_down + give * (v + level_down);
    return v;
  }
  double inl(double code) const {
    if (inl_lsb.empty()) return 0.0;
    const double position =
        std::clamp((code / kFullScale + 1.0) / 2.0, 0.0, 1.0) * static_cast<double>(inl_lsb.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(position), inl_lsb.size() - 2);
    const double part = position - static_cast<double>(i);
    return (1.0 - part) * inl_lsb[i] + part * inl_lsb[i + 1];
  }
  std::int32_t convert(double fraction, double offset_lsb, double noise) const {
    const double code = clip(fraction) * kFullScale + offset_lsb + noise;
    return static_cast<std::int32_t>(
        std::clamp(std::floor(code + inl(code) + 0.5), -kFullScale, kFullScale - 1.0));
  }
};

/// A random walk over the codes, tied to zero at both ends, its peak scaled.
std::vector<double> random_curve(double peak_lsb, int segments, Draw& draw) {
  std::vector<double> curve(static_cast<std::size_t>(segments + 1), 0.0);
  for (std::size_t i = 1; i < curve.size(); ++i) curve[i] = curve[i - 1] + draw.normal();
  const double end = curve.back();
  double peak = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    curve[i] -= end * static_cast<double>(i) / segments;
    peak = std::max(peak, std::abs(curve[i]));
  }
  for (double& value : curve) value *= peak_lsb / peak;
  return curve;
}

physics::Instrument random_instrument(Draw& draw) {
  physics::Instrument instrument;
  instrument.frequency_hz[0] += draw.uniform(-40.0, 40.0);
  instrument.quality_factor = std::exp(draw.uniform(std::log(3e6), std::log(3e7)));
  instrument.split_hz = draw.uniform(2e-4, 3e-3) * draw.sign();
  instrument.damping_mismatch = draw.uniform(0.002, 0.03);
  instrument.damping_axis_deg = draw.uniform(0.0, 90.0);
  instrument.split_axis_deg = draw.uniform(5.0, 40.0);
  return instrument;
}

/// Front end of a fault; the truth in words.
std::string spoil(FrontEnd& front, Fault fault, double strength, Draw& draw) {
  switch (fault) {
    case Fault::pickoff:
      front.form = draw.integer(2) == 0 ? FrontEnd::Form::gap : FrontEnd::Form::bridge;
      front.ratio = between(1e-4, 3e-2, strength);
      front.bias = draw.sign() * draw.uniform(0.2, 0.6);
      return fmt::format("{} pickoff, motion over gap {:.2g}, bias {:.2f}",
                         front.form == FrontEnd::Form::gap ? "gap" : "bridge", front.ratio, front.bias);
    case Fault::feedthrough:
      front.leak = draw.sign() * between(0.02, 0.5, strength);
      return fmt::format("feedthrough {:.3g}", front.leak);
    case Fault::saturation: {
      // share of the wave's height that is cut
      const double cut = between(2.5e-3, 0.08, strength) * 0.8;
      front.level_up = 0.8 - cut;
      front.level_down = draw.integer(3) == 0 ? 2.0 : 0.8 - cut * draw.uniform(0.5, 1.0);
      front.give = draw.integer(2) == 0 ? 0.0 : draw.uniform(0.02, 0.3);
      return fmt::format("clipped at {:.4f} and -{:.4f}, {:.2f} passes", front.level_up, front.level_down,
                         front.give);
    }
    case Fault::nonlinearity: {
      const int segments = 16 << draw.integer(6);
      const double peak_lsb = between(0.1, 8.0, strength);
      front.inl_lsb = random_curve(peak_lsb, segments, draw);
      return fmt::format("random walk of {} segments, peak {:.2f} LSB", segments, peak_lsb);
    }
    case Fault::offset: {
      const double lsb = between(0.05, 100.0, strength);
      front.offset_x_lsb = draw.sign() * lsb * draw.uniform(0.3, 1.0);
      front.offset_y_lsb = draw.integer(3) == 0 ? 0.0 : draw.sign() * lsb;
      return fmt::format("offsets {:.3f}, {:.3f} LSB", front.offset_x_lsb, front.offset_y_lsb);
    }
    case Fault::demodulation:
      front.lead_rad = draw.sign() * between(4e-3, 5e-2, strength);
      return fmt::format("secondary leads by {:.3g} mrad", 1e3 * front.lead_rad);
    default:
      return "";
  }
}

tb::RegisterValues design(const physics::Instrument& instrument, double start_degc) {
  tb::RegisterValues values = busy_registers(false, 4425.0);
  values[config::reg_calibrated_low] = -1.0;
  values[config::reg_calibrated_high] = 0.999;
  values[config::reg_scale_correction] = 0.0;
  loops::ControlWishes wishes;
  wishes.start_degc = start_degc;
  loops::set_control(values, instrument, loops::CoreSampling::reference(), wishes);
  return values;
}

}  // namespace

const char* name(Fault fault) {
  constexpr const char* names[] = {"none",
                                   "pickoff_nonlinearity",
                                   "drive_feedthrough",
                                   "adc_saturation",
                                   "adc_nonlinearity",
                                   "adc_offset",
                                   "demodulation_phase",
                                   "core"};
  return names[static_cast<int>(fault)];
}

diagnosis::Stage stage_of(Fault fault) {
  using diagnosis::Stage;
  constexpr Stage stages[] = {Stage::none, Stage::pickoff, Stage::actuator,     Stage::adc,
                              Stage::adc,  Stage::adc,     Stage::demodulation, Stage::core};
  return stages[static_cast<int>(fault)];
}

Concealed make_concealed(Fault fault, double strength, std::uint64_t seed, double seconds) {
  Draw draw(seed);
  Concealed result;
  result.fault = fault;
  Shown& shown = result.shown;
  shown.instrument = random_instrument(draw);
  const double degc = draw.uniform(-10.0, 50.0);
  shown.registers = design(shown.instrument, degc);
  FrontEnd front;
  front.noise_lsb = draw.uniform(0.4, 1.0);
  const double rate_rad_s =
      draw.sign() * std::exp(draw.uniform(std::log(10.0), std::log(100.0))) * std::numbers::pi / 180.0;
  result.truth = spoil(front, fault, strength, draw);

  physics::Parameters parameters = shown.instrument.at(degc);
  parameters.rate_rad_s = rate_rad_s;
  physics::PlantConfiguration configuration;
  configuration.start = {draw.uniform(0.92, 1.03), draw.uniform(0.0, kTurn), draw.uniform(0.0, 2e-3),
                         draw.uniform(0.0, kTurn)};
  configuration.seed = seed;
  physics::Plant plant(shown.instrument, parameters, configuration);

  std::unique_ptr<tb::Engine> engine = tb::make_hls_engine(false);
  tb::RegisterValues loaded = shown.registers;
  if (fault == Fault::demodulation && draw.integer(2) == 0) {
    // the register, not the electronics
    const double phase = front.lead_rad;
    front.lead_rad = 0.0;
    loaded[config::reg_demodulation_cos] = std::cos(phase);
    loaded[config::reg_demodulation_sin] = std::sin(phase);
    result.truth = fmt::format("demodulation registers turned by {:.3g} mrad", 1e3 * phase);
  }
  if (fault == Fault::core) result.truth = break_core(draw.uniform(0.0, 1.0), strength, loaded, engine);
  engine->reset(loaded);

  const double gain = shown.instrument.pickoff_full_scale_per_amplitude;
  const double omega = shown.instrument.at(20.0).omega_rad_s;
  std::array<double, 4> drive{};  // words of this sample and of those before
  const auto samples = static_cast<std::size_t>(seconds * 1e5);
  for (std::size_t n = 0; n < samples; ++n) {
    const physics::Motion m = plant.motion();
    const double y = m.y * std::cos(front.lead_rad) + m.y_rate_per_s / omega * std::sin(front.lead_rad);
    tb::SamplePair pair;
    pair.x = front.convert(gain * front.pickoff(m.x) + front.leak * drive[2], front.offset_x_lsb,
                           front.noise_lsb * draw.normal());
    pair.y = front.convert(gain * front.pickoff(y), front.offset_y_lsb, front.noise_lsb * draw.normal());
    const tb::DacWords words = engine->step(pair, shown.records);
    shown.pairs.push_back(pair);
    plant.act({static_cast<std::int16_t>(words.drive), static_cast<std::int16_t>(words.rebalance),
               static_cast<std::int16_t>(words.quadrature)});
    drive = {words.drive / kFullScale, drive[0], drive[1], drive[2]};
  }
  return result;
}

std::vector<tb::Record> make_words(const Shown& shown, const tb::RegisterValues& registers) {
  std::vector<tb::Record> records;
  const auto engine = tb::make_hls_engine(false);
  engine->reset(registers);
  engine->samples(shown.pairs, records);
  return records;
}

diagnosis::StageDiagnosis diagnose(const Shown& shown) {
  diagnosis::StageCapture capture;
  const auto count = static_cast<Eigen::Index>(shown.pairs.size());
  capture.x_lsb.resize(count);
  capture.y_lsb.resize(count);
  for (Eigen::Index n = 0; n < count; ++n) {
    capture.x_lsb[n] = shown.pairs[static_cast<std::size_t>(n)].x;
    capture.y_lsb[n] = shown.pairs[static_cast<std::size_t>(n)].y;
  }
  capture.sample_rate_hz = 1e5;
  capture.full_scale_lsb = kFullScale;
  capture.registers = shown.registers;
  capture.recorded.samples_a_record = 500;
  for (const auto& record : shown.records) capture.recorded.records.push_back(record.words);
  // a recording has neither the phase error nor the derivative
  for (auto& words : capture.recorded.records)
    words[config::word_phase_error] = words[config::word_derivative] = words[config::word_bias] =
        std::nan("");
  const physics::Parameters nominal = shown.instrument.at(20.0);
  return diagnosis::diagnose_stage(
      capture,
      {shown.instrument.pickoff_full_scale_per_amplitude, nominal.drive_per_s, nominal.rebalance_per_s},
      cli::make_replay(shown.pairs, false));
}

}  // namespace hemi::tests
