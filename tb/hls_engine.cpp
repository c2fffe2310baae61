// SPDX-License-Identifier: Apache-2.0
#include "tb/hls_engine.hpp"

#include "hls/core.hpp"
#include "tb/registers.hpp"

namespace hemi::tb {
namespace {

struct SinkProbe {
  TapSink* sink;
  template <class T>
  void operator()(config::TapIndex index, const T& value) {
    sink->tap(index, hls::raw(value));
  }
};

template <class Instrument>
class HlsEngine : public Engine {
 public:
  std::string name() const override { return "hls"; }

  void reset(const RegisterValues& values) override {
    const RegisterImage image = to_image(values);
    std::int64_t words[config::register_count];
    for (int i = 0; i < config::register_count; ++i) words[i] = image[i];
    core_.reset(words);
  }

  void samples(std::span<const SamplePair> input, std::vector<Record>& output) override {
    if (sink_ == nullptr) {
      hls::NoProbe probe;
      run(input, output, probe);
    } else {
      SinkProbe probe{sink_};
      run(input, output, probe);
    }
  }

  DacWords step(const SamplePair& sample, std::vector<Record>& output) override {
    if (sink_ == nullptr) {
      hls::NoProbe probe;
      run({&sample, 1}, output, probe);
    } else {
      SinkProbe probe{sink_};
      run({&sample, 1}, output, probe);
    }
    return {core_.dac_drive(), core_.dac_rebalance(), core_.dac_quadrature()};
  }

  void telemetry(double frequency_hz, double rate_dph, bool valid, std::vector<Record>& output) override {
    const std::int64_t frequency = to_raw(frequency_hz, config::frequency, "frequency_hz");
    const std::int64_t rate = to_raw(rate_dph, config::rate, "rate_dph");
    hls::Record record;
    if (sink_ == nullptr) {
      hls::NoProbe probe;
      core_.telemetry(frequency, rate, valid, record, probe);
    } else {
      SinkProbe probe{sink_};
      core_.telemetry(frequency, rate, valid, record, probe);
    }
    output.push_back(to_record(record.word));
  }

  void set_taps(TapSink* sink) override { sink_ = sink; }

 private:
  template <class Probe>
  void run(std::span<const SamplePair> input, std::vector<Record>& output, Probe& probe) {
    hls::Record record;
    for (const SamplePair& pair : input) {
      if (core_.sample(pair.x, pair.y, pair.gap, record, probe)) output.push_back(to_record(record.word));
    }
  }

  hls::Core<Instrument> core_;
  TapSink* sink_ = nullptr;
};

}  // namespace

std::unique_ptr<Engine> make_hls_engine(bool wide) {
  if (wide) return std::make_unique<HlsEngine<config::Wide>>();
  return std::make_unique<HlsEngine<config::Reference>>();
}

}  // namespace hemi::tb
