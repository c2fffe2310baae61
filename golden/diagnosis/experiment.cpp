// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "golden/diagnosis/nominal_simulation.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;
constexpr double kHour_s = 3600.0;
constexpr double kLongest_s = 10.0 * kHour_s;
constexpr double kLeastRange_degc = 40.0;
constexpr double kBeyond_degc = 5.0;  // what a simulation asks of f(T) outside the chamber's range
constexpr double kShortestLag_s = 60.0;
constexpr double kLongestLag_s = 8000.0;
constexpr double kLagRatio = 1.4;

// A chamber that goes and stays.
class Course {
 public:
  Course(std::string words, double start_degc) {
    experiment_.program = std::move(words);
    experiment_.chamber_degc.push_back({0.0, start_degc});
  }
  Course& hold(double hours) { return corner(hours * kHour_s, experiment_.chamber_degc.back().value); }
  Course& go(double degc, double degc_per_min) {
    return corner(60.0 * std::abs(degc - experiment_.chamber_degc.back().value) / degc_per_min, degc);
  }
  Experiment done() {
    experiment_.duration_s = 60.0 * std::ceil(experiment_.chamber_degc.back().time_s / 60.0 - 1e-9);
    return experiment_;
  }

 private:
  Course& corner(double after_s, double degc) {
    if (after_s > 0.0)
      experiment_.chamber_degc.push_back({experiment_.chamber_degc.back().time_s + after_s, degc});
    return *this;
  }
  Experiment experiment_;
};

// Values that an input takes in turn, as differences from rest or shares of it, and how long each lasts.
struct Pattern {
  const char* words;
  std::vector<double> values;
  double dwell_s;
};

// Sizes that any instrument takes; dwells far above loop settling, no two in a simple ratio.
const Pattern& pattern(Stimulus stimulus) {
  static const std::map<Stimulus, Pattern> patterns = {
      {Stimulus::amplitude, {"amplitude steps of -15 to +15 %", {1.0, 0.85, 1.15, 0.92}, 1100.0}},
      {Stimulus::rate,
       {"rate table at 0 and +-10 to +-30 deg/s", {0.0, 108e3, -108e3, 36e3, -36e3, 72e3, -72e3}, 700.0}},
      {Stimulus::attitude,
       {"tilts by 30 degrees from +1 g to -1 g along the axis",
        {1.0, 0.8660254, 0.5, 0.0, -0.5, -0.8660254, -1.0, -0.5, 0.0, 0.5},
        600.0}},
      {Stimulus::supply, {"supply steps of +-0.4 %", {1.0, 1.004, 0.996, 1.002}, 1300.0}},
      {Stimulus::trim, {"quadrature offsets of -0.25 to +0.3 V", {0.0, 0.3, -0.25, 0.15}, 1700.0}},
      {Stimulus::board_heater, {"board heated by 10 and 5 degC in turns", {0.0, 10.0, 0.0, 5.0}, 2900.0}}};
  return patterns.at(stimulus);
}

// Case to board: the lag that leaves least, and the rise beside it.
void fit_board(const Telemetry& t, Stand& stand) {
  const auto rest = [&](double tau_s) -> ArrayXd {
    return t.board_degc.array() - lag(t.case_degc, t.step_s, tau_s, t.case_degc[0]);
  };
  const auto left = [&](double tau_s) {
    const ArrayXd x = rest(tau_s);
    return (x - x.mean()).square().sum();
  };
  double best = 0.0, least = left(0.0);
  for (double tau_s = kShortestLag_s; tau_s < kLongestLag_s; tau_s *= kLagRatio)
    if (const double now = left(tau_s); now < least) {
      least = now;
      best = tau_s;
    }
  if (best > 0.0) {
    constexpr int kBits = 16;
    best = boost::math::tools::brent_find_minima(left, best / kLagRatio, best * kLagRatio, kBits).first;
  }
  stand.board_lag_s = best;
  stand.board_rise_degc = rest(best).mean();
}

bool usable(const NominalModel& model, double low_degc, double high_degc) {
  const ArrayXd degc = ArrayXd::LinSpaced(101, low_degc - kBeyond_degc, high_degc + kBeyond_degc);
  if (!model.frequency_hz.coefficients.empty() && !(model.frequency_hz.slope(degc) > 0.0).all() &&
      !(model.frequency_hz.slope(degc) < 0.0).all())
    return false;
  return model.drive_v.coefficients.empty() || (model.drive_v.at(degc) > 0.0).all();
}

VectorXd straight(const std::vector<Corner>& corners, const ArrayXd& time_s) {
  VectorXd values(time_s.size());
  std::size_t leg = 0;
  for (Index i = 0; i < values.size(); ++i) {
    while (leg + 1 < corners.size() && corners[leg + 1].time_s <= time_s[i]) ++leg;
    values[i] = corners[leg].value;
    if (leg + 1 == corners.size()) continue;
    const auto &a = corners[leg], &b = corners[leg + 1];
    values[i] = std::lerp(a.value, b.value, (time_s[i] - a.time_s) / (b.time_s - a.time_s));
  }
  return values;
}

}  // namespace

std::string Experiment::in_words() const {
  std::string text = fmt::format("{}, {:.3g} h", program, duration_s / kHour_s);
  std::string separator = "; beside it ";
  for (const auto& [stimulus, corners] : steps) {
    text += separator + pattern(stimulus).words;
    separator = ", ";
  }
  return text;
}

Stand stand_of(const Telemetry& t, const NominalModel& model) {
  Stand stand;
  stand.low_degc = t.case_degc.minCoeff();
  stand.high_degc = t.case_degc.maxCoeff();
  const double middle = 0.5 * (stand.low_degc + stand.high_degc);
  const double recorded = 0.5 * (stand.high_degc - stand.low_degc);
  for (double half = std::max(0.5 * kLeastRange_degc, recorded); half > 1.0; half *= 0.9) {
    stand.low_degc = std::round(middle - half);
    stand.high_degc = std::round(middle + half);
    if (usable(model, stand.low_degc, stand.high_degc)) break;
  }
  stand.start_degc = std::clamp(std::round(t.case_degc[0]), stand.low_degc, stand.high_degc);
  if (t.has_board) fit_board(t, stand);
  if (t.has_supply) stand.supply_v = median(t.supply_v);
  stand.setpoint = median(t.amplitude);
  return stand;
}

double rest_value(Stimulus stimulus, const Stand& stand) {
  if (stimulus == Stimulus::amplitude) return stand.setpoint;
  if (stimulus == Stimulus::supply) return stand.supply_v;
  return 0.0;
}

std::vector<Experiment> chamber_programs(const Stand& s) {
  std::vector<Experiment> all;
  const double near = s.start_degc - s.low_degc < s.high_degc - s.start_degc ? s.low_degc : s.high_degc;
  const double far = near == s.low_degc ? s.high_degc : s.low_degc;
  const auto begin = [&](const std::string& words) { return Course(words, s.start_degc); };
  const std::string range = fmt::format("between {:g} and {:g} degC", s.low_degc, s.high_degc);
  // Everything at least twice: what comes once cannot be predicted from the rest.
  for (const double hours : {0.5, 1.0}) {
    Course course = begin(
        fmt::format("steps of the chamber to {:g} and {:g} degC at 2 degC/min, twice, each held", far, near));
    course.hold(0.25);
    for (int i = 0; i < 2; ++i) course.go(far, 2.0).hold(hours).go(near, 2.0).hold(hours);
    all.push_back(course.done());
  }
  for (const double speed : {2.0, 1.0, 0.5}) {
    Course course = begin(fmt::format("two cycles {} at {:g} degC/min", range, speed));
    course.hold(0.25);
    for (int i = 0; i < 2; ++i) course.go(far, speed).go(near, speed);
    all.push_back(course.go(s.start_degc, speed).hold(0.5).done());
  }
  for (const double slowest : {1.0, 0.5, 0.35}) {
    const std::vector<double> speeds = {2.0, std::sqrt(2.0 * slowest), slowest};
    Course course =
        begin(fmt::format("cycles {} at {:.2g}, {:.2g} and {:.2g} degC/min with minor loops and a hold",
                          range, speeds[0], speeds[1], speeds[2]));
    const double back = 0.3 * (far - near);
    course.hold(0.25);
    for (const double speed : speeds) {
      course.go(far, speed).go(far - back, 1.0).go(far, 1.0);
      if (speed == speeds[0]) course.hold(0.75);
      course.go(near, speed).go(near + back, 1.0).go(near, 1.0);
    }
    all.push_back(course.hold(0.75).done());
  }
  std::erase_if(all, [](const Experiment& each) { return each.duration_s > kLongest_s; });
  return all;
}

Experiment with_stimuli(Experiment experiment, const std::vector<Stimulus>& stimuli, const Stand& stand) {
  for (const Stimulus stimulus : stimuli) {
    const Pattern& p = pattern(stimulus);
    const bool share = stimulus == Stimulus::amplitude || stimulus == Stimulus::supply;
    // All values come at least twice, or a drift could be mistaken for them.
    const double dwell_s =
        std::min(p.dwell_s, std::floor(experiment.duration_s / (2.0 * static_cast<double>(p.values.size()))));
    auto& corners = experiment.steps[stimulus];
    std::size_t next = 0;
    for (double time_s = dwell_s; time_s < experiment.duration_s - 60.0; time_s += dwell_s) {
      next = (next + 1) % p.values.size();
      corners.push_back({time_s, p.values[next] * (share ? rest_value(stimulus, stand) : 1.0)});
    }
  }
  return experiment;
}

Telemetry inputs_of(const Experiment& experiment, const Stand& stand, double step_s) {
  Telemetry t;
  t.step_s = step_s;
  const auto rows = static_cast<Index>(experiment.duration_s / step_s);
  const ArrayXd time_s = ArrayXd::LinSpaced(rows, 0.0, step_s * static_cast<double>(rows - 1));
  const auto stepped = [&](Stimulus stimulus) {
    VectorXd values = VectorXd::Constant(rows, rest_value(stimulus, stand));
    const auto found = experiment.steps.find(stimulus);
    if (found == experiment.steps.end()) return values;
    for (const Corner& corner : found->second) {
      const auto from = std::min(static_cast<Index>(std::ceil(corner.time_s / step_s)), rows);
      values.tail(rows - from).setConstant(corner.value);
    }
    return values;
  };
  const ArrayXd chamber = straight(experiment.chamber_degc, time_s);
  t.case_degc = lag(chamber, step_s, stand.case_time_constant_s, chamber[0]);
  t.board_degc = lag(t.case_degc, step_s, stand.board_lag_s, t.case_degc[0]) + stand.board_rise_degc +
                 lag(stepped(Stimulus::board_heater), step_s, stand.heater_time_constant_s, 0.0);
  t.amplitude = stepped(Stimulus::amplitude);
  t.rate_in_dph = stepped(Stimulus::rate);
  t.accel_g = stepped(Stimulus::attitude);
  t.supply_v = stepped(Stimulus::supply);
  t.trim_v = stepped(Stimulus::trim);
  t.has_board = t.has_accel = t.has_supply = true;
  t.powered = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(rows, true);
  return t;
}

}  // namespace hemi::diagnosis
