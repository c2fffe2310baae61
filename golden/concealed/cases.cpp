// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/cases.hpp"

#include <algorithm>
#include <stdexcept>

#include "golden/concealed/build.hpp"

namespace hemi::concealed {
namespace {

std::vector<const Kind*> kinds_alone() {
  std::vector<const Kind*> all;
  for (const Kind& one : catalogue_kinds())
    if (!one.unsuited_alone) all.push_back(&one);
  return all;
}

const std::string& any_program(Random& random) {
  return random.pick(random.chance(0.85) ? kFullPrograms : kPoorPrograms);
}

bool make_null(Build& build) {
  set_up(build, any_program(build.random), random_stimuli(build.random, 0.5));
  measure(build, detectability(build.stand));
  return true;
}

bool make_params(Build& build) {
  set_up(build, any_program(build.random), random_stimuli(build.random, 0.5));
  const auto limit = detectability(build.stand);
  build.result.changed = change_numbers(build.random, build.stand, limit, build.result.stated);
  measure(build, limit);
  return true;
}

/// The stimuli that tell `one` from its rivals, on a run that goes through several speeds and both
/// directions.
void set_up_for(Build& build, unsigned needs, double rich_share) {
  const auto& programs = std::vector<std::string>{"multispeed", "multispeed", "soak", "cycle", "random"};
  unsigned extra = random_stimuli(build.random, rich_share);
  if ((needs & kTilts) != 0u) extra &= ~static_cast<unsigned>(kTumble);
  set_up(build, build.random.pick(programs), needs | extra);
}

/// A lag and a delay look alike until the frequency's curvature shows: is there more than the shift that both
/// have in common?
bool bends(const Build& build, const Detectability& limit, const Kind& one, const Trace& trace) {
  if (one.id != "pll_lag" && one.id != "time_shift") return false;
  Trace shift;
  for (Series& series : shift) series = Series::Zero(build.stand.in.time_s.size());
  shift[kFrequency] = slope(build.stand.baseline.frequency_hz);
  return limit.dprime_beside(trace, shift) > kLimit;
}

bool make_single(Build& build, const Kind& one, Wanted wanted) {
  set_up_for(build, one.needs, 0.5);
  const auto limit = detectability(build.stand);
  const auto drawn = draw_effect(build.random, build.stand, limit, one, wanted);
  if (!drawn) return false;
  build.add(*drawn, limit);
  if (!one.equivalents.empty() && !drawn->unmistakable && !bends(build, limit, one, drawn->trace)) {
    build.result.set = one.equivalents;
    build.result.set.push_back(one.id);
  }
  measure(build, limit);
  return true;
}

bool is_noise(const std::string& id) {
  return id == "rate_random_walk" || id == "rate_flicker";
}

/// Pairs that are nearly one over most runs, and pairs that meet by chance.
bool make_pair(Build& build, std::uint64_t index) {
  static const std::vector<std::pair<const char*, const char*>> kClose{
      {"frequency_polynomial_order", "oscillator_temperature"},
      {"thermal_second_time_constant", "thermal_gradient_bias"},
      {"thermal_hysteresis", "thermal_gradient_bias"},
      {"thermal_hysteresis", "rate_random_walk"},
      {"frequency_ageing", "oscillator_temperature"},
      {"gas_leak", "damping_temperature"},
      {"demodulation_phase", "forcer_misalignment"},
      {"duffing", "electrostatic_softening"},
      {"scale_factor_temperature", "pickoff_gain"},
      {"frequency_ageing", "thermal_second_time_constant"},
      {"frequency_split", "demodulation_phase"},
      {"self_heating", "thermal_second_time_constant"}};
  std::pair<std::string, std::string> ids;
  if (index % 2 == 0) {
    ids = kClose[(index / 2) % kClose.size()];
  } else {
    const auto alone = kinds_alone();
    do ids = {build.random.pick(alone)->id, build.random.pick(alone)->id};
    while (ids.first == ids.second || ids.first == "cycle_slip" || ids.second == "cycle_slip" ||
           ids.first == "earth_rate" || ids.second == "earth_rate");
  }
  // What is noise to the other comes first: the other's d' is over it.
  if (is_noise(ids.second)) std::swap(ids.first, ids.second);
  const Kind &a = kind(ids.first), &b = kind(ids.second);
  set_up_for(build, a.needs | b.needs, 0.5);
  const auto limit = detectability(build.stand);
  const auto first = draw_effect(build.random, build.stand, limit, a, {20.0, 250.0});
  if (!first) return false;
  const auto over = is_noise(ids.first) ? detectability_in(build.stand, first->noise) : limit;
  const auto second = draw_effect(build.random, build.stand, over, b, {20.0, 250.0});
  if (!second) return false;
  build.add(*first, limit);
  build.add(*second, limit);
  if (!is_noise(ids.first) && first->trace[0].size() > 0 && second->trace[0].size() > 0) {
    build.result.effects[0].dprime_beside = limit.dprime_beside(first->trace, second->trace);
    build.result.effects[1].dprime_beside = limit.dprime_beside(second->trace, first->trace);
  }
  for (const Kind* one : {&a, &b}) {
    build.result.set.push_back(one->id);
    for (const auto& other : one->equivalents) build.result.set.push_back(other);
  }
  measure(build, limit);
  return true;
}

/// Runs over which the effect looks like others; `set` says which.
struct Poor {
  std::vector<std::string> set;
  std::vector<std::string> programs;
  unsigned stimuli = 0;
  bool board_is_resonator = false;
};

/// At one amplitude nobody can say through which of two channels the growing loss reaches the rate.
bool make_leak_into_rate(Build& build) {
  set_up(build, build.random.pick(kFullPrograms), 0);
  const auto limit = detectability(build.stand);
  const auto leak = draw_effect(build.random, build.stand, limit, kind("gas_leak"), {200.0, 1e4});
  if (!leak) return false;
  build.add(*leak, limit);
  Stand leaking = build.stand;
  leaking.present = build.effects;
  leaking.baseline =
      simulate(leaking.unit.model, leaking.in, leaking.unit.nuisance.start_offset_degc, leaking.present);
  const std::vector<std::string> set{"damping_anisotropy", "forcer_misalignment"};
  const auto into_rate =
      draw_effect(build.random, leaking, limit, kind(build.random.pick(set)), {20.0, 250.0});
  if (!into_rate) return false;
  build.add(*into_rate, limit);
  build.result.set = set;
  build.result.set.emplace_back("gas_leak");
  measure(build, limit);
  return true;
}

bool make_poor(Build& build, std::uint64_t index) {
  static const std::vector<Poor> kPoor{
      {{"thermal_second_time_constant", "thermal_gradient_bias", "thermal_hysteresis", "frequency_ageing",
        "self_heating"},
       {"ramp", "slow_ramp"}},
      {{"frequency_polynomial_order", "oscillator_temperature"}, {"cycle", "multispeed"}, 0, true},
      {{"frequency_ageing", "oscillator_ageing"}, kFullPrograms},
      {{"frequency_ageing", "oscillator_ageing", "self_heating"}, {"constant"}},
      {{"g_sensitivity", "earth_rate"}, kFullPrograms, kTumble}};
  if (index % (kPoor.size() + 1) == kPoor.size()) return make_leak_into_rate(build);
  const Poor& poor = kPoor[index % (kPoor.size() + 1)];
  set_up(build, build.random.pick(poor.programs), poor.stimuli, poor.board_is_resonator);
  const auto limit = detectability(build.stand);
  const bool fixed = poor.set.back() == "earth_rate";
  const auto drawn = draw_effect(build.random, build.stand, limit, kind(build.random.pick(poor.set)),
                                 {20.0, fixed ? 1e5 : 250.0});
  if (!drawn) return false;
  build.add(*drawn, limit);
  build.result.set = poor.set;
  measure(build, limit);
  return true;
}

bool make_confounder(Build& build) {
  Random& random = build.random;
  const double coarse = random.chance(0.4) ? 0.05 : 0.0;
  set_up(build, any_program(random), random_stimuli(random, 0.5), false, coarse);
  if (coarse > 0.0) build.result.confounders.emplace_back("coarse case thermometer");
  confound_stand(random, build.result, build.stand);
  measure(build, detectability(build.stand));
  write(build);
  confound_file(random, build.result);
  return true;
}

/// Every seed and class goes through the kinds in an order of its own: few recordings are no less diverse.
template <typename T>
std::vector<T> shuffled(std::vector<T> all, const std::string& cls, std::uint64_t seed) {
  Random random(seed, cls + " order", 0);
  for (std::size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[random.index(i)]);
  return all;
}

bool fill(Build& build, const std::string& cls, std::uint64_t seed, std::uint64_t index, int attempt) {
  const auto alone = shuffled(kinds_alone(), cls, seed);
  // After a few failures the next kind: some have no d' of this size on any run.
  const auto& one = *alone[(index + static_cast<std::uint64_t>(attempt) / 6) % alone.size()];
  if (cls == "null") return make_null(build);
  if (cls == "params") return make_params(build);
  if (cls == "single_strong") {
    const bool huge = one.id == "cycle_slip" || one.id == "earth_rate" || one.id == "time_shift";
    return make_single(build, one, {55.0, huge ? 1e9 : 1000.0});
  }
  if (cls == "single_moderate") return make_single(build, one, {16.0, 48.0});
  if (cls == "weak") return make_single(build, one, {0.2, 1.5});
  if (cls == "unknown") {
    const auto kinds = shuffled(unknown_kinds(), cls, seed);
    return make_single(build, kinds[index % kinds.size()], {30.0, 600.0});
  }
  if (cls == "pair")
    return make_pair(build, seed * 2 + index + 2 * (static_cast<std::uint64_t>(attempt) / 8));
  if (cls == "poor") return make_poor(build, index + seed);
  return make_confounder(build);
}

}  // namespace

const std::vector<ClassSize>& classes() {
  static const std::vector<ClassSize> sizes{
      {"null", 400}, {"params", 200},  {"single_strong", 100}, {"single_moderate", 100}, {"weak", 100},
      {"pair", 100}, {"unknown", 100}, {"poor", 100},          {"confounder", 100}};
  return sizes;
}

Case make_case(const std::string& cls, std::uint64_t seed, std::uint64_t index) {
  const auto& all = classes();
  if (std::none_of(all.begin(), all.end(), [&](const ClassSize& one) { return one.name == cls; }))
    throw std::invalid_argument("no class of concealed recordings '" + cls + "'");
  Random random(seed, cls, index);
  for (int attempt = 0; attempt < 100; ++attempt) {
    Build build{random};
    if (!fill(build, cls, seed, index, attempt)) continue;
    if (build.result.kept.empty()) write(build);
    build.result.cls = cls;
    build.result.seed = seed;
    build.result.index = index;
    return std::move(build.result);
  }
  throw std::runtime_error("no recording of class " + cls + " could be drawn");
}

Case repeat_case(const Case& first, const Excitation& inputs) {
  Random random(first.seed, first.cls + " again", first.index);
  Build build{random};
  build.stand.unit = first.unit;
  build.stand.in = inputs;
  read_thermometer(random, build.stand);
  const State sizing = simulate(first.unit.model, first.in, first.unit.nuisance.start_offset_degc);
  build.result.stated = first.stated;
  build.result.colour_stated = first.colour_stated;
  for (std::size_t i = 0; i < first.again.size(); ++i) {
    Random same = first.again[i].before;
    const Setting where_drawn{same, first.in, first.unit.model, sizing};
    const Form form = kind(first.again[i].id)
                          .draw({same, inputs, build.stand.unit.model, build.stand.baseline, &where_drawn});
    build.result.effects.push_back(first.effects[i]);
    build.effects.push_back(form.at(first.again[i].strength));
  }
  write(build);
  build.result.cls = first.cls;
  build.result.seed = first.seed;
  build.result.index = first.index;
  return std::move(build.result);
}

}  // namespace hemi::concealed
