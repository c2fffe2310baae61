// SPDX-License-Identifier: Apache-2.0
#include "cli/drift_data.hpp"

#include <fmt/format.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cli/engines.hpp"
#include "cli/recording/error.hpp"

namespace hemi::cli {
namespace {

using calibration::RowRange;

/// The rows of `ranges`, one after another.
Eigen::VectorXd gather(const Eigen::VectorXd& v, const std::vector<RowRange>& ranges) {
  Eigen::VectorXd out(calibration::total_rows(ranges));
  Eigen::Index at = 0;
  for (const RowRange& r : ranges) {
    out.segment(at, r.count) = v.segment(r.begin, r.count);
    at += r.count;
  }
  return out;
}

/// Ranges of `training` cut at the ends of the recording's own segments.
std::vector<RowRange> intersect(const std::vector<RowRange>& training,
                                const std::vector<RowRange>& segments) {
  std::vector<RowRange> out;
  for (const RowRange& t : training) {
    for (const RowRange& s : segments) {
      const Eigen::Index begin = std::max(t.begin, s.begin);
      const Eigen::Index end = std::min(t.begin + t.count, s.begin + s.count);
      if (end > begin) out.push_back({begin, end - begin});
    }
  }
  return out;
}

Eigen::VectorXd vector_of(const std::vector<double>& v) {
  return Eigen::VectorXd::Map(v.data(), static_cast<Eigen::Index>(v.size()));
}

/// Outputs by which df/dt is late: (16 M - 1) / 2 by its blocks, (M - 1) / 2 on average by holding its value.
double derivative_lag(const Setup& setup) {
  const double block = std::ldexp(1.0, static_cast<int>(setup.values[config::reg_log2_block]));
  const double lag = 0.5 * (config::derivative_blocks * block - 1.0) + 0.5 * (block - 1.0);
  return lag;
}

/// False within two rows of a jump of the turntable, where the rate output's own delay shows, and where the
/// applied rate is missing.
std::vector<bool> steady_rows(const std::vector<double>& applied) {
  constexpr std::ptrdiff_t apart = 2;
  double largest = 0.0;
  for (const double a : applied)
    if (!std::isnan(a)) largest = std::max(largest, std::abs(a));
  const double jump = std::max(1.0, 1e-3 * largest);
  const auto rows = static_cast<std::ptrdiff_t>(applied.size());
  std::vector<bool> steady(applied.size(), true);
  for (std::ptrdiff_t i = 0; i < rows; ++i) {
    const double here = applied[static_cast<std::size_t>(i)];
    if (std::isnan(here)) steady[static_cast<std::size_t>(i)] = false;
    if (i == 0 || !(std::abs(here - applied[static_cast<std::size_t>(i - 1)]) > jump)) continue;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, i - apart); k < std::min(rows, i + apart); ++k)
      steady[static_cast<std::size_t>(k)] = false;
  }
  return steady;
}

}  // namespace

void DriftData::apply_scale(double scale_factor) {
  samples.rate_dph = raw_rate_dph - scale_factor * applied_dph;
}

DriftData drift_data(const recording::Recording& recording, const recording::InstrumentModel& model,
                     double from_s, double to_s, std::optional<double> window_s) {
  const Setup setup = telemetry_setup(recording.sample_rate_hz, model, window_s);
  const TelemetryInput input = telemetry_input(recording, model);
  const auto engine = make_engine("ideal", false);
  engine->reset(setup.values);
  const auto records = run_telemetry(*engine, input, setup);
  const auto applied = recording.or_zero("rate_in_dph");
  const std::vector<bool> steady = steady_rows(applied);
  const double lag = derivative_lag(setup);
  const auto earlier = static_cast<std::size_t>(std::floor(lag));
  const auto later = static_cast<std::size_t>(std::ceil(lag));
  const auto derived = [&](std::size_t i) {
    const auto status = static_cast<std::uint64_t>(records[i].words[config::word_status]);
    return ((status >> config::status_derivative_invalid) & 1) == 0;
  };
  const auto slope_at = [&](std::size_t i) {
    return records[i].words[config::word_derivative] * derivative_full_scale_hz_per_s;
  };
  DriftData data;
  data.notes = input.notes;
  data.derivative_window_s = setup.derivative_window_s;
  data.lag_s = lag * setup.output_period_s;
  data.interval_s = setup.output_period_s;
  std::vector<double> time, frequency, slope, core_slope, rate, turned;
  bool open = false;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool usable = i + later < records.size() && derived(i) && derived(i + earlier) &&
                        derived(i + later) && input.rate_valid[i] && input.frequency_valid[i] &&
                        input.time_s[i] >= from_s && input.time_s[i] <= to_s && steady[i];
    if (!usable) {
      open = false;
      continue;
    }
    if (!open) data.samples.segments.push_back({static_cast<Eigen::Index>(time.size()), 0});
    open = true;
    ++data.samples.segments.back().count;
    time.push_back(input.time_s[i]);
    frequency.push_back(input.frequency_hz[i]);
    slope.push_back(0.5 * (slope_at(i + earlier) + slope_at(i + later)));
    core_slope.push_back(slope_at(i));
    rate.push_back(input.rate_dph[i]);
    turned.push_back(applied[i]);
  }
  if (time.size() < 40) {
    throw recording::InputError({recording.path},
                                fmt::format("{} usable rows between {} s and {} s; a drift model needs 40",
                                            time.size(), from_s, to_s),
                                "record longer, widen --from and --to, or shorten --window");
  }
  data.time_s = vector_of(time);
  data.samples.frequency_hz = vector_of(frequency);
  data.samples.slope_hz_per_s = vector_of(slope);
  data.core_slope_hz_per_s = vector_of(core_slope);
  data.raw_rate_dph = vector_of(rate);
  data.applied_dph = vector_of(turned);
  data.apply_scale(model.scale_factor);
  return data;
}

DriftData join(const std::vector<DriftData>& parts, const std::vector<std::string>& paths) {
  DriftData all = parts.front();
  const auto append = [](Eigen::VectorXd& to, const Eigen::VectorXd& from) {
    const Eigen::Index size = to.size();
    to.conservativeResize(size + from.size());
    to.tail(from.size()) = from;
  };
  for (std::size_t p = 1; p < parts.size(); ++p) {
    const DriftData& part = parts[p];
    if (std::abs(part.interval_s / all.interval_s - 1.0) > 0.01) {
      throw recording::InputError({paths[p]},
                                  fmt::format("a row every {:.4g} s, where {} has one every {:.4g} s",
                                              part.interval_s, paths.front(), all.interval_s),
                                  "bring all recordings to one sample rate");
    }
    const Eigen::Index rows = all.time_s.size();
    for (const RowRange& range : part.samples.segments)
      all.samples.segments.push_back({rows + range.begin, range.count});
    append(all.time_s, part.time_s);
    append(all.samples.frequency_hz, part.samples.frequency_hz);
    append(all.samples.slope_hz_per_s, part.samples.slope_hz_per_s);
    append(all.samples.rate_dph, part.samples.rate_dph);
    append(all.core_slope_hz_per_s, part.core_slope_hz_per_s);
    append(all.raw_rate_dph, part.raw_rate_dph);
    append(all.applied_dph, part.applied_dph);
    for (const auto& note : part.notes)
      if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end()) all.notes.push_back(note);
  }
  return all;
}

DriftScores score_drift(const DriftData& data, double reference_hz, int blocks) {
  const auto& all = data.samples;
  const auto stepwise = [&](const std::vector<RowRange>& training) -> calibration::RowPredictor {
    calibration::DriftSamples part = all;
    part.segments = intersect(training, all.segments);
    const auto fit = calibration::fit_bias(part, reference_hz);
    return [fit, &all](Eigen::Index row) {
      return fit.predict_dph(all.frequency_hz[row], all.slope_hz_per_s[row]);
    };
  };
  const auto cubic = [&](const std::vector<RowRange>& training) -> calibration::RowPredictor {
    const auto design = [&](const Eigen::VectorXd& f) {
      const Eigen::ArrayXd x = (f.array() - reference_hz) / 16.0;
      Eigen::MatrixXd m(f.size(), 4);
      m << Eigen::VectorXd::Ones(f.size()), x.matrix(), (x * x).matrix(), (x * x * x).matrix();
      return m;
    };
    const Eigen::VectorXd c = design(gather(all.frequency_hz, training))
                                  .colPivHouseholderQr()
                                  .solve(gather(all.rate_dph, training));
    const Eigen::VectorXd predicted = design(all.frequency_hz) * c;
    return [predicted](Eigen::Index row) { return predicted[row]; };
  };
  return {calibration::score_blocks(all.rate_dph, blocks, stepwise),
          calibration::score_blocks(all.rate_dph, blocks, cubic)};
}

}  // namespace hemi::cli
