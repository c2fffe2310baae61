// SPDX-License-Identifier: Apache-2.0
#include "tb/golden_engine.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "tb/registers.hpp"

namespace hemi::tb {
namespace {

class GoldenEngine : public Engine, private golden::TapListener {
 public:
  GoldenEngine(bool wide, golden::Precision precision)
      : instrument_(wide ? golden::InstrumentParameters::wide() : golden::InstrumentParameters::reference()),
        precision_(precision) {}

  std::string name() const override { return quantised() ? "golden" : "ideal"; }

  void reset(const RegisterValues& values) override {
    RegisterValues used = values;
    if (quantised()) {
      const RegisterImage image = to_image(values);
      for (int i = 0; i < config::register_count; ++i)
        used[i] = to_value(image[i], config::registers[i].format);
    }
    chain_.emplace(precision_, instrument_, used);
    set_taps(sink_);
  }

  void samples(std::span<const SamplePair> input, std::vector<Record>& output) override {
    const auto n = static_cast<Eigen::Index>(input.size());
    Eigen::VectorXd x(n), y(n);
    std::vector<std::uint8_t> gap(input.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const SamplePair& pair = input[static_cast<std::size_t>(i)];
      x[i] = pair.x;
      y[i] = pair.y;
      gap[static_cast<std::size_t>(i)] = pair.gap ? 1 : 0;
    }
    std::vector<golden::ChainRecord> records;
    chain_->samples(x, y, &gap, records);
    for (const auto& record : records) output.push_back({record.words});
  }

  DacWords step(const SamplePair& sample, std::vector<Record>& output) override {
    step_records_.clear();
    const golden::DacWords words = chain_->step(sample.x, sample.y, sample.gap, step_records_);
    for (const auto& record : step_records_) output.push_back({record.words});
    return {dac_word(words.drive), dac_word(words.rebalance), dac_word(words.quadrature)};
  }

  void telemetry(double frequency_hz, double rate_dph, bool valid, std::vector<Record>& output) override {
    std::vector<golden::ChainRecord> records;
    if (quantised()) {
      frequency_hz = to_value(to_raw(frequency_hz, config::frequency, "frequency_hz"), config::frequency);
      rate_dph = to_value(to_raw(rate_dph, config::rate, "rate_dph"), config::rate);
    }
    chain_->telemetry(frequency_hz, rate_dph, valid, records);
    for (const auto& record : records) output.push_back({record.words});
  }

  void set_taps(TapSink* sink) override {
    sink_ = sink;
    if (chain_) chain_->set_taps(sink != nullptr && quantised() ? this : nullptr);
  }

 private:
  bool quantised() const { return precision_ == golden::Precision::quantised; }

  /// Nearest raw word: the word itself when quantised; the ideal chain leaves this rounding to the DAC.
  static std::int32_t dac_word(double value) {
    const long limit = 1L << (config::dac.width - 1);
    return static_cast<std::int32_t>(
        std::clamp(std::lround(std::ldexp(value, config::dac.fraction)), -limit, limit - 1));
  }

  void tap(config::TapIndex index, double value) override {
    sink_->tap(index, static_cast<std::int64_t>(std::ldexp(value, config::taps[index].format.fraction)));
  }

  golden::InstrumentParameters instrument_;
  golden::Precision precision_;
  std::optional<golden::Chain> chain_;
  TapSink* sink_ = nullptr;
  std::vector<golden::ChainRecord> step_records_;
};

}  // namespace

std::unique_ptr<Engine> make_golden_engine(bool wide, golden::Precision precision) {
  return std::make_unique<GoldenEngine>(wide, precision);
}

}  // namespace hemi::tb
