// SPDX-License-Identifier: Apache-2.0
// Golden model, fixed-point core and RTL (under Verilator and in SystemC), each with a plant of its own from
// the same seed: if one bit differed, the plants would part for good. Start-up, a rate step and a temperature
// ramp over ten seconds of instrument time.
#include <gtest/gtest.h>

#include "tb/golden_engine.hpp"
#include "tb/hls_engine.hpp"
#include "tb/systemc_engine.hpp"
#include "tb/verilator_engine.hpp"
#include "tests/tb/control_bench.hpp"

namespace {

using namespace hemi;

/// Room temperature falling by 1.2 degC a minute; +70 deg/s from 5 s on, -35 from 8 s.
physics::ParameterSource journey(const physics::Instrument& instrument) {
  return [&instrument](double t, double) {
    physics::Parameters p = instrument.at(20.0 - 0.02 * t);
    p.rate_rad_s = (t < 5.0 ? 0.0 : t < 8.0 ? 70.0 : -35.0) * std::numbers::pi / 180.0;
    return p;
  };
}

struct Outcome {
  std::vector<tb::DacWords> words;
  std::vector<tb::Record> records;
};

physics::PlantConfiguration plant_configuration(bool wide) {
  physics::PlantConfiguration configuration;
  configuration.adc = wide ? physics::AdcConfiguration::wide() : physics::AdcConfiguration::reference();
  configuration.start = {0.15, 0.7, 0.03, 2.0};
  configuration.seed = 20;
  return configuration;
}

Outcome outcome(tb::Engine& engine, bool wide, double seconds) {
  const physics::Instrument instrument;
  physics::Plant plant(instrument, journey(instrument), plant_configuration(wide));
  engine.reset(tests::control_registers(instrument, wide));
  Outcome result;
  const auto keep = [&](const tb::SamplePair&, const tb::DacWords& words) { result.words.push_back(words); };
  tb::close_loop(engine, plant, static_cast<std::size_t>(seconds * tests::sampling(wide).adc_rate_hz),
                 result.records, tb::Untouched{}, keep);
  engine.drain(result.records);
  return result;
}

void expect_same(const Outcome& a, const Outcome& b) {
  ASSERT_EQ(a.words.size(), b.words.size());
  const auto first = std::mismatch(a.words.begin(), a.words.end(), b.words.begin()).first;
  EXPECT_EQ(first - a.words.begin(), static_cast<std::ptrdiff_t>(a.words.size()))
      << "first sample whose DAC words differ";
  EXPECT_EQ(a.records, b.records);
}

class ClosedLoop : public testing::TestWithParam<bool> {
 protected:
  /// Of instrument time.
  double seconds() const { return 10.0; }
};

TEST_P(ClosedLoop, GoldenHlsAndRtlAgreeBitForBit) {
  const bool wide = GetParam();
  const auto hls = tb::make_hls_engine(wide);
  const Outcome reference = outcome(*hls, wide, seconds());
  // It did what it is meant to do: all loops closed, the steps followed.
  const auto design = loops::design_control({}, tests::sampling(wide));
  const auto at = [&](double t) {
    return tests::reading(reference.records[static_cast<std::size_t>(t * config::output_rate_hz)],
                          design.amplitude_word);
  };
  EXPECT_TRUE(tests::raised(at(0.5), config::status_starting));
  EXPECT_EQ(at(4.9).live, 0u);
  EXPECT_NEAR(at(7.9).rate_dph / 3600.0, 70.0, 1.0);
  EXPECT_NEAR(at(9.9).rate_dph / 3600.0, -35.0, 1.0);
  EXPECT_LT(at(9.9).frequency_hz, at(4.9).frequency_hz - 0.02);
  const auto golden = tb::make_golden_engine(wide, golden::Precision::quantised);
  expect_same(reference, outcome(*golden, wide, seconds()));
  const auto rtl = tb::make_rtl_engine(wide, {});
  expect_same(reference, outcome(*rtl, wide, seconds()));
}

/// The plant as the SystemC bench's module takes it; keeps the words.
class PlantModulePort : public tb::PlantPort {
 public:
  PlantModulePort(const physics::Instrument& instrument, bool wide)
      : plant_(instrument, journey(instrument), plant_configuration(wide)) {}
  tb::SamplePair sample() override {
    const physics::AdcPair adc = plant_.sample();
    return {adc.x, adc.y, false};
  }
  void act(const tb::DacWords& words) override {
    words_.push_back(words);
    plant_.act({static_cast<std::int16_t>(words.drive), static_cast<std::int16_t>(words.rebalance),
                static_cast<std::int16_t>(words.quadrature)});
  }
  const std::vector<tb::DacWords>& words() const { return words_; }

 private:
  physics::Plant plant_;
  std::vector<tb::DacWords> words_;
};

TEST_P(ClosedLoop, RtlInSystemCWithThePlantAsAModuleAgreesBitForBit) {
  const bool wide = GetParam();
  const auto hls = tb::make_hls_engine(wide);
  const Outcome reference = outcome(*hls, wide, seconds());
  // The RTL and the hls core run in lock step beside each other; their scoreboard throws at the first
  // difference.
  const physics::Instrument instrument;
  PlantModulePort port(instrument, wide);
  tb::RtlOptions options;
  options.input_gap_probability = 0.1;
  options.back_pressure_probability = 0.3;
  const auto engine = tb::make_systemc_engine(wide, options);
  engine->reset(tests::control_registers(instrument, wide));
  Outcome systemc;
  engine->closed_loop(port, reference.words.size(), systemc.records);
  systemc.words = port.words();
  expect_same(reference, systemc);
}

INSTANTIATE_TEST_SUITE_P(Both, ClosedLoop, testing::Bool(),
                         [](const auto& param_info) { return param_info.param ? "Wide" : "Reference"; });

}  // namespace
