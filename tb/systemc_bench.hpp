// SPDX-License-Identifier: Apache-2.0
// Modules of the SystemC bench; see systemc_engine.hpp.
#ifndef HEMI_TB_SYSTEMC_BENCH_HPP
#define HEMI_TB_SYSTEMC_BENCH_HPP

#include <deque>
#include <random>
#include <systemc>
#include <vector>

#include "hls/core.hpp"
#include "rtl/address_map.hpp"
#include "tb/registers.hpp"
#include "tb/scoreboard.hpp"
#include "tb/verilator_engine.hpp"

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

  void bind(V& rtl) {
    rtl.clk_i(clk);
    rtl.rst_ni(rst_n);
    rtl.sample_valid_i(sample_valid);
    rtl.sample_ready_o(sample_ready);
    rtl.sample_x_i(sample_x);
    rtl.sample_y_i(sample_y);
    rtl.sample_gap_i(sample_gap);
    rtl.sample_telemetry_i(sample_telemetry);
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

  void set_taps(TapSink* sink) { probe_.sink = sink; }

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
    }
  }

  const Wires& wires_;
  hls::Core<Instrument> core_;
  std::array<std::int64_t, 256> words_{};
  Probe probe_;
  bool started_ = false;
};

/// Clock, driver and monitor around the two cores.
template <class V, class Instrument>
class Bench : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Bench);

  explicit Bench(const sc_core::sc_module_name& name)
      : sc_module(name), rtl_("rtl"), hls_("hls", wires_), scoreboard_(Instrument::decimation) {
    wires_.bind(rtl_);
    SC_THREAD(tick);
    SC_METHOD(edge);
    sensitive << wires_.clk.posedge_event();
    dont_initialize();
  }

  /// Reset, registers, from sample 0.
  void reset(const RegisterImage& image, const RtlOptions& options) {
    generator_.seed(options.seed);
    gap_ = std::bernoulli_distribution(options.input_gap_probability);
    stall_ = std::bernoulli_distribution(options.back_pressure_probability);
    stream_.clear();
    words_.clear();
    scoreboard_ = Scoreboard(Instrument::decimation);
    hls_.set_taps(&scoreboard_.second());
    resetting_ = 2;
    pending_registers_.clear();
    for (int i = 0; i < config::register_count; ++i) pending_registers_.push_back({i, image[i]});
    run();
  }

  void feed(const std::vector<StreamItem>& items, std::vector<Record>& output) {
    for (const StreamItem& item : items) {
      if (item.telemetry) {
        // The sample goes only after its two words are in their registers: one at a time.
        run();
        pending_registers_.push_back({telemetry_frequency_address, item.frequency});
        pending_registers_.push_back({telemetry_rate_address, item.rate});
        run();
      }
      stream_.push_back(item);
    }
    run();
    output.insert(output.end(), records_.begin(), records_.end());
    records_.clear();
    scoreboard_.compare();
    if (scoreboard_.mismatch())
      throw std::runtime_error("SystemC bench: " + scoreboard_.mismatch()->report("rtl", "hls"));
  }

  void set_taps(TapSink* sink) { sink_ = sink; }

 private:
  static constexpr double half_period_ns = 5.0;
  static constexpr int quiet_clocks = 4;  ///< idle clocks after which nothing more will come

  void run() {
    idle_clocks_ = 0;
    enable_.notify(sc_core::SC_ZERO_TIME);
    running_ = true;
    while (running_) sc_core::sc_start(200 * half_period_ns, sc_core::SC_NS);
  }

  void tick() {
    const sc_core::sc_time half(half_period_ns, sc_core::SC_NS);
    for (;;) {
      while (!running_) wait(enable_);
      wires_.clk.write(true);
      wait(half);
      wires_.clk.write(false);
      wait(half);
    }
  }

  void edge() {
    take_outputs();
    drive_reset();
    drive_registers();
    drive_samples();
    wires_.record_ready.write(!stall_(generator_));
    const bool idle = resetting_ == 0 && pending_registers_.empty() && !wires_.register_valid.read() &&
                      stream_.empty() && !wires_.sample_valid.read() && !wires_.busy.read();
    idle_clocks_ = idle ? idle_clocks_ + 1 : 0;
    if (idle_clocks_ >= quiet_clocks) running_ = false;
  }

  void drive_reset() {
    wires_.rst_n.write(resetting_ == 0);
    if (resetting_ > 0) --resetting_;
  }

  void drive_registers() {
    if (wires_.register_valid.read() && wires_.register_ready.read()) pending_registers_.pop_front();
    const bool more = resetting_ == 0 && !pending_registers_.empty();
    wires_.register_valid.write(more);
    if (!more) return;
    wires_.register_address.write(static_cast<std::uint32_t>(pending_registers_.front().address));
    wires_.register_data.write(static_cast<std::uint64_t>(pending_registers_.front().word) & word_mask);
  }

  void drive_samples() {
    const bool taken = wires_.sample_valid.read() && wires_.sample_ready.read();
    if (taken) stream_.pop_front();
    const bool held = wires_.sample_valid.read() && !taken;
    const bool offer =
        held || (resetting_ == 0 && pending_registers_.empty() && !stream_.empty() && !gap_(generator_));
    wires_.sample_valid.write(offer);
    if (!offer) return;
    const StreamItem& item = stream_.front();
    wires_.sample_x.write(static_cast<std::uint32_t>(item.pair.x) & adc_mask);
    wires_.sample_y.write(static_cast<std::uint32_t>(item.pair.y) & adc_mask);
    wires_.sample_gap.write(item.pair.gap);
    wires_.sample_telemetry.write(item.telemetry);
  }

  void take_outputs() {
    if (wires_.tap_valid.read()) {
      const auto index = static_cast<config::TapIndex>(wires_.tap.read());
      const std::int64_t word = signed_word(wires_.tap_value.read(), word_bits);
      scoreboard_.first().tap(index, word);
      if (sink_ != nullptr) sink_->tap(index, word);
    }
    if (!wires_.record_valid.read() || !wires_.record_ready.read()) return;
    words_.push_back(signed_word(wires_.record_word.read(), word_bits));
    if (!wires_.record_last.read()) return;
    if (words_.size() != config::record_words)
      throw std::logic_error("SystemC bench: a record of the wrong length");
    records_.push_back(to_record(words_));
    words_.clear();
  }

  static constexpr std::uint64_t word_mask = (std::uint64_t{1} << word_bits) - 1;
  static constexpr std::uint32_t adc_mask = (std::uint32_t{1} << Instrument::adc_bits) - 1;
  struct RegisterWrite {
    int address;
    std::int64_t word;
  };

  BenchWires<V> wires_;
  std::deque<StreamItem> stream_;
  V rtl_;
  HlsModule<Instrument, BenchWires<V>> hls_;
  Scoreboard scoreboard_;
  std::deque<RegisterWrite> pending_registers_;
  std::vector<std::int64_t> words_;
  std::vector<Record> records_;
  std::mt19937_64 generator_;
  std::bernoulli_distribution gap_, stall_;
  TapSink* sink_ = nullptr;
  sc_core::sc_event enable_;
  bool running_ = false;
  int resetting_ = 0;
  int idle_clocks_ = 0;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_SYSTEMC_BENCH_HPP
