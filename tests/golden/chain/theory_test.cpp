// SPDX-License-Identifier: Apache-2.0
// The ideal chain against closed forms: tone, amplitude, linear loop, long runs.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "tests/golden/chain/support.hpp"

namespace hemi::golden::testing {
namespace {

using namespace config;
constexpr double kPi = std::numbers::pi;
constexpr double kHzPerTurn = 8.0;  // 200 Hz over 25 ticks
// Words of the tracker are below 2^5 turns, so that a step of it is known to 2^-48 turns; 625 of them times 8
// Hz.
constexpr double kDoubleHz = 625.0 * 8.0 * 0x1p-48;

// Line that the image at twice the carrier leaves in the frequency [Hz]: the image is as large as the signal
// itself in the products, so its phase amplitude is its filters' gain in rad.
double image_line_hz(const InstrumentParameters& instrument, double frequency_hz) {
  const Eigen::VectorXd response = baseband_response(instrument.decimation);
  const Eigen::VectorXd weights = spread(response, frequency_tick_weights(), instrument.decimation);
  std::complex<double> sum = 0.0;
  for (Eigen::Index n = 0; n < weights.size(); ++n) {
    sum += weights[n] *
           std::polar(1.0, -4.0 * kPi * frequency_hz / instrument.adc_rate_hz * static_cast<double>(n));
  }
  return std::abs(sum) / response.sum() / (2.0 * kPi) * kHzPerTurn;
}

// What the nco's phase does to an error of the detector at angle w a sample, the loop taken as open.
std::complex<double> nco_response(const InstrumentParameters& instrument, double w) {
  const RegisterValues values = reference_values(instrument, 4425.0);
  const int r = instrument.decimation;
  const auto delay = [w](double samples) { return std::polar(1.0, -w * samples); };
  const std::complex<double> controller =
      values[reg_loop_proportional] + values[reg_loop_integral] / (1.0 - delay(r));
  // The command of a tick becomes the increment a tick later and holds for R samples; an increment is in the
  // phase of the next sample.
  std::complex<double> hold = 0.0;
  for (int i = 1; i <= r; ++i) hold += delay(r + i) / static_cast<double>(r);
  return controller * hold * delay(1) / (1.0 - delay(1));
}

// Closed-loop transfer from the tone's phase to the nco's.
std::complex<double> closed_loop(const InstrumentParameters& instrument, double w) {
  const Eigen::VectorXd response = baseband_response(instrument.decimation);
  std::complex<double> detector = 0.0;
  for (Eigen::Index n = 0; n < response.size(); ++n) {
    detector += response[n] / response.sum() * std::polar(1.0, -w * static_cast<double>(n));
  }
  const std::complex<double> open = detector * nco_response(instrument, w);
  return open / (1.0 + open);
}

std::vector<ChainRecord> run_tone(const InstrumentParameters& instrument, double frequency_hz,
                                  double amplitude, double seconds, bool rounded) {
  Chain chain(Precision::ideal, instrument, reference_values(instrument, frequency_hz - 0.2));
  Tone tone(frequency_hz, instrument.adc_rate_hz, amplitude, 0.1);
  std::vector<ChainRecord> records;
  const Eigen::VectorXd x = tone.next(static_cast<Eigen::Index>(seconds * instrument.adc_rate_hz));
  const Eigen::VectorXd words =
      rounded ? digitise(x, instrument.adc_bits) : Eigen::VectorXd(x * power_of_two(instrument.adc_bits - 1));
  chain.samples(words, Eigen::VectorXd::Zero(words.size()), nullptr, records);
  return records;
}

constexpr std::size_t kSettled = 400;  // outputs; exp(-2 s * 25 rad/s) is below 1e-21

TEST(Theory, CleanToneShowsItsFrequencyButForTheImage) {
  for (const auto& instrument : {InstrumentParameters::reference(), InstrumentParameters::wide()}) {
    for (const double frequency : {4365.0, 4425.1234, 4485.0}) {
      const Eigen::VectorXd f =
          column(run_tone(instrument, frequency, 0.8, 3.0, false), word_frequency, kSettled);
      const double line = image_line_hz(instrument, frequency);
      const double measured = (f.array() - frequency).abs().maxCoeff();
      fmt::print("{} bit, {:.4f} Hz: image line {:.3e} Hz, largest error {:.3e} Hz\n", instrument.adc_bits,
                 frequency, line, measured);
      // The loop lets the nco follow the image a little; the detector's filters hide that from it but not
      // from the tracker.
      const double alias = modulo(2.0 * frequency / instrument.adc_rate_hz * instrument.decimation, 1.0);
      const double followed = std::abs(nco_response(instrument, 2.0 * kPi * alias / instrument.decimation));
      EXPECT_LE(measured, line * (1.0 + followed) + kDoubleHz);
      EXPECT_LE(line, 10e-6);
    }
  }
}

TEST(Theory, AdcRoundingStaysWithinItsClosedForm) {
  for (const auto& instrument : {InstrumentParameters::reference(), InstrumentParameters::wide()}) {
    const double frequency = 4425.1234567;
    const double amplitude = 0.8;
    const Eigen::VectorXd f =
        column(run_tone(instrument, frequency, amplitude, 12.0, true), word_frequency, kSettled);
    const Eigen::VectorXd response = baseband_response(instrument.decimation);
    const Eigen::VectorXd weights = spread(response, frequency_tick_weights(), instrument.decimation);
    const double half_lsb = power_of_two(-instrument.adc_bits);
    const double radians = 2.0 * kPi * amplitude / 2.0 * response.sum();
    const double worst =
        kHzPerTurn * half_lsb * weights.lpNorm<1>() / radians + image_line_hz(instrument, frequency);
    const double rms = kHzPerTurn * half_lsb / std::sqrt(3.0) * weights.norm() / std::sqrt(2.0) / radians;
    // All outputs together are the difference of two interval means of the phase, each within half an LSB's
    // angle (times sum |c| / sum c of the response), plus the image's.
    const double seconds = static_cast<double>(f.size()) / output_rate_hz;
    const double phase_turns = half_lsb * response.lpNorm<1>() / radians;
    const double mean_limit =
        (2.0 * phase_turns + image_line_hz(instrument, frequency) / output_rate_hz) / seconds;
    const Eigen::ArrayXd error = f.array() - frequency;
    fmt::print(
        "{} bit: error max {:.2e} (bound {:.2e}), rms {:.2e} (white {:.2e}), mean {:.2e} (bound {:.2e}) Hz\n",
        instrument.adc_bits, error.abs().maxCoeff(), worst, std::sqrt(error.square().mean()), rms,
        error.mean(), mean_limit);
    EXPECT_LE(error.abs().maxCoeff(), worst);
    EXPECT_LE(std::abs(error.mean()), mean_limit);
    EXPECT_GT(error.abs().maxCoeff(), 0.1 * rms);
  }
}

TEST(Theory, AmplitudeHasTheStatedScale) {
  for (const auto& instrument : {InstrumentParameters::reference(), InstrumentParameters::wide()}) {
    const double a = 0.37;
    const Eigen::VectorXd word =
        column(run_tone(instrument, 4425.1, a, 3.0, false), word_amplitude, kSettled);
    const double growth = growth_bits(instrument.decimation, cic_order);
    const double expected = 50.0 * a / 2.0 * cordic_gain() * std::pow(instrument.decimation, 5) /
                            std::exp2(growth) * 49.0 / 64.0 * (std::exp2(20) - 2.0) / std::exp2(20);
    // The image moves the length by its share of the vector; 2 pi / 8 takes its line in Hz back to rad over
    // 50 ticks, and sums over 50 equal ticks are at most as tan(w 25 / 2)'s denominator allows: bounded by
    // the single tick.
    const Eigen::VectorXd response = baseband_response(instrument.decimation);
    std::complex<double> image = 0.0;
    for (Eigen::Index n = 0; n < response.size(); ++n) {
      image += response[n] *
               std::polar(1.0, -4.0 * kPi * 4425.1 / instrument.adc_rate_hz * static_cast<double>(n));
    }
    const double limit = expected * (std::abs(image) / response.sum() + 1e-12);
    EXPECT_LE((word.array() - expected).abs().maxCoeff(), limit);
    EXPECT_LT(limit, 1e-5 * expected);
  }
}

// ---- The loop
// -----------------------------------------------------------------------------------------------------

class PhaseRecorder : public TapListener {
 public:
  void tap(TapIndex index, double value) override {
    if (index == tap_phase) phase_.push_back(value);
  }
  std::vector<double> phase_;
};

// Phase of the nco over the run, for a tone at the start frequency with a small phase of its own [turns].
template <class Deviation>
std::vector<double> nco_phase(const InstrumentParameters& instrument, double seconds,
                              const Deviation& deviation) {
  constexpr double kFrequency = 4425.0;
  Chain chain(Precision::ideal, instrument, reference_values(instrument, kFrequency));
  PhaseRecorder recorder;
  chain.set_taps(&recorder);
  const auto count = static_cast<Eigen::Index>(seconds * instrument.adc_rate_hz);
  Eigen::VectorXd x(count);
  for (Eigen::Index n = 0; n < count; ++n) {
    const double turns =
        modulo(round_to(kFrequency / instrument.adc_rate_hz, 48) * static_cast<double>(n), 1.0);
    x[n] = 0.8 * power_of_two(instrument.adc_bits - 1) * std::cos(2.0 * kPi * (turns + deviation(n)));
  }
  std::vector<ChainRecord> records;
  chain.samples(x, Eigen::VectorXd::Zero(count), nullptr, records);
  return recorder.phase_;
}

// What a deviation of the tone does to the nco, as the difference of two runs: the image drops out.
template <class Deviation>
Eigen::VectorXd nco_deviation(const InstrumentParameters& instrument, double seconds,
                              const Deviation& deviation) {
  const std::vector<double> with = nco_phase(instrument, seconds, deviation);
  const std::vector<double> without = nco_phase(instrument, seconds, [](Eigen::Index) { return 0.0; });
  Eigen::VectorXd difference(static_cast<Eigen::Index>(with.size()));
  for (std::size_t n = 0; n < with.size(); ++n) {
    difference[static_cast<Eigen::Index>(n)] = modulo(with[n] - without[n], 1.0);
  }
  return difference;
}

// Relative to a deviation d: atan2 is exact but for the spread of phases in a window, at most (2 pi d)^2; the
// image (a few 1e-6 of the vector) turns with the deviation. Deviations are 1e-4 turns: 4e-7 + 4e-6.
constexpr double kDeviation = 1e-4;
constexpr double kNonlinear = 5e-6;

TEST(Theory, LoopHasTheFrequencyResponseOfItsLinearModel) {
  for (const auto& instrument : {InstrumentParameters::reference(), InstrumentParameters::wide()}) {
    for (const double hz : {1.0, 3.0, 10.0, 30.0, 100.0}) {
      const double w = 2.0 * kPi * hz / instrument.adc_rate_hz;
      const Eigen::VectorXd d = nco_deviation(
          instrument, 3.0, [w](Eigen::Index n) { return kDeviation * std::sin(w * static_cast<double>(n)); });
      const auto one_second = static_cast<Eigen::Index>(instrument.adc_rate_hz);
      std::complex<double> sum = 0.0;
      for (Eigen::Index n = 2 * one_second; n < 3 * one_second; ++n) {
        sum += d[n] * std::polar(1.0, -w * static_cast<double>(n));
      }
      const std::complex<double> measured =
          sum * std::complex<double>(0.0, 2.0) / instrument.adc_rate_hz / kDeviation;
      const std::complex<double> theory = closed_loop(instrument, w);
      fmt::print(
          "{} bit, {:5.1f} Hz: measured {:.6f} at {:.4f} deg, theory {:.6f} at {:.4f} deg, apart {:.1e}\n",
          instrument.adc_bits, hz, std::abs(measured), std::arg(measured) * 180.0 / kPi, std::abs(theory),
          std::arg(theory) * 180.0 / kPi, std::abs(measured - theory));
      EXPECT_LE(std::abs(measured - theory), kNonlinear);
    }
  }
}

TEST(Theory, LoopStepsLikeItsLinearModel) {
  const auto instrument = InstrumentParameters::reference();
  const RegisterValues values = reference_values(instrument, 4425.0);
  constexpr Eigen::Index kStep = 100000;
  constexpr double kSeconds = 1.5;
  const Eigen::VectorXd measured =
      nco_deviation(instrument, kSeconds, [](Eigen::Index n) { return n >= kStep ? kDeviation : 0.0; });
  // The difference equations of the linear model, sample by sample.
  const Eigen::VectorXd response = baseband_response(instrument.decimation);
  Eigen::VectorXd error = Eigen::VectorXd::Zero(measured.size());
  double phase = 0.0;
  double increment = 0.0;
  double pending = 0.0;
  double integral = 0.0;
  double worst = 0.0;
  double overshoot = 0.0;
  for (Eigen::Index n = 0; n < measured.size(); ++n) {
    worst = std::max(worst, std::abs(measured[n] - phase));
    overshoot = std::max(overshoot, measured[n] / kDeviation - 1.0);
    // -2 cos(theta + s) sin(theta + p) = sin(s - p) - sin(2 theta + s + p): what the step switches on of the
    // image is linear in it, too.
    const double tone = n >= kStep ? kDeviation : 0.0;
    const double twice = 4.0 * kPi * modulo(values[reg_nco_start] * static_cast<double>(n), 1.0);
    error[n] = tone - phase - (tone + phase) * std::cos(twice);
    phase += increment;
    if ((n + 1) % instrument.decimation != 0 || n < kStep) continue;
    increment = pending;
    const double detected =
        error.segment(n + 1 - response.size(), response.size()).reverse().dot(response) / response.sum();
    integral += values[reg_loop_integral] * detected;
    pending = integral + values[reg_loop_proportional] * detected;
  }
  fmt::print(
      "step of {:.0e} turns: largest distance from the linear model {:.1e}, overshoot {:.2f} % (without "
      "delays {:.2f} %)\n",
      kDeviation, worst, overshoot * 100.0, std::exp(-2.0) * 100.0);
  EXPECT_LE(worst, kNonlinear * kDeviation);
}

// ---- Precision over hours
// -------------------------------------------------------------------------------------------

TEST(Theory, TrackerLosesNothingOverHours) {
  // Three hours of ticks. The phase is a whole number of 2^-48 turns and so exact: the frequency must not
  // move at all.
  const double increment = round_to(4425.1234567 / 1e5, 48);
  const double step = 20.0 * increment;
  FrequencyTracker tracker(Precision::ideal);
  double phase = 0.0;
  double worst = 0.0;
  for (int output = 0; output < 3 * 3600 * output_rate_hz; ++output) {
    for (int tick = 0; tick < ticks_per_output; ++tick) {
      phase = modulo(phase + step, 32.0);
      tracker.tick(phase, 0.0);
    }
    const double frequency = tracker.output();
    if (output >= 2) worst = std::max(worst, std::abs(frequency - step * 5000.0));
  }
  fmt::print("three hours: frequency within {:.1e} Hz, {:.1e} turns an interval\n", worst,
             worst / output_rate_hz);
  EXPECT_LE(worst / output_rate_hz, 1e-12);
}

}  // namespace
}  // namespace hemi::golden::testing
