// SPDX-License-Identifier: Apache-2.0
#include "tb/systemc_engine.hpp"

#include <algorithm>
#include <stdexcept>

#include "VHemiScReference.h"
#include "VHemiScWide.h"
#include "tb/systemc_bench.hpp"

namespace hemi::tb {
namespace {

/// SystemC elaborates once: both benches are made before the first clock runs.
struct Simulation {
  Bench<VHemiScReference, config::Reference> reference{"reference"};
  Bench<VHemiScWide, config::Wide> wide{"wide"};
};

Simulation& simulation() {
  // Never destroyed: SystemC's own context goes at exit, before or after ours would. The models take
  // Verilator's context of the moment, which must outlive them and is not that of an rtl engine.
  static Simulation& the_one = [&]() -> Simulation& {
    Verilated::threadContextp(new VerilatedContext);
    return *new Simulation;
  }();
  return the_one;
}

/// One sample, and its words.
class OneSample : public PlantPort {
 public:
  explicit OneSample(const SamplePair& sample) : sample_(sample) {}
  SamplePair sample() override { return sample_; }
  void act(const DacWords& words) override { words_ = words; }
  const DacWords& words() const { return words_; }

 private:
  SamplePair sample_;
  DacWords words_;
};

template <class BenchType>
class BenchEngine : public SystemcEngine {
 public:
  BenchEngine(BenchType& bench, const RtlOptions& options) : bench_(bench), options_(options) {}
  std::string name() const override { return "systemc"; }

  void reset(const RegisterValues& values) override { bench_.reset(to_image(values), options_); }

  void samples(std::span<const SamplePair> input, std::vector<Record>& output) override {
    std::vector<StreamItem> items(input.size());
    for (std::size_t i = 0; i < input.size(); ++i) items[i].pair = input[i];
    bench_.feed(items, output);
  }

  DacWords step(const SamplePair& sample, std::vector<Record>& output) override {
    OneSample plant(sample);
    bench_.close(plant, 1, output);
    return plant.words();
  }

  void drain(std::vector<Record>& output) override { bench_.drain(output); }

  void closed_loop(PlantPort& plant, std::size_t samples, std::vector<Record>& output) override {
    constexpr std::size_t chunk = 1000;
    for (std::size_t at = 0; at < samples; at += chunk)
      bench_.close(plant, std::min(chunk, samples - at), output);
    bench_.drain(output);
  }

  void telemetry(double frequency_hz, double rate_dph, bool valid, std::vector<Record>& output) override {
    StreamItem item;
    item.pair.gap = !valid;
    item.telemetry = true;
    item.frequency = to_raw(frequency_hz, config::frequency, "frequency_hz");
    item.rate = to_raw(rate_dph, config::rate, "rate_dph");
    bench_.feed({item}, output);
  }

  void set_taps(TapSink* sink) override { bench_.set_taps(sink); }

 private:
  BenchType& bench_;
  RtlOptions options_;
};

}  // namespace

std::unique_ptr<SystemcEngine> make_systemc_engine(bool wide, const RtlOptions& options) {
  if (!options.waves.empty())
    throw std::invalid_argument("the SystemC bench leaves no waves; the rtl engine does");
  if (wide) return std::make_unique<BenchEngine<decltype(Simulation::wide)>>(simulation().wide, options);
  return std::make_unique<BenchEngine<decltype(Simulation::reference)>>(simulation().reference, options);
}

}  // namespace hemi::tb
