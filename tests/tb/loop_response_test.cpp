// SPDX-License-Identifier: Apache-2.0
// The four loops closed around the plant: frequency response and phase margin against linear theory, and the
// rate's linearity.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <complex>
#include <functional>
#include <map>

#include "tb/hls_engine.hpp"
#include "tests/tb/control_bench.hpp"

namespace {

using namespace hemi;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kUpdate_s = 2e-4;

struct OneTap : tb::TapSink {
  config::TapIndex wanted;
  std::vector<double> values;
  explicit OneTap(config::TapIndex index) : wanted(index) {}
  void tap(config::TapIndex index, std::int64_t raw) override {
    if (index == wanted)
      values.push_back(std::ldexp(static_cast<double>(raw), -config::taps[index].format.fraction));
  }
};

/// One loop's experiment: a multisine enters where the command acts, the command answers.
struct Experiment {
  config::TapIndex command;
  double settle_s;
  double measure_s;
  double level;  ///< of each line, in commands
  double sign;   ///< command over disturbance at low frequency
  double
      act_samples;  ///< from a tick's last sample to the mean instant at which its command acts, less 1.5 R
  std::function<void(physics::Parameters&, double command, const physics::Instrument&)> disturb;
};

/// T(f) at each of the frequencies.
std::vector<std::complex<double>> measure(const Experiment& e, const std::vector<double>& frequencies_hz) {
  const physics::Instrument instrument;
  const auto nominal = instrument.at(20.0);
  const auto disturbance = [&](double t) {
    double sum = 0.0;
    for (std::size_t i = 0; i < frequencies_hz.size(); ++i)
      sum += e.level * std::sin(kTurn * frequencies_hz[i] * t + static_cast<double>(i * i));
    return sum;
  };
  // Parameters hold for one update: their middle counts.
  auto source = [&](double t, double) {
    physics::Parameters p = nominal;
    e.disturb(p, disturbance(t + 0.5 * kUpdate_s), instrument);
    return p;
  };
  physics::PlantConfiguration configuration;
  configuration.start = {1.0, 0.3, 0.0, 0.0};
  configuration.seed = 7;
  configuration.update_s = kUpdate_s;
  physics::Plant plant(instrument, source, configuration);
  const auto engine = tb::make_hls_engine(false);
  engine->reset(tests::control_registers(instrument, false));
  OneTap tap(e.command);
  std::vector<tb::Record> records;
  const double fs = config::Reference::adc_rate_hz, r = config::Reference::decimation;
  tb::close_loop(*engine, plant, static_cast<std::size_t>(e.settle_s * fs), records);
  engine->set_taps(&tap);
  tb::close_loop(*engine, plant, static_cast<std::size_t>(e.measure_s * fs), records);

  const auto n = static_cast<Eigen::Index>(tap.values.size());
  const auto lines = static_cast<Eigen::Index>(frequencies_hz.size());
  Eigen::MatrixXd basis(n, 2 * lines + 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double t = e.settle_s + (static_cast<double>(k + 1) * r - 1.0) / fs;  // the tick's last sample
    const double u = 2.0 * static_cast<double>(k) / static_cast<double>(n) - 1.0;
    basis.row(k).tail(3) << 1.0, u, u * u;
    for (Eigen::Index i = 0; i < lines; ++i) {
      const double phase =
          kTurn * frequencies_hz[static_cast<std::size_t>(i)] * t + static_cast<double>(i * i);
      basis(k, 2 * i) = std::sin(phase);
      basis(k, 2 * i + 1) = std::cos(phase);
    }
  }
  const Eigen::VectorXd fit =
      basis.colPivHouseholderQr().solve(Eigen::Map<const Eigen::VectorXd>(tap.values.data(), n));
  std::vector<std::complex<double>> closed;
  for (Eigen::Index i = 0; i < lines; ++i) {
    const double f = frequencies_hz[static_cast<std::size_t>(i)];
    // From the word to the command as it acts: later, and held for a tick.
    const std::complex<double> act =
        std::polar(std::sin(std::numbers::pi * f * r / fs) / (r * std::sin(std::numbers::pi * f / fs)),
                   -kTurn * f * (1.5 * r + e.act_samples) / fs);
    closed.push_back(e.sign / e.level * std::complex<double>(fit[2 * i], fit[2 * i + 1]) * act);
  }
  return closed;
}

std::map<std::string, Experiment> experiments() {
  return {
      {"reference_phase",
       {config::tap_loop_increment, 3.0, 4.0, 2e-8, 1.0, 1.0,
        [](physics::Parameters& p, double increment, const physics::Instrument&) {
          p.omega_rad_s += kTurn * increment * config::Reference::adc_rate_hz;
        }}},
      {"amplitude",
       {config::tap_drive, 12.0, 40.0, 0.02, 1.0, 3.0,
        [](physics::Parameters& p, double command, const physics::Instrument&) {
          p.damping_per_s += command * p.drive_per_s;
        }}},
      {"quadrature",
       {config::tap_quadrature, 12.0, 20.0, 0.01, -1.0, 3.0,
        [](physics::Parameters& p, double command, const physics::Instrument&) {
          p.split_sin_rad_s += command * p.quadrature_span_rad_s;
        }}},
      {"rebalance",
       {config::tap_rebalance, 3.0, 2.0, 0.05, 1.0, 3.0,
        [](physics::Parameters& p, double command, const physics::Instrument&) {
          p.rate_rad_s += command * p.rebalance_per_s / p.kappa;
        }}},
  };
}

loops::Loop theory(const std::string& name) {
  const auto design = loops::design_control({}, loops::CoreSampling::reference());
  if (name == "reference_phase") return design.reference_phase;
  if (name == "amplitude") return design.amplitude;
  return name == "quadrature" ? design.quadrature : design.rebalance;
}

class LoopResponse : public testing::TestWithParam<std::string> {};

TEST_P(LoopResponse, BandwidthAndMarginAreThoseOfLinearTheory) {
  const Experiment e = experiments().at(GetParam());
  const loops::Loop loop = theory(GetParam());
  const double crossover = loop.crossover_hz(), bandwidth = loop.bandwidth_hz();
  std::vector<double> f;
  for (const double wanted : {0.9 * crossover, 1.1 * crossover, 0.96 * bandwidth, 1.04 * bandwidth})
    f.push_back(std::round(wanted * e.measure_s) / e.measure_s);
  const auto t = measure(e, f);
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_LT(std::abs(t[i] - loop.closed(f[i])), 0.02)
        << f[i] << " Hz: " << t[i] << " theory " << loop.closed(f[i]);
  }
  // |T| falls through 1/sqrt(2) between the outer two lines; straight in logarithms.
  const auto through = [](double f0, double g0, double f1, double g1, double g) {
    return f0 * std::pow(f1 / f0, std::log(g / g0) / std::log(g1 / g0));
  };
  const double measured_bandwidth =
      through(f[2], std::abs(t[2]), f[3], std::abs(t[3]), std::numbers::sqrt2 / 2.0);
  const std::complex<double> l0 = t[0] / (1.0 - t[0]), l1 = t[1] / (1.0 - t[1]);
  const double measured_crossover = through(f[0], std::abs(l0), f[1], std::abs(l1), 1.0);
  const double share = std::log(measured_crossover / f[0]) / std::log(f[1] / f[0]);
  const double measured_margin =
      180.0 + ((1.0 - share) * std::arg(l0) + share * std::arg(l1)) * 360.0 / kTurn;
  EXPECT_NEAR(measured_bandwidth, bandwidth, 0.05 * bandwidth);
  EXPECT_NEAR(measured_margin, loop.phase_margin_deg(), 0.05 * loop.phase_margin_deg());
  EXPECT_GE(measured_margin, 60.0);
  RecordProperty("bandwidth_hz", std::to_string(measured_bandwidth));
  RecordProperty("margin_deg", std::to_string(measured_margin));
  std::printf("%s: -3 dB at %.4f Hz (theory %.4f), margin %.2f degrees (theory %.2f)\n", GetParam().c_str(),
              measured_bandwidth, bandwidth, measured_margin, loop.phase_margin_deg());
}

INSTANTIATE_TEST_SUITE_P(Loops, LoopResponse,
                         testing::Values("reference_phase", "amplitude", "quadrature", "rebalance"),
                         [](const auto& param_info) { return param_info.param; });

TEST(Rebalance, FollowsAStepOfAHundredDegreesASecondWithoutLosingLock) {
  const physics::Instrument instrument;
  double rate_dps = 0.0;
  tests::ControlBench bench(tb::make_hls_engine(false), instrument, false, {1.0, 2.0, 0.0, 0.0}, 5,
                            tests::turning(instrument, rate_dps));
  bench.run(5.0);
  for (const double step : {100.0, -100.0, 0.0}) {
    rate_dps = step;
    const auto readings = bench.run(1.0);
    for (const auto& r : readings) EXPECT_EQ(r.live, 0u);
    for (std::size_t i = 100; i < readings.size(); ++i) EXPECT_NEAR(readings[i].rate_dph / 3600.0, step, 0.3);
  }
}

TEST(Rebalance, ScaleFactorIsLinearWithinOneMillionth) {
  // Residuals of a straight line through the means at eleven rates, over 100 deg/s. Pickoff noise dithers the
  // converters; it is differenced in the rate and its mean falls with the time averaged: the two halves of
  // each mean show what is left. A step of rate shakes the amplitude, whose loop has a tail of 4 s; the scale
  // factor goes with the amplitude.
  physics::Instrument instrument;
  instrument.force_noise_dph_rthz = 0.0;
  double rate_dps = 0.0;
  tests::ControlBench bench(tb::make_hls_engine(false), instrument, false, {1.0, 2.0, 0.0, 0.0}, 1,
                            tests::turning(instrument, rate_dps));
  bench.run(25.0);
  Eigen::MatrixXd basis(11, 2);
  Eigen::VectorXd mean_dps(11);
  double repeat_dps = 0.0;
  for (int i = 0; i < 11; ++i) {
    rate_dps = 20.0 * (i - 5);
    bench.run(30.0);
    double half_dps[2];
    for (double& half : half_dps) {
      const auto readings = bench.run(5.0);
      double sum = 0.0;
      for (const auto& r : readings) sum += r.rate_dph / 3600.0;
      half = sum / static_cast<double>(readings.size());
    }
    mean_dps[i] = 0.5 * (half_dps[0] + half_dps[1]);
    repeat_dps = std::max(repeat_dps, 0.5 * std::abs(half_dps[0] - half_dps[1]));
    basis.row(i) << 1.0, rate_dps;
  }
  const Eigen::VectorXd line = basis.colPivHouseholderQr().solve(mean_dps);
  const Eigen::VectorXd residual_dps = mean_dps - basis * line;
  for (int i = 0; i < 11; ++i) std::printf("%+4.0f deg/s: %+.3f ppm\n", basis(i, 1), residual_dps[i] * 1e4);
  std::printf("linearity %.3f ppm of 100 deg/s, halves differ by %.3f ppm, slope %.9f, offset %.3f deg/h\n",
              residual_dps.cwiseAbs().maxCoeff() * 1e4, repeat_dps * 1e4, line[1], line[0] * 3600.0);
  EXPECT_LE(residual_dps.cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
