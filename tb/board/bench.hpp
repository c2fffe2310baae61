// SPDX-License-Identifier: Apache-2.0
// The reference design under Verilator with its converters, and a plant behind them.
#ifndef HEMI_TB_BOARD_BENCH_HPP
#define HEMI_TB_BOARD_BENCH_HPP

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "tb/board/uart.hpp"
#include "tb/plant_port.hpp"

namespace hemi::tb {

/// What passed the pins between two instants.
struct BoardPeriod {
  std::uint64_t sample = 0;  ///< since the bench began
  SamplePair pair;           ///< converted at its instant
  DacWords in_force;         ///< what the DACs gave from that instant on: words of the sample before the last
  DacWords sent;             ///< what they received after it: words of the last sample
};

/// hemi_board_up5k clock by clock. The plant's instants are the rising edges of CNV; between them its time
/// stands still, so that nothing happens while the board does not sample. clock() throws std::runtime_error
/// where a pin breaks a rule: that of a converter, LDAC not at the ADC's instant, not one DAC frame between
/// two instants.
class BoardBench {
 public:
  /// `on_period` sees each period once its DAC frame is there. `host_bit_clocks`: the host's bit in board
  /// clocks, 24 when its oscillator agrees with the board's.
  BoardBench(PlantPort& plant, std::function<void(const BoardPeriod&)> on_period,
             double host_bit_clocks = 24.0);
  ~BoardBench();
  BoardBench(const BoardBench&) = delete;
  BoardBench& operator=(const BoardBench&) = delete;

  /// One clock; a byte from the board when one is complete.
  std::optional<std::uint8_t> clock();
  void send(std::uint8_t byte) { sender_.send(byte); }
  bool sending() const { return !sender_.idle(); }
  std::uint64_t clocks() const { return clocks_; }
  /// What the DACs have received last.
  DacWords waiting() const;
  /// The lamps.
  bool active() const;
  bool fault() const;

 private:
  struct Model;

  void converters();
  void begin_period();
  void end_frame();

  PlantPort& plant_;
  std::function<void(const BoardPeriod&)> on_period_;
  std::unique_ptr<Model> model_;
  UartSender sender_;
  UartReceiver receiver_;
  std::uint64_t clocks_ = 0;
  std::uint64_t samples_ = 0;
  bool awaiting_frame_ = false;
  BoardPeriod period_;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_BOARD_BENCH_HPP
