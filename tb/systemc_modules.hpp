// SPDX-License-Identifier: Apache-2.0
// Modules of the SystemC bench around the RTL: wires, hls core, plant.
#ifndef HEMI_TB_SYSTEMC_MODULES_HPP
#define HEMI_TB_SYSTEMC_MODULES_HPP

#include <array>
#include <deque>
#include <random>
#include <systemc>

#include "hls/core.hpp"
#include "rtl/address_map.hpp"
#include "tb/engine.hpp"
#include "tb/plant_port.hpp"

namespace hemi::tb {

/// Of the RTL's words; the parity register is as wide as they are.
constexpr int word_bits = config::registers[config::reg_parity].format.width;

/// What goes over the sample stream.
struct StreamItem {
  SamplePair pair;
  bool telemetry = false;
  std::int64_t frequency = 0;  ///< raw words of a telemetry sample
  std::int64_t rate = 0;
};

/// Signals between the modules: the RTL's ports.
template <class V>
struct BenchWires {
  sc_core::sc_signal<bool> clk, rst_n, sample_valid, sample_ready, sample_gap, sample_telemetry;
  sc_core::sc_signal<std::uint32_t> sample_x, sample_y;
  sc_core::sc_signal<bool> record_valid, record_ready, record_last;
  sc_core::sc_signal<std::uint64_t> record_word;
  sc_core::sc_signal<std::uint32_t> record_index;
  sc_core::sc_signal<bool> register_valid, register_ready;
  sc_core::sc_signal<std::uint32_t> register_address;
  sc_core::sc_signal<std::uint64_t> register_data;
  sc_core::sc_signal<bool> tap_valid, busy;
  sc_core::sc_signal<std::uint32_t> tap;
  sc_core::sc_signal<std::uint64_t> tap_value;
  sc_core::sc_signal<bool> dac_valid;
  sc_core::sc_signal<std::uint32_t> dac_drive, dac_rebalance, dac_quadrature;

  void bind(V& rtl) {
    rtl.clk_i(clk);
    rtl.rst_ni(rst_n);
    rtl.sample_valid_i(sample_valid);
    rtl.sample_ready_o(sample_ready);
    rtl.sample_x_i(sample_x);
    rtl.sample_y_i(sample_y);
    rtl.sample_gap_i(sample_gap);
    rtl.sample_telemetry_i(sample_telemetry);
    rtl.dac_valid_o(dac_valid);
    rtl.dac_drive_o(dac_drive);
    rtl.dac_rebalance_o(dac_rebalance);
    rtl.dac_quadrature_o(dac_quadrature);
    rtl.record_valid_o(record_valid);
    rtl.record_ready_i(record_ready);
    rtl.record_word_o(record_word);
    rtl.record_index_o(record_index);
    rtl.record_last_o(record_last);
    rtl.register_valid_i(register_valid);
    rtl.register_ready_o(register_ready);
    rtl.register_address_i(register_address);
    rtl.register_data_i(register_data);
    rtl.tap_valid_o(tap_valid);
    rtl.tap_o(tap);
    rtl.tap_value_o(tap_value);
    rtl.busy_o(busy);
  }
};

/// Sign-extends a word of `width` bits from a port.
inline std::int64_t signed_word(std::uint64_t bits, int width) {
  return static_cast<std::int64_t>(bits << (64 - width)) >> (64 - width);
}

/// What the DACs get.
template <class Wires>
DacWords dac_words(const Wires& wires) {
  const auto word = [](std::uint32_t bits) {
    return static_cast<std::int32_t>(signed_word(bits, config::dac.width));
  };
  return {word(wires.dac_drive.read()), word(wires.dac_rebalance.read()), word(wires.dac_quadrature.read())};
}

/// Sends the words of one sample to a scoreboard that counts them in samples.
inline void send_dac_words(TapSink& sink, const DacWords& words) {
  sink.tap(config::tap_dac_drive, words.drive);
  sink.tap(config::tap_dac_rebalance, words.rebalance);
  sink.tap(config::tap_dac_quadrature, words.quadrature);
}

/// The hls core as a SystemC module: takes from the same wires what the RTL takes, on the same edge;
/// registers too.
template <class Instrument, class Wires>
class HlsModule : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(HlsModule);

  HlsModule(const sc_core::sc_module_name& name, const Wires& wires) : sc_module(name), wires_(wires) {
    SC_METHOD(edge);
    sensitive << wires.clk.posedge_event();
    dont_initialize();
  }

  /// Where the blocks' outputs and the DAC words go.
  void set_sinks(TapSink* taps, TapSink* dac) {
    probe_.sink = taps;
    dac_ = dac;
  }

 private:
  struct Probe {
    TapSink* sink = nullptr;
    template <class T>
    void operator()(config::TapIndex index, const T& value) {
      sink->tap(index, hls::raw(value));
    }
  };

  void edge() {
    if (!wires_.rst_n.read()) started_ = false;
    if (wires_.register_valid.read() && wires_.register_ready.read()) {
      words_[wires_.register_address.read()] = signed_word(wires_.register_data.read(), word_bits);
    }
    if (wires_.sample_valid.read() && wires_.sample_ready.read()) take();
  }

  void take() {
    if (!started_) {
      std::int64_t image[config::register_count];
      for (int i = 0; i < config::register_count; ++i) image[i] = words_[i];
      core_.reset(image);
      started_ = true;
    }
    hls::Record record;
    const bool gap = wires_.sample_gap.read();
    if (wires_.sample_telemetry.read()) {
      core_.telemetry(words_[telemetry_frequency_address], words_[telemetry_rate_address], !gap, record,
                      probe_);
    } else {
      const auto adc = [](std::uint32_t bits) {
        return static_cast<std::int32_t>(signed_word(bits, Instrument::adc_bits));
      };
      core_.sample(adc(wires_.sample_x.read()), adc(wires_.sample_y.read()), gap, record, probe_);
      send_dac_words(*dac_, {core_.dac_drive(), core_.dac_rebalance(), core_.dac_quadrature()});
    }
  }

  const Wires& wires_;
  hls::Core<Instrument> core_;
  std::array<std::int64_t, 256> words_{};
  Probe probe_;
  TapSink* dac_ = nullptr;
  bool started_ = false;
};

/// What stands in front of the ADCs and behind the DACs: recorded samples, or a plant that answers to each
/// sample's words before it gives the next. Random gaps between the samples.
template <class Instrument, class Wires>
class PlantModule : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(PlantModule);

  PlantModule(const sc_core::sc_module_name& name, Wires& wires) : sc_module(name), wires_(wires) {
    SC_METHOD(edge);
    sensitive << wires.clk.posedge_event();
    dont_initialize();
  }

  void reset(std::uint64_t seed, double gap_probability) {
    generator_.seed(seed);
    gap_ = std::bernoulli_distribution(gap_probability);
    stream_.clear();
    plant_ = nullptr;
    left_ = 0;
    acts_ = false;
    open_ = false;
  }

  /// Nothing is offered until the registers are there.
  void open() { open_ = true; }
  void push(const StreamItem& item) { stream_.push_back(item); }
  /// The next `samples` samples come from `plant`.
  void close(PlantPort& plant, std::size_t samples) {
    plant_ = &plant;
    left_ = samples;
  }
  bool empty() const { return stream_.empty() && !wires_.sample_valid.read() && !closing(); }
  /// The plant has not given its last sample, or has not heard what became of it.
  bool closing() const { return left_ > 0 || acts_; }

 private:
  void edge() {
    if (acts_ && wires_.dac_valid.read()) {
      plant_->act(dac_words(wires_));
      acts_ = false;
    }
    if (left_ > 0 && !acts_ && open_) {
      stream_.push_back({plant_->sample()});
      --left_;
      acts_ = true;
    }
    const bool taken = wires_.sample_valid.read() && wires_.sample_ready.read();
    if (taken) stream_.pop_front();
    const bool held = wires_.sample_valid.read() && !taken;
    const bool offer = held || (open_ && !stream_.empty() && !gap_(generator_));
    wires_.sample_valid.write(offer);
    if (!offer) return;
    const StreamItem& item = stream_.front();
    wires_.sample_x.write(static_cast<std::uint32_t>(item.pair.x) & adc_mask);
    wires_.sample_y.write(static_cast<std::uint32_t>(item.pair.y) & adc_mask);
    wires_.sample_gap.write(item.pair.gap);
    wires_.sample_telemetry.write(item.telemetry);
  }

  static constexpr std::uint32_t adc_mask = (std::uint32_t{1} << Instrument::adc_bits) - 1;

  Wires& wires_;
  std::deque<StreamItem> stream_;
  PlantPort* plant_ = nullptr;
  std::size_t left_ = 0;
  bool acts_ = false;  ///< the plant waits for the words of its last sample
  bool open_ = false;
  std::mt19937_64 generator_;
  std::bernoulli_distribution gap_;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_SYSTEMC_MODULES_HPP
