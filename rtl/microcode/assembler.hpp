// SPDX-License-Identifier: Apache-2.0
// The machine of rtl/ as its programs see it: words of the state memory, microinstructions, and a small
// assembler. One instruction a clock:
//
//   dst = quantise(a +- round_or_floor(b / 2^shift))      a, b words of the state memory, or b a port (Port)
//
// `negative` is the sign of the last exact sum that was told to set it; instructions run always, when it is
// set or when it is not. Results follow their instruction after fixed numbers of clocks (Latency); nothing in
// the hardware waits for them, so the scheduler (schedule.hpp) places instructions where they are there.
#ifndef HEMI_RTL_MICROCODE_ASSEMBLER_HPP
#define HEMI_RTL_MICROCODE_ASSEMBLER_HPP

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hls/config.hpp"

namespace hemi::microcode {

/// What tells the two instruments apart (config::Reference, config::Wide).
struct Instrument {
  std::string name;
  int adc_bits;
  int decimation;
  int cic_bits;
};

template <class T>
Instrument instrument(std::string name) {
  return {std::move(name), T::adc_bits, T::decimation, T::cic_bits};
}

constexpr int word_bits = 54;
constexpr int state_words = 256;
constexpr int address_bits = 8;

/// An address of the state memory or, from port_base on, a port of the datapath or a constant (operand b
/// alone); from symbolic_base on a name that gets its address when the program is scheduled (allocate.hpp).
struct Word {
  int address = 0;
  bool operator==(const Word&) const = default;
};
constexpr int port_base = state_words;
constexpr int constant_base = port_base + 8;
constexpr int operand_b_bits = address_bits + 1;
constexpr int symbolic_base = 1000;
/// Ports and constants: not in the state memory.
constexpr bool is_port(Word word) {
  return word.address >= port_base && word.address < 1 << operand_b_bits;
}
constexpr Word product_port{port_base};       ///< multiplier, 56 bits
constexpr Word lookup_port{port_base + 1};    ///< magnitude of the sine or cosine that was looked up
constexpr Word sample_x_port{port_base + 2};  ///< the sample being worked on
constexpr Word sample_y_port{port_base + 3};
constexpr Word gap_port{port_base + 4};   ///< -1 when the sample is marked as following a gap, else 0
constexpr Word live_port{port_base + 5};  ///< live status bits; reading them clears them

/// The last words of the state memory: one that is never written, and those whose results go out to the DACs
/// as well. Writing dac_rebalance_port completes a sample's words.
constexpr Word zero_word{state_words - 1};
constexpr Word dac_drive_port{state_words - 2};
constexpr Word dac_rebalance_port{state_words - 3};
constexpr Word dac_quadrature_port{state_words - 4};
constexpr int first_reserved = dac_quadrature_port.address;
constexpr bool is_dac_port(Word word) {
  return word.address >= first_reserved && word.address < zero_word.address;
}
constexpr int constant_bits = 32;  ///< of a constant, sign-extended

/// Clocks from an instruction to the first one that may use its result.
namespace latency {
constexpr int word = 4;      ///< state memory
constexpr int negative = 2;  ///< the sign, by a condition
constexpr int jump = 3;      ///< the sign, by a jump
constexpr int product = 2;   ///< exactly: the next product follows a clock later
constexpr int lookup = 3;    ///< exactly
constexpr int shift = 1;     ///< variable shift
constexpr int clip = 1;      ///< exactly: whether the sum was clipped, by a residual
constexpr int live = 4;      ///< a status bit, by a reader of live_port
}  // namespace latency

enum class Operation {
  add,
  subtract,
  add_if_negative,       ///< a + b when `negative`, else a - b
  subtract_if_negative,  ///< a - b when `negative`, else a + b
  mirror,                ///< a - b where the looked-up sine is negative, else a + b
  exclusive_or,
  multiply,  ///< product = low 32 bits of a times low 24 bits of b, signed
  look_up    ///< angle from a; shift 0: sine, 1: cosine
};

enum class Condition { always, negative, not_negative, never };

enum class Control {
  next,
  yield,       ///< a waiting sample may go first
  jump,        ///< to the address in a and b, if the condition holds
  emit,        ///< the result is a record word
  give_back,   ///< end of a sample's work; after the last of a tick the tick's program begins
  end,         ///< end of the work of a tick or of a telemetry sample
  take,        ///< the sample has been read, the next may come in
  load_shift,  ///< variable shift = low 6 bits of b
};

/// Shift distance that stands for the variable shift.
constexpr int variable_shift = 63;

/// How the exact sum becomes a word: the low `width` bits, or clipped to them. A residual is 0 instead when
/// the instruction a clock before clipped.
struct Mode {
  int width = word_bits;
  bool saturate = false;
  bool residual = false;
  auto operator<=>(const Mode&) const = default;
};

constexpr int no_event = config::status_adc_overload;  ///< raised by the sample port, never by an instruction

struct Instruction {
  Operation operation = Operation::add;
  Word dst, a, b;
  int shift = 0;
  bool round_half_up = false;
  Mode mode;
  Condition condition = Condition::always;
  bool sets_negative = false;
  int event = no_event;  ///< status bit raised when the sum clips (saturating modes) or is negative (others)
  int tap = -1;
  Control control = Control::next;
  bool before_residual = false;  ///< the next line is a residual and follows at the next clock
  std::string target;            ///< of a jump
  const char* block = "";

  Instruction& floor(int bits) { return shift = bits, *this; }
  Instruction& round(int bits) { return shift = bits, round_half_up = true, *this; }
  Instruction& wrap(config::Format f) { return wrap(f.width); }
  Instruction& wrap(int width) { return mode = {width, false, false}, *this; }
  Instruction& saturate(config::Format f) { return mode = {f.width, true, false}, *this; }
  Instruction& raise(config::StatusBit bit) { return event = bit, *this; }
  Instruction& set_negative() { return sets_negative = true, *this; }
  Instruction& if_negative() { return condition = Condition::negative, *this; }
  Instruction& if_not_negative() { return condition = Condition::not_negative, *this; }
  Instruction& send_to(config::TapIndex index) { return tap = index, *this; }
  Instruction& then(Control c) { return control = c, *this; }
};

/// A stretch without jumps into or out of its middle; the scheduler orders it.
struct Region {
  std::string label;
  std::deque<Instruction> lines;
  std::string jump_target;  ///< at the end; empty for none
  Condition jump_condition = Condition::always;
  Control last = Control::next;  ///< of the last place
  bool in_order = false;         ///< one line a place, as written
  bool follows_sample = false;   ///< entered straight behind a sample's last instructions
  bool background = true;        ///< a waiting sample may interrupt it
};

/// Collects words, constants and instructions of one instrument's program.
class Assembler {
 public:
  explicit Assembler(Instrument instrument);

  const Instrument& instrument() const { return instrument_; }

  /// The word of that name, zero after reset.
  Word word(const std::string& name);
  Word word(const std::string& name, int index) { return word(name + "_" + std::to_string(index)); }
  /// A word that always holds `value` of constant_bits; operand b alone, except 0.
  Word constant(std::int64_t value);
  Word zero() const { return zero_word; }
  Word reg(config::RegisterIndex index) const { return {index}; }
  /// Where results go that are only compared or sent out.
  Word nowhere() { return word("nowhere"); }

  void block(const char* name) { block_ = name; }
  Region& region(const std::string& label);

  Instruction& add(Word dst, Word a, Word b) { return line(Operation::add, dst, a, b); }
  Instruction& subtract(Word dst, Word a, Word b) { return line(Operation::subtract, dst, a, b); }
  Instruction& move(Word dst, Word b) { return line(Operation::add, dst, zero(), b); }
  Instruction& clear(Word dst) { return line(Operation::add, dst, zero(), zero()); }
  Instruction& add_if_negative(Word dst, Word a, Word b) {
    return line(Operation::add_if_negative, dst, a, b);
  }
  Instruction& subtract_if_negative(Word dst, Word a, Word b) {
    return line(Operation::subtract_if_negative, dst, a, b);
  }
  Instruction& exclusive_or(Word dst, Word a, Word b) { return line(Operation::exclusive_or, dst, a, b); }
  /// `negative` = a < b.
  Instruction& compare(Word a, Word b) { return subtract(nowhere(), a, b).set_negative(); }
  /// `negative` = b < 0.
  Instruction& test(Word b) { return move(nowhere(), b).set_negative(); }
  /// wide (32 bits) times narrow (24 bits); the instruction that follows uses product_port.
  Word product(Word wide, Word narrow);
  /// Cosine or sine of the 24 phase bits of `phase` into dst.
  Instruction& look_up(Word dst, Word phase, bool cosine);
  /// dst = sum rounded and clipped to `format`; `error` = what the rounding left, 0 where it clipped.
  /// Returns the first of the two instructions.
  Instruction& shape(Word dst, Word error, Word sum, int shift, config::Format format);

  int mode_code(Mode mode) const;
  const std::vector<Mode>& modes() const { return modes_; }
  const std::deque<Region>& regions() const { return regions_; }
  const std::map<std::string, Word>& words() const { return words_; }
  const std::map<std::int64_t, Word>& constants() const { return constants_; }
  std::string name_of(Word word) const;

 private:
  Instruction& line(Operation operation, Word dst, Word a, Word b);

  Instrument instrument_;
  std::map<std::string, Word> words_;
  std::map<std::int64_t, Word> constants_;
  std::vector<Mode> modes_;
  std::deque<Region> regions_;
  int next_word_;
  int next_constant_;
  const char* block_ = "";
};

}  // namespace hemi::microcode

#endif  // HEMI_RTL_MICROCODE_ASSEMBLER_HPP
