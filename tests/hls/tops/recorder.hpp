// SPDX-License-Identifier: Apache-2.0
// Calls tops and keeps what went into them: the vectors that an HLS tool's simulation is fed with.
#ifndef HEMI_TESTS_HLS_TOPS_RECORDER_HPP
#define HEMI_TESTS_HLS_TOPS_RECORDER_HPP

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace hemi::tests {

/// The calls of one top: its scalar inputs in their order, a row a call.
struct CallLog {
  std::vector<int> column_bits;  ///< of the inputs' C types
  std::vector<std::int64_t> words;
  std::size_t rows() const { return column_bits.empty() ? 0 : words.size() / column_bits.size(); }
};

class Recorder {
 public:
  /// Keeps at most `rows` calls of each top; 0: keeps nothing.
  explicit Recorder(std::size_t rows) : limit_(rows) {}

  template <class... Ports, class... Arguments>
  void operator()(const std::string& name, void (*top)(Ports...), Arguments... arguments) {
    static_assert(sizeof...(Ports) == sizeof...(Arguments));
    if (limit_ > 0) {
      CallLog& log = logs_[name];
      if (log.column_bits.empty()) (column<Ports>(log), ...);
      if (log.rows() < limit_) (keep<Ports>(log, arguments), ...);
    }
    top(static_cast<Ports>(arguments)...);
  }

  /// Adds `rows` calls with random words to what is kept of each top: any word is legal, as each port takes
  /// the low bits of its format. Flags are 0 or 1; a flag in the first column, the reset, is set in one
  /// of 64.
  void add_random(std::size_t rows, unsigned seed) {
    std::mt19937_64 generator(seed);
    for (auto& [name, log] : logs_) {
      for (std::size_t r = 0; r < rows; ++r) {
        for (std::size_t c = 0; c < log.column_bits.size(); ++c) {
          const auto word = static_cast<std::int64_t>(generator());
          if (log.column_bits[c] > flag_bits) {
            log.words.push_back(word >> (64 - log.column_bits[c]));
          } else {
            log.words.push_back(c == 0 ? (word & 63) == 0 : word & 1);
          }
        }
      }
    }
  }

  const std::map<std::string, CallLog>& logs() const { return logs_; }

 private:
  static constexpr int flag_bits = 8;  ///< bool, or a byte that is 0 or 1

  template <class Port>
  static void column(CallLog& log) {
    if constexpr (!std::is_pointer_v<Port>)
      log.column_bits.push_back(std::is_same_v<Port, bool> ? 1 : static_cast<int>(8 * sizeof(Port)));
  }
  template <class Port, class Argument>
  static void keep(CallLog& log, const Argument& argument) {
    if constexpr (!std::is_pointer_v<Port>) log.words.push_back(static_cast<std::int64_t>(argument));
  }

  std::size_t limit_;
  std::map<std::string, CallLog> logs_;
};

}  // namespace hemi::tests

#endif  // HEMI_TESTS_HLS_TOPS_RECORDER_HPP
