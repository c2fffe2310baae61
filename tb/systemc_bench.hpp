// SPDX-License-Identifier: Apache-2.0
// The SystemC bench; see systemc_engine.hpp.
#ifndef HEMI_TB_SYSTEMC_BENCH_HPP
#define HEMI_TB_SYSTEMC_BENCH_HPP

#include <deque>
#include <random>
#include <systemc>
#include <vector>

#include "tb/registers.hpp"
#include "tb/scoreboard.hpp"
#include "tb/systemc_modules.hpp"
#include "tb/verilator_engine.hpp"

namespace hemi::tb {

/// Clock, registers and monitor around the two cores and the plant.
template <class V, class Instrument>
class Bench : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Bench);

  explicit Bench(const sc_core::sc_module_name& name)
      : sc_module(name),
        rtl_("rtl"),
        hls_("hls", wires_),
        plant_("plant", wires_),
        scoreboard_(Instrument::decimation),
        dac_scoreboard_(0) {
    wires_.bind(rtl_);
    SC_THREAD(tick);
    SC_METHOD(edge);
    sensitive << wires_.clk.posedge_event();
    dont_initialize();
  }

  /// Reset, registers, from sample 0.
  void reset(const RegisterImage& image, const RtlOptions& options) {
    generator_.seed(options.seed);
    stall_ = std::bernoulli_distribution(options.back_pressure_probability);
    plant_.reset(options.seed + 1, options.input_gap_probability);
    words_.clear();
    records_.clear();
    scoreboard_ = Scoreboard(Instrument::decimation);
    dac_scoreboard_ = Scoreboard(0);
    hls_.set_sinks(&scoreboard_.second(), &dac_scoreboard_.second());
    resetting_ = 2;
    pending_registers_.clear();
    for (int i = 0; i < config::register_count; ++i) pending_registers_.push_back({i, image[i]});
    run(Until::idle);
    plant_.open();
  }

  void feed(const std::vector<StreamItem>& items, std::vector<Record>& output) {
    for (const StreamItem& item : items) {
      if (item.telemetry) {
        // The sample goes only after its two words are in their registers: one at a time.
        run(Until::idle);
        pending_registers_.push_back({telemetry_frequency_address, item.frequency});
        pending_registers_.push_back({telemetry_rate_address, item.rate});
        run(Until::idle);
      }
      plant_.push(item);
    }
    drain(output);
  }

  /// Samples of `plant`, whose words go back to it; the records that have come by then.
  void close(PlantPort& plant, std::size_t samples, std::vector<Record>& output) {
    plant_.close(plant, samples);
    run(Until::plant_done);
    unchecked_ += samples;
    if (unchecked_ >= check_interval) check();
    hand_over(output);
  }

  void drain(std::vector<Record>& output) {
    run(Until::idle);
    check();
    hand_over(output);
  }

  void set_taps(TapSink* sink) { sink_ = sink; }

 private:
  static constexpr double half_period_ns = 5.0;
  static constexpr int quiet_clocks = 4;               ///< idle clocks after which nothing more will come
  static constexpr std::size_t check_interval = 1000;  ///< samples; what is not compared takes memory
  enum class Until { idle, plant_done };

  void check() {
    unchecked_ = 0;
    for (Scoreboard* scoreboard : {&scoreboard_, &dac_scoreboard_}) {
      scoreboard->compare();
      if (scoreboard->mismatch())
        throw std::runtime_error("SystemC bench: " + scoreboard->mismatch()->report("rtl", "hls"));
    }
  }

  void hand_over(std::vector<Record>& output) {
    output.insert(output.end(), records_.begin(), records_.end());
    records_.clear();
  }

  void run(Until until) {
    until_ = until;
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
    wires_.record_ready.write(!stall_(generator_));
    const bool idle = resetting_ == 0 && pending_registers_.empty() && !wires_.register_valid.read() &&
                      plant_.empty() && !wires_.busy.read();
    idle_clocks_ = idle ? idle_clocks_ + 1 : 0;
    if (idle_clocks_ >= quiet_clocks || (until_ == Until::plant_done && !plant_.closing())) running_ = false;
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

  void take_outputs() {
    if (wires_.tap_valid.read()) {
      const auto index = static_cast<config::TapIndex>(wires_.tap.read());
      const std::int64_t word = signed_word(wires_.tap_value.read(), word_bits);
      scoreboard_.first().tap(index, word);
      if (sink_ != nullptr) sink_->tap(index, word);
    }
    if (wires_.dac_valid.read()) send_dac_words(dac_scoreboard_.first(), dac_words(wires_));
    if (!wires_.record_valid.read() || !wires_.record_ready.read()) return;
    words_.push_back(signed_word(wires_.record_word.read(), word_bits));
    if (!wires_.record_last.read()) return;
    if (words_.size() != config::record_words)
      throw std::logic_error("SystemC bench: a record of the wrong length");
    records_.push_back(to_record(words_));
    words_.clear();
  }

  static constexpr std::uint64_t word_mask = (std::uint64_t{1} << word_bits) - 1;
  struct RegisterWrite {
    int address;
    std::int64_t word;
  };

  BenchWires<V> wires_;
  V rtl_;
  HlsModule<Instrument, BenchWires<V>> hls_;
  PlantModule<Instrument, BenchWires<V>> plant_;
  Scoreboard scoreboard_;
  Scoreboard dac_scoreboard_;  ///< words at the DAC ports, counted in samples
  std::deque<RegisterWrite> pending_registers_;
  std::vector<std::int64_t> words_;
  std::vector<Record> records_;
  std::mt19937_64 generator_;
  std::bernoulli_distribution stall_;
  TapSink* sink_ = nullptr;
  sc_core::sc_event enable_;
  bool running_ = false;
  Until until_ = Until::idle;
  std::size_t unchecked_ = 0;  ///< samples since the last check
  int resetting_ = 0;
  int idle_clocks_ = 0;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_SYSTEMC_BENCH_HPP
