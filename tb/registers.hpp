// SPDX-License-Identifier: Apache-2.0
// Register values in units to and from the raw words of the core.
#ifndef HEMI_TB_REGISTERS_HPP
#define HEMI_TB_REGISTERS_HPP

#include <cmath>
#include <stdexcept>
#include <string>

#include "tb/engine.hpp"

namespace hemi::tb {

/// A value that its format cannot hold.
class FormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Nearest raw word of `value` in `format`, halves upwards; throws FormatError naming `what` when it does not
/// fit.
inline std::int64_t to_raw(double value, config::Format format, const std::string& what) {
  const double raw = std::floor(std::ldexp(value, format.fraction) + 0.5);
  const double limit = std::ldexp(1.0, format.width - 1);
  if (!(raw >= -limit && raw < limit)) {
    throw FormatError(what + ": " + std::to_string(value) + " does not fit its format of " +
                      std::to_string(format.width) + " bits, range +-" +
                      std::to_string(std::ldexp(limit, -format.fraction)));
  }
  return static_cast<std::int64_t>(raw);
}

/// Value of a raw word.
inline double to_value(std::int64_t raw, config::Format format) {
  return std::ldexp(static_cast<double>(raw), -format.fraction);
}

/// Formats of the words of a record, in the order of config::RecordWord.
inline constexpr std::array<config::Format, config::record_words> record_formats = {config::frequency,
                                                                                    config::temperature,
                                                                                    config::derivative,
                                                                                    config::amplitude_sum,
                                                                                    config::phase_error_sum,
                                                                                    config::command_sum,
                                                                                    config::command_sum,
                                                                                    config::bias,
                                                                                    config::rate,
                                                                                    config::rate,
                                                                                    config::status};

/// A record from raw words.
template <class Words>
Record to_record(const Words& words) {
  Record record;
  for (int i = 0; i < config::record_words; ++i) record.words[i] = to_value(words[i], record_formats[i]);
  return record;
}

/// All registers rounded to nearest into their formats; the parity register is computed.
inline RegisterImage to_image(const RegisterValues& values) {
  RegisterImage image{};
  std::uint64_t parity = 0;
  for (int i = 0; i < config::register_count; ++i) {
    if (i == config::reg_parity) continue;
    image[i] =
        to_raw(values[i], config::registers[i].format, std::string("register ") + config::registers[i].name);
    parity ^= static_cast<std::uint64_t>(image[i]);
  }
  image[config::reg_parity] = static_cast<std::int64_t>(parity << 10) >> 10;
  return image;
}

}  // namespace hemi::tb

#endif  // HEMI_TB_REGISTERS_HPP
