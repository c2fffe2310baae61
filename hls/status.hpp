// SPDX-License-Identifier: Apache-2.0
//
// status: live flags of one output interval and sticky ones since the first lock.
//
//   sticky |= live once an output was locked, all loops closed and its frequency valid;  word = sticky 2^24 +
//   live
//
// in       flags as they are raised (config::StatusBit); out: one word an output
#ifndef HEMI_HLS_STATUS_HPP
#define HEMI_HLS_STATUS_HPP

#include "hls/words.hpp"

namespace hemi {
namespace hls {

class Status {
 public:
  void reset() {
    live_ = 0;
    sticky_ = 0;
    armed_ = false;
  }

  void raise(config::StatusBit bit, bool condition) { live_ |= condition ? std::int64_t{1} << bit : 0; }

  /// Closes the output interval: the word; live flags start anew.
  std::int64_t close() {
    constexpr std::int64_t starting = (std::int64_t{1} << config::status_unlocked) |
                                      (std::int64_t{1} << config::status_starting) |
                                      (std::int64_t{1} << config::status_frequency_invalid);
    if ((live_ & starting) == 0) armed_ = true;
    if (armed_) sticky_ |= live_;
    const std::int64_t word = (sticky_ << config::status_shift) | live_;
    live_ = 0;
    return word;
  }

 private:
  std::int64_t live_ = 0;
  std::int64_t sticky_ = 0;
  bool armed_ = false;
};

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_STATUS_HPP
