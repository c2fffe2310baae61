// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hemi::scenario {
namespace {

constexpr Quantity kTime = {"s", 0.0, 1e9};
constexpr Quantity kPositiveTime = {"s", 1e-6, 1e9};
constexpr Quantity kTemperature = {"degC", -273.15, 1000.0};
constexpr Quantity kRamp = {"degC/min", 1e-6, 1000.0};
constexpr Quantity kAcceleration = {"deg/s^2", 1e-3, 1e6};
constexpr Quantity kFrequency = {"Hz", 1e-9, 1000.0};
constexpr Quantity kCount = {"1", 1.0, 10000.0};
constexpr double kDphPerDps = 3600.0;
constexpr double kDefaultAcceleration_dps2 = 100.0;

/// One input: its section, the key of a constant, unit and range, and the value where nothing is said.
struct Input {
  std::string_view section;
  std::string_view key;
  Quantity quantity;
  double fallback;
};

using Points = std::vector<Signal::Point>;

/// [[time, value], ...], times increasing.
Points read_pairs(const Section& section, std::string_view key, const Quantity& quantity) {
  Points points;
  const std::string name = section.where(key).name;
  for (const Value& item : section.list(key)) {
    const Where where{section.where().path, name, item.line};
    const auto* pair = std::get_if<List>(&item.content);
    if (pair == nullptr || pair->size() != 2) {
      refuse(where, fmt::format("expected [time, value], found {}", kind_of(item)),
             "write [[\"0 s\", ...], [\"1 h\", ...]]");
    }
    const Signal::Point point{read_quantity(pair->at(0), kTime, where),
                              read_quantity(pair->at(1), quantity, where)};
    if (!points.empty() && !(point.time_s > points.back().time_s)) {
      refuse(
          where,
          fmt::format("times must increase, and {:g} s follows {:g} s", point.time_s, points.back().time_s),
          "sort the list by time");
    }
    points.push_back(point);
  }
  if (points.empty()) section.refuse(key, "the list is empty", "give at least one [time, value]");
  return points;
}

Signal read_steps(const Section& section, const Quantity& quantity, double before) {
  Points points{{0.0, before}};
  for (const Signal::Point& step : read_pairs(section, "steps", quantity)) {
    points.push_back({step.time_s, points.back().value});
    points.push_back(step);
  }
  return Signal(std::move(points));
}

Signal read_sine(const Section& parent, const Input& input) {
  const Section section = parent.section("sine");
  section.allow({"amplitude", "frequency", "offset"});
  const double amplitude = section.quantity("amplitude", input.quantity);
  const double offset = section.quantity("offset", input.quantity, input.fallback);
  if (offset + std::abs(amplitude) > input.quantity.highest ||
      offset - std::abs(amplitude) < input.quantity.lowest) {
    section.refuse("amplitude",
                   fmt::format("offset and amplitude leave {:g} to {:g} {}", input.quantity.lowest,
                               input.quantity.highest, input.quantity.unit),
                   "make it smaller");
  }
  return Signal(offset, amplitude, section.quantity("frequency", kFrequency));
}

/// Constant, profile, steps or sine: what all inputs but chamber and table have.
Signal read_signal(const Section& section, const Input& input) {
  const auto form = section.one_of({input.key, "profile", "steps", "sine"});
  if (form == "profile") return Signal(read_pairs(section, "profile", input.quantity));
  if (form == "steps") return read_steps(section, input.quantity, input.fallback);
  if (form == "sine") return read_sine(section, input);
  return Signal(section.quantity(input.key, input.quantity, input.fallback));
}

Signal read_plain(const Section& scenario, const Input& input) {
  const Section section = scenario.section(input.section);
  section.allow({input.key, "profile", "steps", "sine"});
  return read_signal(section, input);
}

// ---- chamber

/// A chamber that goes to a temperature at constant speed and stays there.
class Chamber {
 public:
  Chamber(double start_degc, double ramp_degc_per_min)
      : points_{{0.0, start_degc}}, slope_degc_s_(ramp_degc_per_min / 60.0) {}

  void stay(double duration_s) {
    if (duration_s > 0.0) points_.push_back({points_.back().time_s + duration_s, points_.back().value});
  }
  /// How long the ramp lasted.
  double go(double degc) {
    const Signal::Point from = points_.back();
    const double ramp_s = std::abs(degc - from.value) / slope_degc_s_;
    if (ramp_s > 0.0) points_.push_back({from.time_s + ramp_s, degc});
    return ramp_s;
  }
  Signal signal() const { return Signal(points_); }

 private:
  Points points_;
  double slope_degc_s_;
};

std::vector<double> soak_levels(const Section& section) {
  if (section.one_of({"levels", "from"}) == "levels") return section.quantities("levels", kTemperature);
  const double from = section.quantity("from", kTemperature);
  const double to = section.quantity("to", kTemperature);
  const double step = section.quantity("step", {"degC", 1e-3, 1000.0}, 10.0);
  const double count = std::abs(to - from) / step;
  if (std::abs(count - std::round(count)) > 1e-9 || count > kCount.highest) {
    section.refuse("step",
                   fmt::format("{:g} degC do not divide the way from {:g} to {:g} degC", step, from, to),
                   "choose another step, or list the levels");
  }
  std::vector<double> levels;
  for (int i = 0; i <= static_cast<int>(std::lround(count)); ++i)
    levels.push_back(from + std::copysign(step, to - from) * i);
  return levels;
}

Signal read_soaks(const Section& section) {
  section.allow({"levels", "from", "to", "step", "hold", "period", "ramp", "start"});
  const std::vector<double> levels = soak_levels(section);
  Chamber chamber(section.quantity("start", kTemperature, levels.front()),
                  section.quantity("ramp", kRamp, 1.0));
  const bool periods = section.one_of({"hold", "period"}) == "period";
  const double time_s = section.quantity(periods ? "period" : "hold", kPositiveTime);
  for (const double level : levels) {
    const double ramp_s = chamber.go(level);
    if (periods && ramp_s >= time_s) {
      section.refuse("period", fmt::format("the ramp to {:g} degC alone takes {:g} s", level, ramp_s),
                     "allow a longer period or a faster ramp");
    }
    chamber.stay(periods ? time_s - ramp_s : time_s);
  }
  return chamber.signal();
}

Signal read_cycles(const Section& section) {
  section.allow({"low", "high", "count", "hold", "ramp", "start"});
  const double low = section.quantity("low", kTemperature);
  const double high = section.quantity("high", kTemperature);
  if (!(high > low)) section.refuse("high", "is not above low", "exchange the two");
  const double count = section.quantity("count", kCount, 1.0);
  if (count != std::floor(count)) section.refuse("count", "is no whole number", "write 1, 2, ...");
  const double hold_s = section.quantity("hold", kTime, 0.0);
  const double start = section.quantity("start", kTemperature, 20.0);
  Chamber chamber(start, section.quantity("ramp", kRamp, 1.0));
  chamber.stay(hold_s);
  for (int i = 0; i < static_cast<int>(count); ++i) {
    for (const double end : {low, high}) {
      chamber.go(end);
      chamber.stay(hold_s);
    }
  }
  chamber.go(start);
  chamber.stay(hold_s);
  return chamber.signal();
}

Signal read_chamber(const Section& scenario) {
  const Input input = {"chamber", "temperature_degc", kTemperature, 20.0};
  const Section section = scenario.section(input.section);
  section.allow({input.key, "profile", "soaks", "cycles"});
  const auto form = section.one_of({input.key, "profile", "soaks", "cycles"});
  if (form == "profile") return Signal(read_pairs(section, "profile", kTemperature));
  if (form == "soaks") return read_soaks(section.section("soaks"));
  if (form == "cycles") return read_cycles(section.section("cycles"));
  return Signal(section.quantity(input.key, input.quantity, input.fallback));
}

// ---- table

/// Rates that the table takes up at times, each reached at the given acceleration.
Signal accelerated(const Points& steps, double acceleration_dps2, const Section& section,
                   std::string_view key) {
  Points points{{0.0, 0.0}};
  for (const Signal::Point& step : steps) {
    const double from_dph = points.back().value;
    const double ramp_s = std::abs(step.value - from_dph) / kDphPerDps / acceleration_dps2;
    if (step.time_s < points.back().time_s) {
      section.refuse(key,
                     fmt::format("at {:g} s the table is still on its way to {:g} deg/h, until {:g} s",
                                 step.time_s, from_dph, points.back().time_s),
                     "allow more time or a larger acceleration");
    }
    if (step.time_s > points.back().time_s) points.push_back({step.time_s, from_dph});
    if (ramp_s > 0.0) points.push_back({step.time_s + ramp_s, step.value});
  }
  return Signal(std::move(points));
}

Points read_levels(const Section& section, const Quantity& rate) {
  section.allow({"rates", "hold", "from"});
  const double hold_s = section.quantity("hold", kPositiveTime);
  Points steps;
  double time_s = section.quantity("from", kTime, 0.0);
  for (const double rate_dph : section.quantities("rates", rate)) {
    steps.push_back({time_s, rate_dph});
    time_s += hold_s;
  }
  steps.push_back({time_s, 0.0});
  return steps;
}

Signal read_table(const Section& scenario) {
  const Quantity rate = {"deg/h", -3.6e6, 3.6e6};
  const Input input = {"table", "rate_dph", rate, 0.0};
  const Section section = scenario.section(input.section);
  section.allow({input.key, "profile", "steps", "levels", "sine", "acceleration"});
  const auto form = section.one_of({input.key, "profile", "steps", "levels", "sine"});
  const double acceleration_dps2 = section.quantity("acceleration", kAcceleration, kDefaultAcceleration_dps2);
  if (form == "steps") return accelerated(read_pairs(section, form, rate), acceleration_dps2, section, form);
  if (form == "levels")
    return accelerated(read_levels(section.section(form), rate), acceleration_dps2, section, form);
  if (section.has("acceleration")) {
    section.refuse("acceleration", "is of no use here", "leave it out, or turn by steps or levels");
  }
  return read_signal(section, input);
}

}  // namespace

physics::Environment Inputs::at(double time_s) const {
  physics::Environment e;
  e.time_s = time_s;
  e.chamber_degc = chamber_degc.value(time_s);
  e.rate_dph = scale_factor * rate_dph.value(time_s);
  e.rate_slope_dph_s = scale_factor * rate_dph.slope(time_s);
  e.accel_g = accel_g.value(time_s);
  e.supply_v = supply_v.value(time_s);
  e.amplitude_setpoint = setpoint.value(time_s);
  e.quadrature_trim_v = trim_v.value(time_s);
  e.power_on_s = power_on_s;
  e.board_heater_degc = heater_degc.value(time_s);
  return e;
}

double Inputs::end_s() const {
  return std::max({chamber_degc.end_s(), rate_dph.end_s(), accel_g.end_s(), supply_v.end_s(),
                   setpoint.end_s(), trim_v.end_s(), heater_degc.end_s()});
}

Inputs read_inputs(const Section& scenario) {
  Inputs inputs;
  inputs.chamber_degc = read_chamber(scenario);
  inputs.rate_dph = read_table(scenario);
  inputs.accel_g = read_plain(scenario, {"attitude", "accel_g", {"g", -1000.0, 1000.0}, 0.0});
  const Input supply = {"supply", "supply_v", {"V", 0.0, 10000.0}, 5.0};
  const Section section = scenario.section(supply.section);
  section.allow({supply.key, "profile", "steps", "sine", "power_on"});
  inputs.supply_v = read_signal(section, supply);
  inputs.power_on_s = section.quantity("power_on", {"s", -1e9, 1e9}, 0.0);
  inputs.setpoint = read_plain(scenario, {"amplitude", "setpoint", {"1", 1e-3, 10.0}, 1.0});
  inputs.trim_v = read_plain(scenario, {"quadrature", "trim_v", {"V", -1000.0, 1000.0}, 0.0});
  inputs.heater_degc = read_plain(scenario, {"board", "heater_degc", {"degC", 0.0, 100.0}, 0.0});
  return inputs;
}

}  // namespace hemi::scenario
