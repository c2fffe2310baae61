// SPDX-License-Identifier: Apache-2.0
//
// modulator: commands onto the carrier, as DAC words.
//
//   dac = round(-command sin(2 pi (phase + offset)) + error),  error = what that rounding left
//   offset = modulation_phase + modulation_delay increment
//
// in       command Q2.30, carrier Q1.19, phase Q5.48 turns
// out      DAC word Q1.15; the quadrature command goes out without carrier, once a tick
// latency  0 samples
// rounding product half up to 2^-30; word half up to 2^-15; the error is carried to the next word
// (first-order
//          noise shaping) and dropped where the word clips
// source   the force that makes x = a cos(theta) grow is in phase with its velocity, -sin(theta); error
// feedback:
//          Schreier, Temes, Understanding Delta-Sigma Data Converters, 2005, ch. 2
#ifndef HEMI_HLS_MODULATOR_HPP
#define HEMI_HLS_MODULATOR_HPP

#include "hls/nco.hpp"
#include "hls/registers.hpp"

namespace hemi {
namespace hls {

/// A 16-bit DAC with first-order error feedback.
class ShapedDac {
 public:
  void reset() { error_ = DacSum(); }

  template <class Expression>
  DacWord step(const Expression& command) {
    const DacSum sum = quantise<DacSum>(quantise<Rounded<config::dac_sum>>(command) + error_);
    const bool clipped = saturates<Clipped<config::dac>>(sum);
    const DacWord word = quantise<DacWord>(quantise<Clipped<config::dac>>(sum));
    error_ = clipped ? DacSum() : wrap_sub(sum, word);
    return word;
  }

 private:
  DacSum error_;
};

struct CarrierOffset {
  /// In turns; `increment` is the one that will be in force.
  static Angle value(const Increment& increment, const Registers& r) {
    const Word<config::increment_operand> operand = quantise<Word<config::increment_operand>>(increment);
    return wrap_add(r.modulation_phase,
                    quantise<Angle>(quantise<Rounded<config::angle>>(operand * r.modulation_delay)));
  }
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_MODULATOR_HPP
