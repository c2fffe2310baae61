// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hemi::concealed {
namespace {

constexpr double kRoom_degc = 23.0;

/// Corners of the chamber's temperature, straight lines between.
class Program {
 public:
  explicit Program(double length_s) : length_s_(length_s) {}
  void hold(double seconds) { corner(at_s_ + seconds, at_degc_); }
  void go(double target_degc, double degc_per_min) {
    corner(at_s_ + std::abs(target_degc - at_degc_) / degc_per_min * 60.0, target_degc);
  }
  bool unfinished() const { return at_s_ < length_s_; }
  double now_degc() const { return at_degc_; }
  Series sampled() const {
    const auto count = static_cast<Eigen::Index>(length_s_);
    Series values(count);
    std::size_t leg = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double t = static_cast<double>(i);
      while (leg + 1 < times_.size() && times_[leg + 1] < t) ++leg;
      if (leg + 1 >= times_.size()) {
        values[i] = degc_.back();
        continue;
      }
      const double share = (t - times_[leg]) / (times_[leg + 1] - times_[leg]);
      values[i] = degc_[leg] + share * (degc_[leg + 1] - degc_[leg]);
    }
    return values;
  }

 private:
  void corner(double time_s, double degc) {
    if (time_s <= at_s_) return;
    times_.push_back(at_s_ = time_s);
    degc_.push_back(at_degc_ = degc);
  }
  double length_s_, at_s_ = 0.0, at_degc_ = kRoom_degc;
  std::vector<double> times_{0.0}, degc_{kRoom_degc};
};

Series cycles(Random& random, double length_s, bool many_speeds) {
  Program program(length_s);
  program.hold(random.uniform(0.0, 900.0));
  const double speed = random.uniform(0.4, 1.2);
  bool cold = random.chance(0.6);
  while (program.unfinished()) {
    const double target = cold ? random.uniform(-25.0, 5.0) : random.uniform(28.0, 52.0);
    program.go(target, many_speeds ? random.log_uniform(0.25, 2.5) : speed);
    if (many_speeds && random.chance(0.4)) {  // a minor loop
      program.go(program.now_degc() + (cold ? 12.0 : -12.0), random.log_uniform(0.4, 1.5));
      program.go(target, random.log_uniform(0.4, 1.5));
    }
    if (random.chance(many_speeds ? 0.6 : 0.3)) program.hold(random.uniform(300.0, 2400.0));
    cold = !cold;
  }
  return program.sampled();
}

Series soaks(Random& random, double length_s) {
  Program program(length_s);
  while (program.unfinished()) {
    program.hold(random.uniform(1500.0, 4500.0));
    double target = random.uniform(-22.0, 48.0);
    if (std::abs(target - program.now_degc()) < 8.0) target = program.now_degc() > 13.0 ? -10.0 : 35.0;
    program.go(target, random.uniform(1.0, 2.5));
  }
  return program.sampled();
}

Series wandering(Random& random, double length_s) {
  const auto count = static_cast<Eigen::Index>(length_s);
  Series values = Series::Zero(count);
  const Series t = Series::LinSpaced(count, 0.0, length_s - 1.0);
  for (int i = 0; i < 6; ++i) {
    const double period_s = random.log_uniform(2500.0, 18000.0);
    values += random.uniform(2.0, 9.0) *
              (t * (2.0 * std::numbers::pi / period_s) + random.uniform(0.0, 6.28)).sin();
  }
  const Series ease = 1.0 - (-t / 1200.0).exp();  // starts at room temperature, at rest
  return kRoom_degc + ease * (values - random.uniform(0.0, 10.0));
}

Series one_way(Random& random, double length_s, bool slow) {
  Program program(length_s);
  program.hold(random.uniform(200.0, 1200.0));
  const double target = random.chance(0.6) ? random.uniform(-22.0, 0.0) : random.uniform(38.0, 52.0);
  if (slow)
    program.go(target, std::abs(target - kRoom_degc) / (length_s / 60.0));
  else
    program.go(target, random.uniform(0.25, 1.0));
  return program.sampled();
}

Series chamber(Random& random, const std::string& program, double length_s) {
  if (program == "cycle") return cycles(random, length_s, false);
  if (program == "multispeed") return cycles(random, length_s, true);
  if (program == "soak") return soaks(random, length_s);
  if (program == "random") return wandering(random, length_s);
  if (program == "ramp") return one_way(random, length_s, false);
  if (program == "slow_ramp") return one_way(random, length_s, true);
  if (program == "constant") return Program(length_s).sampled();
  throw std::invalid_argument("no chamber program " + program);
}

/// A new value from `choices` every `dwell_s`, never the same twice running.
Series stairs(Random& random, Eigen::Index count, double first, const std::vector<double>& choices,
              double dwell_s) {
  Series values(count);
  double value = first, next_s = dwell_s * random.uniform(0.8, 1.2);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (static_cast<double>(i) >= next_s) {
      double drawn = value;
      while (drawn == value) drawn = random.pick(choices);
      value = drawn;
      next_s += dwell_s;
    }
    values[i] = value;
  }
  return values;
}

Series power_cuts(Random& random, Eigen::Index count) {
  Series power = Series::Ones(count);
  const auto cuts = 1 + random.index(3);
  for (std::size_t i = 0; i < cuts; ++i) {
    const double start = static_cast<double>(count) * (static_cast<double>(i) + random.uniform(0.3, 0.7)) /
                         static_cast<double>(cuts);
    const auto at = static_cast<Eigen::Index>(start);
    const auto length = std::min(static_cast<Eigen::Index>(random.uniform(900.0, 2400.0)), count - at);
    power.segment(at, length).setZero();
  }
  return power;
}

Series board(Random& random, const Instrument& unit, const Excitation& in) {
  Series air = in.case_degc;
  if ((in.stimuli & kBoardLoad) != 0u) {
    air +=
        lagged(stairs(random, in.time_s.size(), 0.0, {-2.0, 0.0, 3.0, 6.0}, random.uniform(1500.0, 4000.0)),
               60.0, 0.0);
  }
  return lagged(air, unit.board_lag_s, air[0]) + unit.board_rise_degc;
}

}  // namespace

Series later(const Series& values, double seconds) {
  Series moved(values.size());
  const Eigen::Index last = values.size() - 2;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double at = static_cast<double>(i) + seconds;
    const auto low = std::clamp(static_cast<Eigen::Index>(std::floor(at)), Eigen::Index{0}, last);
    const double share = std::clamp(at - static_cast<double>(low), -1.0, 2.0);
    moved[i] = values[low] + share * (values[low + 1] - values[low]);
  }
  return moved;
}

Series lagged(const Series& input, double time_constant_s, double start) {
  Series output(input.size());
  const double keep = std::exp(-1.0 / time_constant_s);
  const double behind = time_constant_s * (1.0 - keep);  // lag of the response to a unit ramp over one step
  double state = start;
  output[0] = state;
  for (Eigen::Index i = 1; i < input.size(); ++i) {
    const double step = input[i] - input[i - 1];
    state = input[i - 1] + keep * (state - input[i - 1]) + step * (1.0 - behind);
    output[i] = state;
  }
  return output;
}

Excitation random_excitation(Random& random, const Instrument& unit, const std::string& program,
                             unsigned stimuli) {
  Excitation in;
  in.program = program;
  in.stimuli = stimuli;
  const double length_s = 600.0 * std::round(random.uniform(5.0, 10.0) * 6.0);
  const auto count = static_cast<Eigen::Index>(length_s);
  in.time_s = Series::LinSpaced(count, 0.0, length_s - 1.0);
  const Series air = chamber(random, program, length_s);
  in.case_degc =
      lagged(lagged(air, random.uniform(150.0, 500.0), kRoom_degc), random.uniform(20.0, 80.0), kRoom_degc);
  in.case_ahead_degc = later(in.case_degc, 0.5 - unit.nuisance.lag_s);
  in.board_degc = board(random, unit, in);
  const bool turn = (stimuli & kTurn) != 0u, tumble = (stimuli & kTumble) != 0u;
  in.rate_in_dph =
      !turn ? Series::Zero(count)
            : stairs(random, count, 0.0, {-108000.0, -72000.0, -36000.0, 0.0, 36000.0, 72000.0, 108000.0},
                     random.uniform(400.0, 1000.0));
  in.accel_g = Series::Zero(count);
  if (tumble) in.accel_g = stairs(random, count, 0.0, {-1.0, 0.0, 1.0}, random.uniform(1500.0, 3000.0));
  if ((stimuli & kTilts) != 0u)
    in.accel_g = stairs(random, count, 1.0, {-1.0, -0.8660254, -0.5, 0.0, 0.5, 0.8660254, 1.0},
                        random.uniform(600.0, 1200.0));
  in.supply_v = Series::Constant(count, 150.0);
  if ((stimuli & kSupply) != 0u)
    in.supply_v =
        stairs(random, count, 150.0, {149.1, 149.7, 150.0, 150.3, 150.6}, random.uniform(1200.0, 2500.0));
  in.trim_v = Series::Zero(count);
  if ((stimuli & kTrim) != 0u)
    in.trim_v = stairs(random, count, 0.0, {-0.25, 0.0, 0.15, 0.3}, random.uniform(1500.0, 2500.0));
  in.amplitude = Series::Ones(count);
  if ((stimuli & kSteps) != 0u)
    in.amplitude = stairs(random, count, 1.0, {0.8, 0.9, 1.0, 1.15}, random.uniform(1000.0, 2000.0));
  in.power = (stimuli & kPower) != 0u ? power_cuts(random, count) : Series::Ones(count);
  return in;
}

}  // namespace hemi::concealed
