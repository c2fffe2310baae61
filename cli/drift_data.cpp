// SPDX-License-Identifier: Apache-2.0
#include "cli/drift_data.hpp"

#include <fmt/format.h>

#include <Eigen/QR>

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

}  // namespace

DriftData drift_data(const recording::Recording& recording, const recording::InstrumentModel& model,
                     double from_s, double to_s, std::optional<double> window_s) {
  const Setup setup = telemetry_setup(recording.sample_rate_hz, model, window_s);
  const TelemetryInput input = telemetry_input(recording, model);
  const auto engine = make_engine("ideal", false);
  engine->reset(setup.values);
  const auto records = run_telemetry(*engine, input, setup);
  const auto applied = recording.or_zero("rate_in_dph");
  DriftData data;
  data.notes = input.notes;
  data.derivative_window_s = setup.derivative_window_s;
  std::vector<double> time, frequency, slope, rate;
  bool open = false;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const auto status = static_cast<std::uint64_t>(records[i].words[config::word_status]);
    const bool usable = ((status >> config::status_derivative_invalid) & 1) == 0 && input.rate_valid[i] &&
                        input.frequency_valid[i] && input.time_s[i] >= from_s && input.time_s[i] <= to_s &&
                        !std::isnan(applied[i]);
    if (!usable) {
      open = false;
      continue;
    }
    if (!open) data.samples.segments.push_back({static_cast<Eigen::Index>(time.size()), 0});
    open = true;
    ++data.samples.segments.back().count;
    time.push_back(input.time_s[i]);
    frequency.push_back(input.frequency_hz[i]);
    slope.push_back(records[i].words[config::word_derivative] * derivative_full_scale_hz_per_s);
    rate.push_back(input.rate_dph[i] - model.scale_factor * applied[i]);
  }
  if (time.size() < 40) {
    throw recording::InputError({recording.path},
                                fmt::format("{} usable rows between {} s and {} s; a drift model needs 40",
                                            time.size(), from_s, to_s),
                                "record longer, widen --from and --to, or shorten --window");
  }
  const auto take = [](const std::vector<double>& v) {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())).eval();
  };
  data.time_s = take(time);
  data.samples.frequency_hz = take(frequency);
  data.samples.slope_hz_per_s = take(slope);
  data.samples.rate_dph = take(rate);
  return data;
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
