// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/build.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "golden/concealed/noise.hpp"

namespace hemi::concealed {
namespace {

/// Stretches of 300 s, as few as hold 90 % of the energy.
std::vector<std::pair<double, double>> main_stretches(const std::vector<double>& block) {
  constexpr std::size_t kBin = 15;  // of 20 s
  std::vector<double> bins((block.size() + kBin - 1) / kBin, 0.0);
  for (std::size_t b = 0; b < block.size(); ++b) bins[b / kBin] += block[b];
  std::vector<std::size_t> order(bins.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return bins[a] > bins[b]; });
  const double total = std::accumulate(bins.begin(), bins.end(), 0.0);
  std::vector<bool> chosen(bins.size(), false);
  double held = 0.0;
  for (const std::size_t b : order) {
    if (held >= 0.9 * total) break;
    held += bins[b];
    chosen[b] = true;
  }
  std::vector<std::pair<double, double>> stretches;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (!chosen[b]) continue;
    const double from = 300.0 * static_cast<double>(b);
    if (!stretches.empty() && stretches.back().second == from)
      stretches.back().second += 300.0;
    else
      stretches.emplace_back(from, from + 300.0);
  }
  return stretches;
}

const char* channel_name(int output) {
  static const std::array<const char*, kOutputs> kNames{"frequency_hz", "drive_v", "quadrature_v",
                                                        "rate_dph"};
  return kNames[static_cast<std::size_t>(output)];
}

int strongest(const Detectability::Share& share) {
  return static_cast<int>(std::max_element(share.channel.begin(), share.channel.end()) -
                          share.channel.begin());
}

}  // namespace

void Build::add(const Drawn& drawn, const Detectability& limit) {
  result.effects.push_back(drawn.truth);
  const bool traced = drawn.trace[0].size() > 0;
  if (traced) result.effects.back().channel = channel_name(strongest(limit.share(drawn.trace)));
  result.again.push_back({drawn.truth.id, drawn.before, drawn.truth.strength});
  effects.push_back(drawn.effect);
}

void measure(Build& build, const Detectability& limit) {
  const double offset = build.stand.unit.nuisance.start_offset_degc;
  const Trace trace = trace_of(simulate(build.stand.unit.model, build.stand.in, offset, build.effects),
                               build.stand.baseline, build.stand.unit.model, build.stand.in, offset);
  const auto share = limit.share(trace);
  Case& result = build.result;
  result.dprime = share.dprime;
  for (const HiddenEffect& effect : result.effects) {
    // An effect without a noise-free trace has its own measure.
    if (effect.channel.empty()) result.dprime = std::hypot(result.dprime, effect.dprime);
  }
  for (int output = 0; output < kOutputs; ++output) {
    result.trace_rms[output] = std::sqrt(trace[output].square().mean());
    const double part = share.dprime > 0.0 ? share.channel[output] / (share.dprime * share.dprime) : 0.0;
    if (part > 0.1)
      result.places.push_back({channel_name(output), part, main_stretches(share.block[output])});
  }
}

void write(Build& build) {
  Case& result = build.result;
  const Instrument& unit = build.stand.unit;
  const Excitation& in = build.stand.in;
  const auto rows = in.time_s.size();
  State state = simulate(unit.model, in, unit.nuisance.start_offset_degc, build.effects);
  for (int output = 0; output < kOutputs; ++output) {
    const Series own = noise(unit.noise[output], rows, build.random);
    const Series& thermometer = build.stand.thermometer[output];
    result.noise_rms[output] =
        std::sqrt(own.square().mean() + (thermometer - thermometer.mean()).square().mean());
    state.output(output) += own;
  }
  state.amplitude += noise(unit.amplitude_noise, rows, build.random);
  for (const auto& effect : build.effects) effect->act(state, Stage::kWritten);
  const Series disturbance = build.stand.case_written_degc - in.case_degc;
  result.case_degc = rounded(state.case_reading_degc + disturbance, unit.nuisance.case_step_degc);
  result.board_degc = in.board_degc;
  for (double& value : result.board_degc) value += 0.02 * build.random.normal();
  result.board_degc = rounded(result.board_degc, 0.0625);
  state.frequency_hz = rounded(state.frequency_hz, 1e-7);
  state.drive_v = rounded(state.drive_v, 1e-6);
  state.quadrature_v = rounded(state.quadrature_v, 1e-6);
  state.rate_dph = rounded(state.rate_dph, unit.nuisance.rate_step_dph);
  result.amplitude = rounded(state.amplitude, 1e-7);
  result.time_s = in.time_s;
  result.kept.assign(static_cast<std::size_t>(rows), true);
  for (Eigen::Index i = 0; i < rows; ++i)
    if (in.power[i] == 0.0) result.kept[static_cast<std::size_t>(i)] = false;
  result.written = std::move(state);
  result.unit = unit;
  result.in = in;
}

void set_up(Build& build, const std::string& program, unsigned stimuli, bool board_is_resonator,
            double case_step_degc) {
  build.stand = random_stand(build.random, program, stimuli, board_is_resonator, case_step_degc);
  build.result.stated = build.stand.unit.model;
  for (int output = 0; output < kOutputs; ++output)
    build.result.colour_stated[output] = output == kRate || build.random.chance(0.7);
}

}  // namespace hemi::concealed
