// SPDX-License-Identifier: Apache-2.0
// The board's converters as its pins see them, one clock of 24 MHz at a time. They watch the rules that their
// data sheets set and throw std::runtime_error where one is broken.
#ifndef HEMI_TB_BOARD_CONVERTERS_HPP
#define HEMI_TB_BOARD_CONVERTERS_HPP

#include <cstdint>
#include <optional>

#include "tb/engine.hpp"

namespace hemi::tb {

/// Two AD7688 in three-wire mode without busy bit: 16 bits, two's complement, conversion at the rising edge
/// of CNV; CNV stays high until the conversion is over; then the highest bit stands on SDO, and each falling
/// edge of SCK brings the next. SDO follows a clock (41.7 ns) behind the edge; the data sheet allows 18 ns.
class AdcPins {
 public:
  /// One clock; true when the conversion began here.
  bool clock(bool cnv, bool sck);
  /// The conversion's result, before CNV falls.
  void convert(const SamplePair& pair);
  bool sdo_x() const { return seen_x_; }
  bool sdo_y() const { return seen_y_; }

 private:
  static constexpr int conversion_clocks = 39;  // 1.6 us
  static constexpr int bits = 16;

  std::optional<SamplePair> result_;
  bool cnv_ = false, sck_ = false;
  int since_conversion_ = 0;
  int next_bit_ = bits;                 ///< that the next falling edge of SCK brings
  bool sdo_x_ = true, sdo_y_ = true;    ///< high impedance is read as ones
  bool seen_x_ = true, seen_y_ = true;  ///< a clock later
};

/// Three AD5542A: offset binary, bits read at rising edges of SCK while CS is low, 16 of them; LDAC puts them
/// in force, with CS high.
class DacPins {
 public:
  struct Lines {
    bool ldac_n, cs_n, sck, drive, rebalance, quadrature;
  };
  /// One clock.
  void clock(const Lines& lines);
  /// A whole frame ended at this clock.
  bool received() const { return received_; }
  /// LDAC fell at this clock.
  bool loaded() const { return loaded_; }
  const DacWords& waiting() const { return waiting_; }
  const DacWords& in_force() const { return in_force_; }

 private:
  Lines last_{true, true, false, false, false, false};
  int bits_ = 0;
  int frames_ = 0;  ///< since LDAC
  std::uint16_t drive_ = 0, rebalance_ = 0, quadrature_ = 0;
  DacWords waiting_, in_force_;
  bool received_ = false, loaded_ = false;
};

}  // namespace hemi::tb

#endif  // HEMI_TB_BOARD_CONVERTERS_HPP
