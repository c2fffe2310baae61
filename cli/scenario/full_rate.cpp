// SPDX-License-Identifier: Apache-2.0
// The whole instrument, sample by sample: plant, converters, core.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "cli/engines.hpp"
#include "cli/output.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/progress.hpp"
#include "cli/scenario/control.hpp"
#include "cli/scenario/instrument_fields.hpp"
#include "cli/scenario/run.hpp"
#include "cli/settings.hpp"
#include "golden/physics/noise.hpp"
#include "golden/physics/plant.hpp"
#include "tb/closed_loop.hpp"
#include "tb/registers.hpp"

namespace hemi::scenario {
namespace {

using physics::TelemetrySample;

constexpr double kTicksAveraged = 2.0 * config::ticks_per_output;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kThermometerStream = 77;

bool live(const tb::Record& record, config::StatusBit bit) {
  return (static_cast<std::uint64_t>(record.words[config::word_status]) >> bit & 1) != 0;
}

/// Registers of thermometer and bias model from the nominal model, of the loops from theory.
cli::Setup setup_of(const Scenario& scenario) {
  recording::RawCapture capture;
  capture.path = scenario.path;
  const cli::Sampling sampling = cli::sampling(scenario.wide);
  capture.sample_rate_hz = sampling.adc_rate_hz;
  capture.full_scale_lsb = std::ldexp(1.0, sampling.adc_bits - 1);
  const recording::InstrumentModel model = scenario.nominal_model();
  cli::Setup setup = cli::capture_setup(capture, &model, std::nullopt, std::nullopt);
  loops::set_control(setup.values, scenario.instrument, core_sampling(scenario), control_wishes(scenario));
  try {
    tb::to_image(setup.values);
  } catch (const tb::FormatError& error) {
    refuse({scenario.path, "instrument", 0}, error.what(),
           "change the instrument's full scales or the loops");
  }
  return setup;
}

/// Plant and core in closed loop, one output of the core at a time.
class Bench {
 public:
  explicit Bench(const Scenario& scenario)
      : scenario_(scenario),
        setup_(setup_of(scenario)),
        samples_an_output_(static_cast<std::size_t>(cli::sampling(scenario.wide).decimation) *
                           config::ticks_per_output),
        world_(std::make_shared<physics::World>(scenario.instrument, scenario.effects,
                                                scenario.inputs.at(0.0), scenario.seed)),
        plant_(scenario.noise ? scenario.instrument : without_noise(scenario.instrument),
               physics::follow(world_, [this](double time_s) { return scenario_.inputs.at(time_s); }),
               plant_configuration()),
        engine_(cli::make_engine(scenario.engine, scenario.wide)) {
    engine_->reset(setup_.values);
    if (!scenario.raw) return;
    raw_.emplace();
    raw_->device = scenario.device;
    raw_->sample_rate_hz = cli::sampling(scenario.wide).adc_rate_hz;
    raw_->full_scale_lsb = std::ldexp(1.0, cli::sampling(scenario.wide).adc_bits - 1);
  }

  void run();
  const std::vector<tb::Record>& records() const { return records_; }
  /// Temperatures at the start of each output interval, which is 0.8 ms after what its record describes.
  const std::vector<physics::Temperatures>& temperatures() const { return temperatures_; }
  const cli::Setup& setup() const { return setup_; }
  physics::World& world() { return *world_; }
  std::optional<recording::RawCapture> take_raw() { return std::move(raw_); }

 private:
  physics::PlantConfiguration plant_configuration() const {
    physics::PlantConfiguration configuration;
    configuration.adc =
        scenario_.wide ? physics::AdcConfiguration::wide() : physics::AdcConfiguration::reference();
    configuration.start.x_amplitude = scenario_.vibration.amplitude;
    configuration.start.x_phase_rad = scenario_.vibration.phase_deg * std::numbers::pi / 180.0;
    configuration.seed = scenario_.seed;
    return configuration;
  }

  const Scenario& scenario_;
  cli::Setup setup_;
  std::size_t samples_an_output_;
  std::shared_ptr<physics::World> world_;
  physics::Plant plant_;
  std::unique_ptr<tb::Engine> engine_;
  std::vector<tb::Record> records_;
  std::vector<physics::Temperatures> temperatures_;
  std::optional<recording::RawCapture> raw_;
};

void Bench::run() {
  const double adc_rate_hz = cli::sampling(scenario_.wide).adc_rate_hz;
  const auto outputs =
      static_cast<std::size_t>(std::floor(scenario_.duration_s / setup_.output_period_s * (1.0 + 1e-12)));
  const double raw_from = raw_ ? std::round(scenario_.raw->from_s * adc_rate_hz) : 0.0;
  const double raw_to = raw_ ? std::round(scenario_.raw->to_s * adc_rate_hz) : 0.0;
  double sample = 0.0;
  const auto keep = [&](const tb::SamplePair& pair) {
    if (sample >= raw_from && sample < raw_to) {
      raw_->adc_x.push_back(pair.x);
      raw_->adc_y.push_back(pair.y);
    }
    sample += 1.0;
  };
  recording::Progress progress("simulating", static_cast<double>(outputs));
  for (std::size_t i = 0; i < outputs; ++i) {
    recording::check_interrupt();
    progress.update(static_cast<double>(i));
    temperatures_.push_back(world_->conditions().temperatures);
    if (raw_)
      tb::close_loop(*engine_, plant_, samples_an_output_, records_, keep);
    else
      tb::close_loop(*engine_, plant_, samples_an_output_, records_);
  }
  engine_->drain(records_);
}

/// One record in the units of a recording; what does not hold yet is missing.
TelemetrySample sample_of(const tb::Record& record, double time_s, const Scenario& scenario,
                          const loops::ControlDesign& design) {
  const bool counted = !live(record, config::status_frequency_invalid) &&
                       !live(record, config::status_unlocked) && !live(record, config::status_holdover);
  const bool closed = counted && !live(record, config::status_starting);
  const auto& w = record.words;
  const physics::Environment inputs = scenario.inputs.at(time_s);
  TelemetrySample sample;
  sample.time_s = time_s;
  sample.rate_in_dph = inputs.rate_dph;
  sample.accel_g = inputs.accel_g;
  sample.supply_v = inputs.supply_v;
  sample.frequency_hz = counted ? w[config::word_frequency] : kNone;
  sample.amplitude = w[config::word_amplitude] / kTicksAveraged / design.amplitude_word;
  // The voltage that acts: a held word passes this much of the carrier.
  sample.drive_v =
      w[config::word_drive] / kTicksAveraged * scenario.instrument.drive_full_scale_v * design.hold_gain;
  // A positive voltage cancels a positive split: the command is its negative.
  sample.quadrature_v =
      -w[config::word_quadrature] / kTicksAveraged * scenario.instrument.quadrature_full_scale_v;
  sample.rate_dph = closed ? w[config::word_rate] : kNone;
  return sample;
}

/// Mean of the same member over rows [from, from + n).
template <class Row>
double mean(const std::vector<Row>& rows, std::size_t from, std::size_t n, double Row::*member) {
  double sum = 0.0;
  for (std::size_t i = from; i < from + n; ++i) sum += rows[i].*member;
  return sum / static_cast<double>(n);
}

TelemetrySample average(const std::vector<TelemetrySample>& rows, std::size_t from, std::size_t n) {
  TelemetrySample sample;
  for (const auto member :
       {&TelemetrySample::time_s, &TelemetrySample::case_temp_degc, &TelemetrySample::board_temp_degc,
        &TelemetrySample::rate_in_dph, &TelemetrySample::accel_g, &TelemetrySample::supply_v,
        &TelemetrySample::frequency_hz, &TelemetrySample::amplitude, &TelemetrySample::drive_v,
        &TelemetrySample::quadrature_v, &TelemetrySample::rate_dph})
    sample.*member = n == 1 ? rows[from].*member : mean(rows, from, n, member);
  return sample;
}

/// What the case's thermometer adds: noise, then its step.
void read_case(std::vector<TelemetrySample>& telemetry, const Scenario& scenario) {
  if (!scenario.noise) return;
  physics::Gaussian gaussian(scenario.seed, kThermometerStream);
  const double step_degc = scenario.instrument.case_thermometer_step_degc;
  for (TelemetrySample& sample : telemetry) {
    sample.case_temp_degc += scenario.instrument.case_thermometer_noise_degc * gaussian();
    if (step_degc > 0.0) sample.case_temp_degc = step_degc * std::round(sample.case_temp_degc / step_degc);
  }
}

/// The core's own words: means of temperature and compensated rate, all status bits of the interval.
void add_core_words(Simulated& simulated, const Bench& bench, std::size_t from, std::size_t n) {
  double degc = 0.0, rate_dph = 0.0;
  std::uint64_t status = 0;
  for (std::size_t m = from; m < from + n; ++m) {
    const tb::Record& record = bench.records()[m];
    const bool starting = live(record, config::status_frequency_invalid) ||
                          live(record, config::status_unlocked) || live(record, config::status_starting);
    degc += starting ? kNone : record.words[config::word_temperature];
    rate_dph += starting ? kNone : record.words[config::word_compensated];
    status |= static_cast<std::uint64_t>(record.words[config::word_status]);
  }
  simulated.temperature_degc.push_back(degc / static_cast<double>(n));
  simulated.compensated_rate_dph.push_back(rate_dph / static_cast<double>(n));
  simulated.status.push_back(static_cast<double>(status));
}

}  // namespace

Simulated simulate_full(const Scenario& scenario) {
  Bench bench(scenario);
  bench.run();
  const loops::ControlDesign design =
      loops::design_control(scenario.instrument, core_sampling(scenario), control_wishes(scenario));
  std::vector<TelemetrySample> outputs;
  for (std::size_t m = 0; m < bench.records().size(); ++m) {
    outputs.push_back(sample_of(bench.records()[m], cli::output_time_s(m, bench.setup()), scenario, design));
    outputs.back().case_temp_degc = bench.temperatures()[m].case_degc;
    outputs.back().board_temp_degc = bench.temperatures()[m].board_degc;
  }
  Simulated simulated;
  const auto n = static_cast<std::size_t>(
      std::lround(1.0 / (bench.setup().output_period_s * scenario.telemetry_rate_hz)));
  // The first output describes a time before the start.
  for (std::size_t from = 1; from + n <= outputs.size(); from += n) {
    simulated.telemetry.push_back(average(outputs, from, n));
    add_core_words(simulated, bench, from, n);
  }
  read_case(simulated.telemetry, scenario);
  const std::size_t rows = simulated.telemetry.size();
  bench.world().distort(simulated.telemetry);
  if (simulated.telemetry.size() != rows) {
    simulated.temperature_degc.clear();
    simulated.compensated_rate_dph.clear();
    simulated.status.clear();
    simulated.notes.push_back(fmt::format("{} rows were lost on the way; the core's own words are left out",
                                          rows - std::min(rows, simulated.telemetry.size())));
  }
  simulated.raw = bench.take_raw();
  return simulated;
}

}  // namespace hemi::scenario
