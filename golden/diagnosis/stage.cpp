// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "golden/diagnosis/stage_evidence.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::Index;

// waveform of the primary, mean of the secondary, leak of the drive, phase of the secondary, phase of the
// drive's force
constexpr double kTests = 5.0;
constexpr double kEach = kStageFalseAlarm / kTests;
// The phases' rest is not white (the resonator's own phase walks): they count from the detection limit on,
// five standard errors, where 3.1 would do for white noise.
constexpr double kSureOfPhase = 5.0;

double two_sided(double z) {
  return 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), std::abs(z)));
}

StageTest test_of(const char* name, const Estimate& estimate, const char* unit) {
  return {name, estimate.z(), estimate.sigma > 0.0 ? two_sided(estimate.z()) : 1.0, unit,
          5.0 * estimate.sigma};
}

StageFinding core_finding(const CoreComparison& core) {
  StageFinding f{
      .stage = Stage::core, .effect = "unknown", .channel = "all records", .p = 0.0, .weight = 1e300};
  f.equation = "words = core(samples)";
  if (core.demodulation_rad) {
    f.stage = Stage::demodulation;
    f.effect = "demodulation_phase";
    f.channel = "rate_dph, quadrature_v";
    f.explanation =
        "the registers of the demodulation phase hold another phase than they should: with it the replay "
        "gives every recorded word";
    f.parameters = {{"phase", *core.demodulation_rad, 0.0, "rad"}};
  } else if (core.explained()) {
    f.explanation =
        "the core does not compute what it should from these samples; one register with another value gives "
        "every recorded word:";
    for (const auto& r : core.registers) {
      f.explanation +=
          fmt::format(" {} ({:.9g} instead of {:.9g})", config::registers[r.index].name, r.found, r.nominal);
      f.parameters.push_back(
          {config::registers[r.index].name, r.found, 0.0, config::registers[r.index].unit});
    }
  } else {
    f.explanation = fmt::format(
        "the core does not compute what it should from these samples; the first difference, in record {}, "
        "comes from {}; no single register explains it",
        *core.first_record, core.block);
  }
  return f;
}

StageFinding offset_finding(double x_lsb, double x_sigma, double y_lsb, double y_sigma) {
  StageFinding f{.stage = Stage::adc, .effect = "adc_offset", .channel = "adc_x, adc_y"};
  f.equation = "v += offset";
  f.explanation = "a constant in the samples, and no harmonic that would go with it";
  f.parameters = {{"x", x_lsb, x_sigma, "LSB"}, {"y", y_lsb, y_sigma, "LSB"}};
  return f;
}

StageFinding curve_finding(const CurveChoice& choice, const Harmonics& h, double full_scale_lsb) {
  const CurveFit& fit = choice.chosen;
  StageFinding f{.channel = "adc_x", .p = choice.p, .weight = choice.chi2};
  switch (fit.curve) {
    case Curve::stiffness:
      f.stage = Stage::resonator;
      f.effect = "quadratic_stiffness";
      f.equation = "x'' + w^2 (x + k2 x^2) = ..: mean -k2 A^2/2, second harmonic k2 A^2/6";
      f.explanation =
          "the mean moves against the second harmonic, three times as far: the resonator's own motion";
      f.parameters = {{"relative", fit.strength, fit.strength_sigma, "1"}};
      f.rivals = {Stage::pickoff};
      break;
    case Curve::smooth:
      f.stage = Stage::pickoff;
      f.effect = "pickoff_nonlinearity";
      f.equation = "v = g x (1 + a2 x/d + a3 (x/d)^2 + ..)";
      f.explanation =
          "harmonics that fall quickly, all in phase, and no constant beyond theirs: a smooth curve through "
          "zero";
      f.parameters = {{"second", fit.second, 0.0, "1"}, {"third", fit.third, 0.0, "1"}};
      // c0 and c2 of their own: also a quadratic stiffness beside a smaller a2 makes them
      if (fit.offset_sigma_lsb > 0.0) f.rivals = {Stage::resonator};
      break;
    case Curve::flat_top:
      f.stage = Stage::adc;
      f.effect = "adc_saturation";
      f.equation = "v = clip(v, level)";
      f.explanation = "the curve is straight up to a level near the top and bends there";
      f.parameters = {{"level", fit.strength * h.amplitude_lsb / full_scale_lsb, 0.0, "1"}};
      break;
    default:
      f.stage = Stage::adc;
      f.effect = "adc_nonlinearity";
      f.equation = "v += INL(v)";
      f.explanation =
          "harmonics of all orders in phase with the vibration, which neither a smooth curve nor a flat top "
          "makes: steps at codes";
      f.parameters = {{"rms", fit.strength, 0.0, "LSB"}};
  }
  return f;
}

void judge_samples(const StageCapture& capture, StageDiagnosis& d) {
  const Harmonics& h = d.tones.harmonics;
  d.curve = choose_curve(h, kEach);
  d.tests.push_back({"harmonics of the primary", d.curve.chi2, d.curve.p, "LSB",
                     std::sqrt(2.0 / static_cast<double>(d.tones.rest_lsb.size())) * h.noise_lsb * 5.0});
  const double y_z = d.mean_y_lsb / d.mean_y_sigma_lsb;
  d.tests.push_back({"mean of the secondary", y_z, two_sided(y_z), "LSB", 5.0 * d.mean_y_sigma_lsb});
  const bool y_off = two_sided(y_z) < kEach;
  const Curve curve = d.curve.chosen.curve;
  if (curve != Curve::none && curve != Curve::offset)
    d.findings.push_back(curve_finding(d.curve, h, capture.full_scale_lsb));
  // The secondary stands at one code: what a converter's curve has there is no finding of its own.
  if (curve == Curve::codes) return;
  Estimate x{d.curve.chosen.offset_lsb, d.curve.chosen.offset_sigma_lsb};
  if (curve == Curve::offset) x = {d.curve.chosen.strength, d.curve.chosen.strength_sigma};
  const bool x_off = x.sigma > 0.0 && two_sided(x.z()) < kEach;
  if (!x_off && !y_off) return;
  StageFinding f = offset_finding(x.value, x.sigma, d.mean_y_lsb, d.mean_y_sigma_lsb);
  f.p = std::min(x_off ? two_sided(x.z()) : 1.0, two_sided(y_z));
  f.weight = (x_off ? x.z() * x.z() : 0.0) + (y_off ? y_z * y_z : 0.0);
  d.findings.push_back(f);
}

void judge_leak(const Estimate& leaked, StageDiagnosis& d) {
  d.tests.push_back(test_of("drive in the primary's rest", leaked, "1"));
  if (d.tests.back().p >= kEach) return;
  StageFinding f{
      .stage = Stage::actuator, .effect = "drive_feedthrough", .channel = "adc_x", .p = d.tests.back().p};
  f.equation = "P += c V_drive";
  f.explanation = "the primary holds what only the drive's words hold, at the moment they stand on the DAC";
  f.weight = leaked.z() * leaked.z();
  f.parameters = {{"coupling", leaked.value, leaked.sigma, "1"}};
  d.findings.push_back(f);
}

// A harmonic that folds to a whole number of block rates beside the vibration looks steady in the blocks; not
// in blocks of another length. Of two lengths the one that speaks less counts.
Estimate less(const Estimate& one, const Estimate& other) {
  return std::abs(one.z()) <= std::abs(other.z()) ? one : other;
}

void judge_phases(const std::array<Blocks, 2>& blocks, const StageNominal& nominal, StageDiagnosis& d) {
  const Estimate sensor = less(secondary_phase_rad(blocks[0], nominal.rebalance_per_s),
                               secondary_phase_rad(blocks[1], nominal.rebalance_per_s));
  const Estimate force =
      less(drive_force_rad(blocks[0], nominal.drive_per_s), drive_force_rad(blocks[1], nominal.drive_per_s));
  d.tests.push_back(test_of("phase of the secondary", sensor, "rad"));
  // The small motion of the secondary crosses few codes: one wrong step there bends it in a way that no phase
  // describes.
  const bool codes = d.curve.chosen.curve == Curve::codes;
  if (codes) d.notes.push_back("the phase of the secondary is not judged beside a converter's curve");
  const bool turned = !codes && std::abs(sensor.z()) > kSureOfPhase;
  d.tests.push_back(test_of("phase of the drive's force", force, "rad"));
  const bool pushed = std::abs(force.z()) > kSureOfPhase;
  if (turned) {
    StageFinding f{.stage = Stage::demodulation,
                   .effect = "demodulation_phase",
                   .channel = "adc_y",
                   .p = two_sided(sensor.z())};
    f.equation = "y = Re(Y exp(j (phase + phi)))";
    f.explanation =
        "what a rate does to the secondary is not in phase with the primary: electronics or demodulation of "
        "the secondary is turned";
    f.weight = sensor.z() * sensor.z();
    f.parameters = {{"phase", std::atan(sensor.value), sensor.sigma, "rad"}};
    d.findings.push_back(f);
  }
  if (pushed) {
    StageFinding f{
        .stage = Stage::actuator, .effect = "unknown", .channel = "adc_x", .p = two_sided(force.z())};
    f.equation = "phase' = tan(phi) g D";
    f.explanation =
        "the phase of the vibration runs while the drive is large: its force is not in phase with the "
        "velocity, or the frequency "
        "depends on the amplitude";
    f.weight = force.z() * force.z();
    f.parameters = {{"phase", std::atan(force.value), force.sigma, "rad"}};
    f.rivals = {Stage::resonator};
    d.findings.push_back(f);
  }
}

}  // namespace

std::string_view name(Stage stage) {
  constexpr std::array names = {"none", "resonator", "pickoff", "actuator", "adc", "demodulation", "core"};
  return names[static_cast<std::size_t>(stage)];
}

StageDiagnosis diagnose_stage(const StageCapture& capture, const StageNominal& nominal,
                              const Replay& replay) {
  StageDiagnosis d;
  CoreRegisters registers = capture.registers;
  bool words_known = capture.from_reset;
  if (!capture.from_reset) {
    d.notes.push_back(
        "the capture does not begin at the core's reset: its words cannot be replayed, so that core, drive "
        "and demodulation are not judged");
  } else if (capture.recorded.records.empty()) {
    d.notes.push_back(
        "no telemetry beside the samples: the core is not judged, and is taken to work as its registers say");
  } else {
    d.core = compare_core(capture.recorded, capture.registers, replay);
    if (d.core->first_record) d.findings.push_back(core_finding(*d.core));
    words_known = !d.core->first_record || d.core->explained();
    if (!words_known) d.notes.push_back("the core's own words are not known: what needs them is left out");
    registers = d.core->explaining;
  }
  Replayed replayed;
  if (words_known) replayed = replay(registers, static_cast<std::size_t>(capture.x_lsb.size()), true);
  Index from = 0;
  try {
    from = settled_from(capture, replayed.records);
  } catch (const std::invalid_argument& unsettled) {
    if (d.findings.empty()) throw;
    d.notes.push_back(std::string(unsettled.what()) + ": only the core is judged");
    d.stage = d.findings.front().stage;
    return d;
  }
  d.settled_from_s = static_cast<double>(from) / capture.sample_rate_hz;
  fit_settled(capture, from, d);
  judge_samples(capture, d);
  if (words_known) {
    const Estimate leaked = leak_of(capture, replayed.dacs, from, d.tones);
    judge_leak(leaked, d);
    const bool leaks = !d.findings.empty() && d.findings.back().effect == "drive_feedthrough";
    const auto blocks = [&](double seconds) {
      return blocks_of(capture, nominal, replayed.dacs, leaks ? leaked.value : 0.0, seconds);
    };
    judge_phases({blocks(1e-3), blocks(1.27e-3)}, nominal, d);
  }
  std::ranges::stable_sort(d.findings, std::ranges::greater(), &StageFinding::weight);
  if (!d.findings.empty()) d.stage = d.findings.front().stage;
  return d;
}

}  // namespace hemi::diagnosis
