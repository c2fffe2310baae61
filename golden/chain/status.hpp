// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>

#include "golden/chain/compensation.hpp"

namespace hemi::golden {

/// Collects the live bits of an output interval and keeps the sticky ones.
class Status {
 public:
  void raise(config::StatusBit bit, bool condition = true) {
    if (condition) live_.set(bit);
  }
  /// Closes the output: sticky 2^24 + live. Nothing sticks before the first output that is locked,
  /// started up and valid.
  double output() {
    armed_ = armed_ || !(live_[config::status_unlocked] || live_[config::status_starting] ||
                         live_[config::status_frequency_invalid]);
    if (armed_) sticky_ |= live_;
    const double word = static_cast<double>(sticky_.to_ulong()) * power_of_two(config::status_shift) +
                        static_cast<double>(live_.to_ulong());
    live_.reset();
    return word;
  }

 private:
  std::bitset<config::status_bits> live_;
  std::bitset<config::status_bits> sticky_;
  bool armed_ = false;
};

/// Whether the exclusive or of all registers but the last, as words of 54 bits, is the last one. Values on
/// their grids.
inline bool parity_holds(const RegisterValues& values) {
  std::bitset<54> sum;
  for (std::size_t i = 0; i < config::register_count; ++i) {
    const double raw = values[i] * power_of_two(config::registers[i].format.fraction);
    sum ^= std::bitset<54>(static_cast<unsigned long long>(static_cast<long long>(raw)));
  }
  return sum.none();
}

}  // namespace hemi::golden
