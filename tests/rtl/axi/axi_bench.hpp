// SPDX-License-Identifier: Apache-2.0
// Bus-functional model around the verilated hemi_axi: random valids and readies on every channel, protocol
// checks at every clock, the register model in step with the bus. What is wrong throws std::runtime_error.
#ifndef HEMI_TESTS_RTL_AXI_AXI_BENCH_HPP
#define HEMI_TESTS_RTL_AXI_AXI_BENCH_HPP

#include <fmt/format.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include "Vhemi_axi.h"
#include "tb/engine.hpp"
#include "tests/rtl/axi/axi_model.hpp"

namespace hemi::tests {

struct Write {
  std::uint32_t address = 0, data = 0;
  unsigned strobe = 15;
};

struct SampleBeat {
  tb::SamplePair pair;
  bool telemetry = false;
};

/// How often each side is willing, a clock.
struct Willingness {
  double address = 1, data = 1, response = 1, read = 1, read_data = 1, sample = 1, dac = 1, record = 1;
};

class AxiBench {
 public:
  explicit AxiBench(unsigned seed) : random_(seed) { reset(8); }
  AxiBench(const AxiBench&) = delete;
  AxiBench& operator=(const AxiBench&) = delete;
  ~AxiBench() { dut_.final(); }

  Willingness willingness;
  AxiModel model;
  std::deque<Write> writes;            ///< to do
  std::deque<std::uint32_t> reads;     ///< addresses to do
  std::deque<SampleBeat> samples;      ///< to send
  std::deque<tb::DacWords> dac_words;  ///< received
  std::vector<AxiModel::RecordWords> records;
  std::uint64_t responses[4] = {};  ///< of writes and reads, by code
  std::uint64_t both = 0;           ///< clocks with a write and a read under way
  std::uint64_t waits = 0;          ///< clocks in which a beat of the device waited for its receiver
  std::uint64_t interrupts = 0;     ///< clocks with one pending
  std::uint64_t clocks = 0;

  std::uint64_t transactions() const { return responses[0] + responses[2] + responses[3]; }
  bool transfers_under_way() const {
    return !effects_.empty() || read_ || dut_.s_axil_awvalid || dut_.s_axil_wvalid || dut_.s_axil_arvalid ||
           dut_.m_axis_record_tvalid || dut_.m_axis_dac_tvalid;
  }
  bool sample_waits() const { return dut_.s_axis_sample_tvalid != 0; }
  bool idle() const { return writes.empty() && reads.empty() && effects_.empty() && !read_; }

  /// Whatever is under way is lost.
  void reset(int length) {
    dut_.aresetn = 0;
    dut_.s_axil_awvalid = dut_.s_axil_wvalid = dut_.s_axil_arvalid = dut_.s_axis_sample_tvalid = 0;
    for (int i = 0; i < length; ++i) {
      edge();
      require(!dut_.s_axil_bvalid && !dut_.s_axil_rvalid && !dut_.m_axis_dac_tvalid &&
                  !dut_.m_axis_record_tvalid && !dut_.irq_o,
              "valid during reset");
    }
    dut_.aresetn = 1;
    model = {};
    for (auto* queue : {&writes, &effects_}) queue->clear();
    reads.clear();
    samples.clear();
    dac_words.clear();
    record_at_ = aw_done_ = w_done_ = 0;
    read_.reset();
  }

  void clock() {
    drive();
    dut_.eval();
    const bool aw = dut_.s_axil_awvalid && dut_.s_axil_awready, w = dut_.s_axil_wvalid && dut_.s_axil_wready;
    const bool ar = dut_.s_axil_arvalid && dut_.s_axil_arready, r = dut_.s_axil_rvalid && dut_.s_axil_rready;
    const bool sample = dut_.s_axis_sample_tvalid && dut_.s_axis_sample_tready;
    const bool dac = dut_.m_axis_dac_tvalid && dut_.m_axis_dac_tready;
    const bool record = dut_.m_axis_record_tvalid && dut_.m_axis_record_tready;
    const bool response_free = !dut_.s_axil_bvalid || dut_.s_axil_bready;
    const Held held = offered();
    if (r) take_read();
    if (dac) take_dac();
    const bool complete = record && take_record_word();
    if (ar) read_ = Read{dut_.s_axil_araddr, model.read(dut_.s_axil_araddr), 0};
    edge();
    check_held(held, offered());
    const std::uint32_t mask = model.mask();
    if (dut_.s_axil_bvalid && response_free) apply_write(aw, w);
    if (complete) model.record(records.back(), mask);
    if (ar) read_->after = model.read(read_->address);
    if (aw) retire_address();
    if (w) retire_data();
    if (ar) dut_.s_axil_arvalid = 0;
    if (sample) dut_.s_axis_sample_tvalid = 0;
    require(dut_.irq_o == model.interrupt(), "interrupt differs from the model's");
    interrupts += dut_.irq_o;
    both += !effects_.empty() && read_;
  }

 private:
  struct Read {
    std::uint32_t address, before, after;  ///< its word before and after the clock that took the address
  };
  /// What the device offers and was not taken: it must stand unchanged.
  struct Held {
    std::optional<unsigned> write;
    std::optional<std::uint64_t> read, dac, record;
    std::optional<unsigned> record_side;
  };

  static void require(bool condition, const char* what) {
    if (!condition) throw std::runtime_error(what);
  }
  bool willing(double probability) {
    return probability >= 1 || std::bernoulli_distribution(probability)(random_);
  }

  void edge() {
    dut_.aclk = 1;
    dut_.eval();
    dut_.aclk = 0;
    dut_.eval();
    ++clocks;
  }

  void drive() {
    // An address or its data may be first, by any number of clocks.
    if (!dut_.s_axil_awvalid && aw_done_ < writes.size() && aw_done_ < w_done_ + 2 &&
        willing(willingness.address)) {
      dut_.s_axil_awvalid = 1;
      dut_.s_axil_awaddr = writes[aw_done_].address;
    }
    if (!dut_.s_axil_wvalid && w_done_ < writes.size() && w_done_ < aw_done_ + 2 &&
        willing(willingness.data)) {
      dut_.s_axil_wvalid = 1;
      dut_.s_axil_wdata = writes[w_done_].data;
      dut_.s_axil_wstrb = writes[w_done_].strobe;
    }
    if (!dut_.s_axil_arvalid && !reads.empty() && willing(willingness.read)) {
      dut_.s_axil_arvalid = 1;
      dut_.s_axil_araddr = reads.front();
      reads.pop_front();
    }
    if (!dut_.s_axis_sample_tvalid && !samples.empty() && willing(willingness.sample)) {
      const SampleBeat& beat = samples.front();
      dut_.s_axis_sample_tvalid = 1;
      dut_.s_axis_sample_tdata = static_cast<std::uint32_t>(beat.pair.y) << 16 | (beat.pair.x & 0xffff);
      dut_.s_axis_sample_tuser = beat.telemetry << 1 | beat.pair.gap;
      samples.pop_front();
    }
    dut_.s_axil_bready = willing(willingness.response);
    dut_.s_axil_rready = willing(willingness.read_data);
    dut_.m_axis_dac_tready = willing(willingness.dac);
    dut_.m_axis_record_tready = willing(willingness.record);
  }

  Held offered() const {
    Held held;
    if (dut_.s_axil_bvalid && !dut_.s_axil_bready) held.write = dut_.s_axil_bresp;
    if (dut_.s_axil_rvalid && !dut_.s_axil_rready)
      held.read = static_cast<std::uint64_t>(dut_.s_axil_rresp) << 32 | dut_.s_axil_rdata;
    if (dut_.m_axis_dac_tvalid && !dut_.m_axis_dac_tready) held.dac = dut_.m_axis_dac_tdata;
    if (dut_.m_axis_record_tvalid && !dut_.m_axis_record_tready) {
      held.record = dut_.m_axis_record_tdata;
      held.record_side = dut_.m_axis_record_tuser << 1 | dut_.m_axis_record_tlast;
    }
    return held;
  }

  void check_held(const Held& before, const Held& now) {
    require(!before.write || before.write == now.write, "write response changed before it was taken");
    require(!before.read || before.read == now.read, "read data changed before they were taken");
    require(!before.dac || before.dac == now.dac, "DAC words changed before they were taken");
    require(!before.record || (before.record == now.record && before.record_side == now.record_side),
            "record word changed before it was taken");
    waits += before.write || before.read || before.dac || before.record;
  }

  void retire_address() {
    dut_.s_axil_awvalid = 0;
    ++aw_done_;
    retire_write();
  }
  void retire_data() {
    dut_.s_axil_wvalid = 0;
    ++w_done_;
    retire_write();
  }
  /// A write whose address and data are both taken waits for its effect.
  void retire_write() {
    if (aw_done_ == 0 || w_done_ == 0) return;
    effects_.push_back(writes.front());
    writes.pop_front();
    --aw_done_;
    --w_done_;
  }

  /// A new response stands there: its write took effect at this clock's edge.
  void apply_write(bool aw, bool w) {
    require(!effects_.empty(),
            aw || w ? "write response in the clock of its request" : "write response for no write");
    const Write write = effects_.front();
    effects_.pop_front();
    const Response expected = model.write(write.address, write.data, write.strobe);
    if (dut_.s_axil_bresp != static_cast<unsigned>(expected))
      throw std::runtime_error(fmt::format("write to {:03x}, strobe {:x}: response {}, expected {}",
                                           write.address, write.strobe, dut_.s_axil_bresp,
                                           static_cast<unsigned>(expected)));
    ++responses[dut_.s_axil_bresp];
  }

  void take_read() {
    require(read_.has_value(), "read data for no read");
    const auto expected = static_cast<unsigned>(AxiModel::decode(read_->address));
    if (dut_.s_axil_rresp != expected ||
        (dut_.s_axil_rdata != read_->before && dut_.s_axil_rdata != read_->after))
      throw std::runtime_error(
          fmt::format("read of {:03x}: {:08x}, response {}; expected {:08x} or {:08x}, {}", read_->address,
                      dut_.s_axil_rdata, dut_.s_axil_rresp, read_->before, read_->after, expected));
    ++responses[dut_.s_axil_rresp];
    read_.reset();
  }

  void take_dac() {
    const auto lane = [this](int i) { return static_cast<std::int16_t>(dut_.m_axis_dac_tdata >> (16 * i)); };
    require(lane(3) == 0, "fourth DAC lane is not 0");
    dac_words.push_back({lane(0), lane(1), lane(2)});
  }

  /// True with the last word of a record.
  bool take_record_word() {
    require(dut_.m_axis_record_tuser == record_at_, "record words out of order");
    record_[record_at_] = static_cast<std::int64_t>(dut_.m_axis_record_tdata);
    const bool last = ++record_at_ == config::record_words;
    require(dut_.m_axis_record_tlast == last, "tlast is not at the last word");
    if (!last) return false;
    record_at_ = 0;
    records.push_back(record_);
    return true;
  }

  std::mt19937_64 random_;
  Vhemi_axi dut_;
  std::deque<Write> effects_;             ///< taken by the device, not yet answered
  std::size_t aw_done_ = 0, w_done_ = 0;  ///< of `writes`, how many addresses and data the device has
  std::optional<Read> read_;
  AxiModel::RecordWords record_{};
  unsigned record_at_ = 0;
};

}  // namespace hemi::tests

#endif  // HEMI_TESTS_RTL_AXI_AXI_BENCH_HPP
