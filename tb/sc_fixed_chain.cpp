// SPDX-License-Identifier: Apache-2.0
#include "tb/sc_fixed_chain.hpp"

#define HEMI_FIXED_BACKEND 3
// The same templates with another Fixed are other types: they need a namespace of their own in this program.
#define hls hls_on_sc_fixed
#include "hls/core.hpp"
#undef hls
#include "tb/registers.hpp"

namespace hemi::tb {
namespace {

class ScFixedEngine : public Engine {
 public:
  std::string name() const override { return "sc_fixed"; }

  void reset(const RegisterValues& values) override {
    const RegisterImage image = to_image(values);
    std::int64_t words[config::register_count];
    for (int i = 0; i < config::register_count; ++i) words[i] = image[i];
    core_.reset(words);
  }

  void samples(std::span<const SamplePair> input, std::vector<Record>& output) override {
    hls_on_sc_fixed::Record record;
    hls_on_sc_fixed::NoProbe probe;
    for (const SamplePair& pair : input) {
      if (core_.sample(pair.x, pair.y, pair.gap, record, probe)) output.push_back(to_record(record.word));
    }
  }

  DacWords step(const SamplePair& sample, std::vector<Record>& output) override {
    samples({&sample, 1}, output);
    return {core_.dac_drive(), core_.dac_rebalance(), core_.dac_quadrature()};
  }

  void telemetry(double frequency_hz, double rate_dph, bool valid, std::vector<Record>& output) override {
    hls_on_sc_fixed::Record record;
    hls_on_sc_fixed::NoProbe probe;
    core_.telemetry(to_raw(frequency_hz, config::frequency, "frequency_hz"),
                    to_raw(rate_dph, config::rate, "rate_dph"), valid, record, probe);
    output.push_back(to_record(record.word));
  }

  void set_taps(TapSink*) override {}

 private:
  hls_on_sc_fixed::Core<config::Reference> core_;
};

}  // namespace

std::unique_ptr<Engine> make_sc_fixed_engine() {
  return std::make_unique<ScFixedEngine>();
}

}  // namespace hemi::tb
