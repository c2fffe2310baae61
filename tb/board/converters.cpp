// SPDX-License-Identifier: Apache-2.0
#include "tb/board/converters.hpp"

#include <stdexcept>

namespace hemi::tb {
namespace {

void require(bool good, const char* rule) {
  if (!good) throw std::runtime_error(std::string("board: ") + rule);
}

bool bit(std::int32_t word, int index) {
  return (static_cast<std::uint32_t>(word) >> index & 1) != 0;
}

std::int32_t from_offset_binary(std::uint16_t code) {
  return static_cast<std::int32_t>(code) - 0x8000;
}

}  // namespace

void AdcPins::convert(const SamplePair& pair) {
  require(cnv_, "the result of a conversion comes after CNV has fallen");
  result_ = pair;
}

bool AdcPins::clock(bool cnv, bool sck) {
  seen_x_ = sdo_x_;
  seen_y_ = sdo_y_;
  const bool begins = cnv && !cnv_;
  ++since_conversion_;
  if (begins) {
    require(next_bit_ == bits, "CNV rises before a result has been read");
    since_conversion_ = 0;
    sdo_x_ = sdo_y_ = true;
  }
  if (cnv_ && !cnv) {
    require(since_conversion_ >= conversion_clocks, "CNV falls before the conversion is over");
    require(result_.has_value(), "CNV falls without a result");
    next_bit_ = 0;
  }
  const bool falls = sck_ && !sck;
  if (sck || falls) require(!cnv, "SCK moves during a conversion");
  if (falls) {
    require(next_bit_ < bits, "more than 16 edges of SCK");
    ++next_bit_;
  }
  if (next_bit_ < bits) {
    sdo_x_ = bit(result_->x, bits - 1 - next_bit_);
    sdo_y_ = bit(result_->y, bits - 1 - next_bit_);
  } else {
    sdo_x_ = sdo_y_ = true;
    if (falls) result_.reset();
  }
  cnv_ = cnv;
  sck_ = sck;
  return begins;
}

void DacPins::clock(const Lines& lines) {
  received_ = loaded_ = false;
  if (last_.cs_n && !lines.cs_n) bits_ = 0;
  if (!lines.cs_n && lines.sck && !last_.sck) {
    // Data stood before the edge: the line of the clock before counts.
    drive_ = static_cast<std::uint16_t>(drive_ << 1 | static_cast<int>(last_.drive));
    rebalance_ = static_cast<std::uint16_t>(rebalance_ << 1 | static_cast<int>(last_.rebalance));
    quadrature_ = static_cast<std::uint16_t>(quadrature_ << 1 | static_cast<int>(last_.quadrature));
    ++bits_;
  }
  if (!last_.cs_n && lines.cs_n) {
    require(bits_ == 16, "a DAC frame is not 16 bits long");
    waiting_ = {from_offset_binary(drive_), from_offset_binary(rebalance_), from_offset_binary(quadrature_)};
    received_ = true;
    ++frames_;
  }
  if (last_.ldac_n && !lines.ldac_n) {
    require(lines.cs_n, "LDAC falls within a DAC frame");
    require(frames_ <= 1, "a DAC frame is replaced before LDAC");
    frames_ = 0;
    in_force_ = waiting_;
    loaded_ = true;
  }
  last_ = lines;
}

}  // namespace hemi::tb
