// SPDX-License-Identifier: Apache-2.0
#include "tb/verilator_engine.hpp"

#include <verilated.h>
#include <verilated_fst_c.h>

#include <random>
#include <stdexcept>

#include "Vhemi_reference.h"
#include "Vhemi_reference_checked.h"
#include "Vhemi_wide.h"
#include "Vhemi_wide_checked.h"
#include "rtl/address_map.hpp"
#include "tb/registers.hpp"

namespace hemi::tb {
namespace {

constexpr int word_bits = 54;
constexpr std::uint64_t word_mask = (std::uint64_t{1} << word_bits) - 1;

std::int64_t extend(std::uint64_t word) {
  return static_cast<std::int64_t>(word << (64 - word_bits)) >> (64 - word_bits);
}

std::int32_t dac_word(std::uint16_t bits) {
  static_assert(config::dac.width == 16, "a DAC word fills its port");
  return static_cast<std::int16_t>(bits);
}

/// Model: a verilated hemi_core; Checked: with hazard checks, checks of the DAC port and able to write waves.
template <class Model, bool Checked>
class RtlEngine : public Engine {
 public:
  explicit RtlEngine(const RtlOptions& options) : options_(options), random_(options.seed) {
    if constexpr (Checked) {
      if (!options_.waves.empty()) {
        context_.traceEverOn(true);
        model_.trace(&trace_, 99);
        trace_.open(options_.waves.c_str());
        if (!trace_.isOpen()) throw std::runtime_error("cannot write " + options_.waves.string());
      }
    }
  }

  RtlEngine(const RtlEngine&) = delete;
  RtlEngine& operator=(const RtlEngine&) = delete;

  ~RtlEngine() override {
    if constexpr (Checked) {
      if (trace_.isOpen()) trace_.close();
    }
    model_.final();
  }

  std::string name() const override { return "rtl"; }

  void reset(const RegisterValues& values) override {
    const RegisterImage image = to_image(values);
    model_.sample_valid_i = 0;
    model_.register_valid_i = 0;
    model_.rst_ni = 0;
    offered_ = strobes_ = 0;
    dac_ = {};
    for (int i = 0; i < reset_clocks; ++i) clock();
    model_.rst_ni = 1;
    next_offer_ = clocks_;
    records_.clear();
    for (int i = 0; i < config::register_count; ++i) write_register(i, image[i]);
  }

  void samples(std::span<const SamplePair> input, std::vector<Record>& output) override {
    for (const SamplePair& pair : input) offer(pair);
    drain(output);
  }

  DacWords step(const SamplePair& sample, std::vector<Record>& output) override {
    // Words of samples() that are still on their way belong to samples before this one.
    wait_for([this] { return strobes_ == offered_; });
    offer(sample);
    wait_for([this] { return strobes_ == offered_; });
    if constexpr (Checked) check_time();
    hand_over(output);
    return dac_;
  }

  void drain(std::vector<Record>& output) override {
    wait_for([this] { return model_.busy_o == 0; });
    if (strobes_ != offered_) throw std::runtime_error("rtl: not one strobe of DAC words a sample");
    hand_over(output);
  }

  void telemetry(double frequency_hz, double rate_dph, bool valid, std::vector<Record>& output) override {
    write_register(telemetry_frequency_address, to_raw(frequency_hz, config::frequency, "frequency_hz"));
    write_register(telemetry_rate_address, to_raw(rate_dph, config::rate, "rate_dph"));
    model_.sample_telemetry_i = 1;
    model_.sample_gap_i = !valid;
    offer();
    drain(output);
  }

  void set_taps(TapSink* sink) override { sink_ = sink; }

 private:
  static constexpr int reset_clocks = 8;
  /// No state of the machine lasts longer unless it waits for the bench.
  static constexpr int patience = 100000;

  static constexpr std::uint32_t adc_mask() {
    return (std::uint32_t{1} << (sizeof(Model::sample_x_i) == 2 ? config::Reference::adc_bits
                                                                : config::Wide::adc_bits)) -
           1;
  }

  bool happens(double probability) {
    return probability > 0 && std::bernoulli_distribution(probability)(random_);
  }

  void edge(bool level) {
    model_.clk_i = level;
    model_.eval();
    if constexpr (Checked) {
      if (trace_.isOpen()) trace_.dump(context_.time());
      context_.timeInc(1);
      if (context_.gotFinish()) throw std::runtime_error("rtl: a check of hemi_hazard_checks failed");
    }
  }

  /// One clock; what the core offers before its edge is taken at the edge.
  void clock() {
    model_.record_ready_i = !happens(options_.back_pressure_probability);
    if (sink_ != nullptr && model_.tap_valid_o) {
      sink_->tap(static_cast<config::TapIndex>(model_.tap_o), extend(model_.tap_value_o));
    }
    if (model_.record_ready_i && model_.record_valid_o) take_word();
    edge(true);
    edge(false);
    ++clocks_;
    if constexpr (Checked) check_dac();
    if (model_.dac_valid_o) take_dac_words();
  }

  DacWords dac_ports() const {
    return {dac_word(model_.dac_drive_o), dac_word(model_.dac_rebalance_o),
            dac_word(model_.dac_quadrature_o)};
  }

  void take_dac_words() {
    ++strobes_;
    dac_ = dac_ports();
  }

  /// Without a strobe nothing moves, and no sample has two.
  void check_dac() const {
    if (model_.dac_valid_o ? strobes_ == offered_ : dac_ports() != dac_)
      throw std::runtime_error("rtl: DAC words without a sample");
  }

  void take_word() {
    const int index = model_.record_index_o;
    record_.words[index] = to_value(extend(model_.record_word_o), record_formats[index]);
    if (model_.record_last_o) records_.push_back(record_);
  }

  /// A sample's words are there before the next sample; a host that takes no records may stop them.
  void check_time() const {
    if (options_.clocks_per_sample > 0 && options_.back_pressure_probability == 0 && clocks_ > next_offer_)
      throw std::runtime_error("rtl: DAC words later than their sample's clocks");
  }

  void offer(const SamplePair& pair) {
    model_.sample_telemetry_i = 0;
    model_.sample_x_i = static_cast<std::uint32_t>(pair.x) & adc_mask();
    model_.sample_y_i = static_cast<std::uint32_t>(pair.y) & adc_mask();
    model_.sample_gap_i = pair.gap;
    ++offered_;
    offer();
  }

  void offer() {
    while (clocks_ < next_offer_ || happens(options_.input_gap_probability)) clock();
    model_.sample_valid_i = 1;
    wait_for([this] { return model_.sample_ready_o != 0; });
    next_offer_ = clocks_ + options_.clocks_per_sample;
    clock();
    model_.sample_valid_i = 0;
  }

  void hand_over(std::vector<Record>& output) {
    if (records_.empty()) return;
    output.insert(output.end(), records_.begin(), records_.end());
    records_.clear();
  }

  void write_register(int address, std::int64_t word) {
    model_.register_address_i = static_cast<std::uint8_t>(address);
    model_.register_data_i = static_cast<std::uint64_t>(word) & word_mask;
    model_.register_valid_i = 1;
    wait_for([this] { return model_.register_ready_o != 0; });
    clock();
    model_.register_valid_i = 0;
  }

  template <class Condition>
  void wait_for(Condition condition) {
    for (int i = 0; !condition(); ++i) {
      if (i == patience) throw std::runtime_error("rtl: the core stands still");
      clock();
    }
  }

  RtlOptions options_;
  std::mt19937_64 random_;
  VerilatedContext context_;
  Model model_{&context_};
  VerilatedFstC trace_;
  TapSink* sink_ = nullptr;
  Record record_;  ///< the one that is coming out
  std::vector<Record> records_;
  std::uint64_t clocks_ = 0;
  std::uint64_t next_offer_ = 0;
  std::uint64_t offered_ = 0;  ///< samples since the reset
  std::uint64_t strobes_ = 0;  ///< of the DAC port since then
  DacWords dac_;               ///< with the last of them
};

}  // namespace

std::unique_ptr<Engine> make_rtl_engine(bool wide, const RtlOptions& options) {
  const bool checked = options.checks || !options.waves.empty();
  if (wide && checked) return std::make_unique<RtlEngine<Vhemi_wide_checked, true>>(options);
  if (wide) return std::make_unique<RtlEngine<Vhemi_wide, false>>(options);
  if (checked) return std::make_unique<RtlEngine<Vhemi_reference_checked, true>>(options);
  return std::make_unique<RtlEngine<Vhemi_reference, false>>(options);
}

}  // namespace hemi::tb
