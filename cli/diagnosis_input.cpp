// SPDX-License-Identifier: Apache-2.0
#include "cli/diagnosis_input.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cli/recording/error.hpp"

namespace hemi::cli {
namespace {

using diagnosis::kOutputNames;
using diagnosis::kOutputs;
using diagnosis::Telemetry;
using Eigen::Index;
using Eigen::VectorXd;
constexpr double kPowerCut_s = 30.0;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// Where every row lies on the even grid of `decimation` samples a place.
struct Grid {
  std::vector<Index> place;
  Index places = 0;
};

Grid grid_of(const recording::Recording& recording, std::size_t decimation) {
  const auto& time = recording.find("time_s")->values;
  const double step = static_cast<double>(decimation) / recording.sample_rate_hz;
  Grid grid;
  for (const double t : time) {
    // Half a sample later, so that jitter does not move a row to the place before.
    const auto at = static_cast<Index>((t - time[0] + 0.5 / recording.sample_rate_hz) / step);
    grid.place.push_back(std::max<Index>(at, 0));
    grid.places = std::max(grid.places, grid.place.back() + 1);
  }
  return grid;
}

VectorXd on_grid(const std::vector<double>& values, const Grid& grid) {
  VectorXd sum = VectorXd::Zero(grid.places), count = VectorXd::Zero(grid.places);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isnan(values[i])) {
      sum[grid.place[i]] += values[i];
      count[grid.place[i]] += 1.0;
    }
  return (count.array() > 0.0).select(sum.array() / count.array().max(1.0), kNothing);
}

// Slope at x[at], rows in units of one, of the parabola through up to `count` rows on one side of it; nothing
// where too few are there.
std::optional<double> end_slope(const VectorXd& x, Index at, Index count, int side) {
  std::vector<double> offset, value;
  for (Index k = 0; k < count && at + side * k >= 0 && at + side * k < x.size(); ++k)
    if (!std::isnan(x[at + side * k])) {
      offset.push_back(static_cast<double>(side * k));
      value.push_back(x[at + side * k]);
    }
  constexpr std::size_t kLeast = 8;
  if (offset.size() < kLeast) return std::nullopt;
  const Eigen::Map<const VectorXd> t(offset.data(), static_cast<Index>(offset.size()));
  const Eigen::Map<const VectorXd> y(value.data(), t.size());
  Eigen::MatrixXd powers(t.size(), 3);
  powers << VectorXd::Ones(t.size()), t, t.cwiseAbs2();
  return powers.colPivHouseholderQr().solve(y)[1];
}

// Between two rows by a cubic with the slopes that the thermometer has on both sides; by a straight line, a
// chamber that turns in a pause of 25 minutes would be missed by degrees.
void bridge(VectorXd& x, Index last, Index next) {
  constexpr Index kMostMissing = 30;
  const Index rows = std::min(next - last - 1, kMostMissing);
  const double length = static_cast<double>(next - last), rise = x[next] - x[last];
  const auto before = end_slope(x, last, rows, -1), after = end_slope(x, next, rows, 1);
  const bool curved = before && after;
  const double left = curved ? *before * length - rise : 0.0, right = curved ? *after * length - rise : 0.0;
  for (Index k = last + 1; k < next; ++k) {
    const double u = static_cast<double>(k - last) / length, v = 1.0 - u;
    x[k] = x[last] + u * rise + u * v * (v * left - u * right);
  }
}

// Missing values from their neighbours on both sides, or held.
void fill(VectorXd& x, bool smooth) {
  Index last = -1;
  for (Index i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i])) continue;
    if (smooth && last >= 0 && i > last + 1) bridge(x, last, i);
    for (Index k = last + 1; k < i; ++k)
      if (std::isnan(x[k])) x[k] = last < 0 ? x[i] : x[last];
    last = i;
  }
  for (Index k = last + 1; k < x.size(); ++k) x[k] = last < 0 ? 0.0 : x[last];
}

// Rows in stretches of at least kPowerCut_s without any output.
Eigen::Array<bool, Eigen::Dynamic, 1> powered_rows(const Telemetry& t) {
  Eigen::Array<bool, Eigen::Dynamic, 1> powered =
      Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(t.rows(), true);
  const auto cut = static_cast<Index>(kPowerCut_s / t.step_s);
  Index begin = 0;
  for (Index i = 0; i <= t.rows(); ++i) {
    const bool silent = i < t.rows() && std::ranges::all_of(kOutputs, [&](diagnosis::Output output) {
                          return !t.has(output) || std::isnan(t[output][i]);
                        });
    if (silent) continue;
    if (i - begin >= std::max<Index>(cut, 1)) powered.segment(begin, i - begin) = false;
    begin = i + 1;
  }
  return powered;
}

class Reader {
 public:
  Reader(const recording::Recording& recording, const Grid& grid, DiagnosisInput& input)
      : recording_(recording), grid_(grid), input_(input) {}

  VectorXd input(const char* name, double rest, bool smooth, bool* given = nullptr) {
    const auto* channel = recording_.find(name);
    if (given != nullptr) *given = channel != nullptr;
    if (channel == nullptr) {
      input_.absent.emplace_back(name);
      return VectorXd::Constant(grid_.places, rest);
    }
    VectorXd x = on_grid(channel->values, grid_);
    if (!smooth) note_unsure(x);
    fill(x, smooth);
    return x;
  }

  // No output can be predicted where an input went from one level to another unseen.
  void drop_unsure(Telemetry& t) const {
    for (auto& output : t.outputs)
      for (const auto& [begin, end] : unsure_)
        if (output.size() > 0) output.segment(begin, end - begin).setConstant(kNothing);
  }

 private:
  void note_unsure(const VectorXd& x) {
    constexpr double kSame = 1e-3;
    Index last = -1;
    for (Index i = 0; i < x.size(); ++i) {
      if (std::isnan(x[i])) continue;
      if (last >= 0 && i > last + 1 &&
          std::abs(x[i] - x[last]) > kSame * std::max(std::abs(x[i]), std::abs(x[last])))
        unsure_.emplace_back(last + 1, i);
      last = i;
    }
  }

  std::vector<std::pair<Index, Index>> unsure_;
  const recording::Recording& recording_;
  const Grid& grid_;
  DiagnosisInput& input_;
};

// The resonator is its own thermometer: f(T) solved for T by Newton's method, from the row before.
void read_temperature_from_frequency(const recording::Recording& recording,
                                     const recording::InstrumentModel& model, DiagnosisInput& input) {
  auto& frequency = input.telemetry.outputs[place(diagnosis::Output::frequency)];
  if (frequency.size() == 0)
    throw recording::InputError({.path = recording.path},
                                "holds neither case_temp_degc nor frequency_hz, so that nothing tells the "
                                "resonator's temperature",
                                "record one of them");
  const diagnosis::Polynomial f{model.frequency->reference_degc, model.frequency->coefficients_hz};
  VectorXd hz = std::move(frequency);
  frequency.resize(0);
  fill(hz, true);
  Eigen::ArrayXd degc = Eigen::ArrayXd::Constant(1, f.reference);
  for (Index i = 0; i < hz.size(); ++i) {
    constexpr int kSteps = 20;
    for (int k = 0; k < kSteps; ++k) {
      const double step = ((hz[i] - f.at(degc)) / f.slope(degc))[0];
      if (!std::isfinite(step) || std::abs(degc[0] + step) > 1000.0)
        throw recording::InputError({.path = recording.path, .line = 0, .row = 0, .channel = "frequency_hz"},
                                    fmt::format("{} Hz is no frequency of the model's f(T)", hz[i]),
                                    "give the model of this instrument");
      degc += step;
      if (std::abs(step) < 1e-9) break;
    }
    input.telemetry.case_degc[i] = degc[0];
  }
  input.notes.emplace_back(
      "no case_temp_degc: the resonator's temperature is read from frequency_hz, which is not diagnosed "
      "itself");
}

}  // namespace

DiagnosisInput telemetry_of(const recording::Recording& recording, const recording::InstrumentModel& model,
                            std::size_t most_rows) {
  DiagnosisInput input;
  const std::size_t decimation = std::max<std::size_t>(1, (recording.rows() + most_rows - 1) / most_rows);
  if (decimation > 1)
    input.notes.push_back(fmt::format("{} rows are averaged into one for effects slower than {:.3g} s",
                                      decimation,
                                      2.0 * static_cast<double>(decimation) / recording.sample_rate_hz));
  input.averaged_rows = decimation;
  const Grid grid = grid_of(recording, decimation);
  Telemetry& t = input.telemetry;
  t.step_s = static_cast<double>(decimation) / recording.sample_rate_hz;
  Reader reader(recording, grid, input);
  t.case_degc = reader.input("case_temp_degc", 20.0, true, &t.has_case);
  t.board_degc = reader.input("board_temp_degc", 25.0, true, &t.has_board);
  t.rate_in_dph = reader.input("rate_in_dph", 0.0, false);
  t.accel_g = reader.input("accel_g", 0.0, false, &t.has_accel);
  t.supply_v = reader.input("supply_v", 1.0, false, &t.has_supply);
  t.trim_v = reader.input("quadrature_trim_v", 0.0, false);
  t.amplitude = reader.input("amplitude", model.amplitude_setpoint, false);
  for (const auto output : kOutputs) {
    const auto* channel = recording.find(kOutputNames[place(output)]);
    if (channel == nullptr)
      input.absent.emplace_back(kOutputNames[place(output)]);
    else
      t.outputs[place(output)] = on_grid(channel->values, grid);
  }
  t.powered = powered_rows(t);
  reader.drop_unsure(t);
  if (!t.has_case) read_temperature_from_frequency(recording, model, input);
  return input;
}

namespace {

[[noreturn]] void refuse_effect(const recording::InstrumentModel& model, const std::string& what) {
  throw recording::InputError({.path = model.path, .channel = "effects"}, what,
                              "take the list as hemi diagnose wrote it");
}

std::vector<double> numbers_of(const recording::InstrumentModel& model, const recording::Json& fit,
                               const char* key) {
  std::vector<double> numbers;
  const recording::Json list = fit.is_object() ? fit.value(key, recording::Json()) : recording::Json();
  if (!list.is_array()) refuse_effect(model, fmt::format("fit.{} is no list of numbers", key));
  for (const auto& value : list) {
    if (!value.is_number()) refuse_effect(model, fmt::format("fit.{} is no list of numbers", key));
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

// What the model has named already: a colour is noise, the rest is simulated. Without `fit` (events, lines)
// it is looked for anew.
void take_effects(const recording::InstrumentModel& model, diagnosis::NominalModel& nominal) {
  if (!model.effects.is_array()) return;
  for (const recording::Json& item : model.effects) {
    if (!item.is_object() || !item.contains("id") || !item["id"].is_string())
      refuse_effect(model, "an entry without an id");
    if (!item.contains("fit")) continue;
    diagnosis::GivenEffect given;
    given.effect = item["id"].get<std::string>();
    if (item.contains("equation") && item["equation"].is_string())
      given.form = item["equation"].get<std::string>();
    given.shape = numbers_of(model, item["fit"], "shape");
    given.coefficients = numbers_of(model, item["fit"], "coefficients");
    if (given.coefficients.empty()) refuse_effect(model, "fit.coefficients is empty");
    auto& colour = nominal.noise[place(diagnosis::Output::rate)];
    if (given.effect == "rate_random_walk")
      colour.walk = std::hypot(colour.walk, given.coefficients[0]);
    else if (given.effect == "rate_flicker")
      colour.flicker = std::hypot(colour.flicker, given.coefficients[0]);
    else
      nominal.effects.push_back(std::move(given));
  }
}

}  // namespace

diagnosis::NominalModel nominal_of(const recording::InstrumentModel& model,
                                   const recording::Recording& recording) {
  const auto need = [&](bool present, const char* part, const char* channel) {
    if (present || recording.find(channel) == nullptr) return;
    throw recording::InputError({.path = model.path, .channel = part},
                                fmt::format("is missing, which {} needs", channel),
                                "calibrate the instrument first, or leave the channel out");
  };
  need(model.frequency.has_value(), "frequency", "frequency_hz");
  if (recording.find("case_temp_degc") != nullptr)
    need(model.thermal_time_constant_s.has_value(), "thermal", "frequency_hz");
  need(model.bias.has_value(), "bias", "rate_dph");
  need(model.frequency.has_value(), "frequency", "rate_dph");
  need(model.drive.has_value(), "drive", "drive_v");
  need(model.quadrature.has_value(), "quadrature", "quadrature_v");
  diagnosis::NominalModel nominal;
  if (model.frequency)
    nominal.frequency_hz = {model.frequency->reference_degc, model.frequency->coefficients_hz};
  const bool has_case = recording.find("case_temp_degc") != nullptr;
  nominal.time_constant_s = has_case ? model.thermal_time_constant_s.value_or(0.0) : 0.0;
  if (model.bias) {
    nominal.bias_reference_hz = model.bias->reference_hz;
    nominal.bias_dph = model.bias->terms_dph;
  }
  nominal.scale_factor = model.scale_factor;
  if (model.drive) nominal.drive_v = {model.drive->reference_degc, model.drive->coefficients_v};
  if (model.quadrature)
    nominal.quadrature_v = {model.quadrature->reference_degc, model.quadrature->coefficients_v};
  constexpr const char* kNoiseKeys[] = {"frequency_hz_rthz", "drive_v_rthz", "quadrature_v_rthz",
                                        "rate_dph_rthz"};
  for (const auto output : kOutputs) {
    const auto found = model.noise.find(kNoiseKeys[place(output)]);
    if (found == model.noise.end()) continue;
    // One-sided density r / f of a walk: variance 2 pi^2 r^2 a second.
    nominal.noise[place(output)] = {found->second.flicker, found->second.random_walk * std::sqrt(2.0) * M_PI};
  }
  take_effects(model, nominal);
  return nominal;
}

}  // namespace hemi::cli
