// SPDX-License-Identifier: Apache-2.0
//
// Our fixed-point type against SystemC's sc_fixed, which is exact for operands of any width: same words
// in, same words out, at the edges of every type and at random.
#ifndef SC_INCLUDE_FX
#define SC_INCLUDE_FX
#endif
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "hls/fixed.hpp"

namespace hemi::hls {
namespace {

template <class T>
struct Modes;
template <int W, int I, Round R, Overflow O>
struct Modes<Fixed<W, I, R, O>> {
  static constexpr Round round = R;
  static constexpr Overflow overflow = O;
  static constexpr sc_dt::sc_q_mode sc_round = R == Round::floor     ? sc_dt::SC_TRN
                                               : R == Round::half_up ? sc_dt::SC_RND
                                                                     : sc_dt::SC_RND_CONV;
  static constexpr sc_dt::sc_o_mode sc_overflow = O == Overflow::wrap       ? sc_dt::SC_WRAP
                                                  : O == Overflow::saturate ? sc_dt::SC_SAT
                                                                            : sc_dt::SC_SAT_SYM;
  using Sc = sc_dt::sc_fixed<W, I, sc_round, sc_overflow>;
};

template <class T>
using Sc = typename Modes<T>::Sc;

// The functions that hold SystemC's large inline code stand once for each type: noinline.

/// The word of a value that T holds exactly; of any other one, a number that is no word of 63 bits. By way
/// of the bits: to_int64() of SystemC 2.3.4's values gives 0 for multiples of 2^32 over 32 bits.
template <class T>
[[gnu::noinline]] std::int64_t word_of(const sc_dt::sc_fxval& value) {
  const sc_dt::sc_fixed<T::width, T::integer> held(value);
  return held == value ? held.range().to_int64() : std::numeric_limits<std::int64_t>::min();
}

template <class T>
[[gnu::noinline]] Sc<T> to_sc(T x) {
  const sc_dt::sc_fxval integer(static_cast<sc_dt::int64>(raw(x)));
  return Sc<T>(T::fraction >= 0 ? integer >> T::fraction : integer << -T::fraction);
}

template <class T>
[[gnu::noinline]] Sc<T> quantise_sc(const sc_dt::sc_fxval& value) {
  return Sc<T>(value);
}

template <class T>
[[gnu::noinline]] std::string name() {
  return fmt::format("<{}, {}, {}, {}>", T::width, T::integer, static_cast<int>(Modes<T>::round),
                     static_cast<int>(Modes<T>::overflow));
}

/// Ends of the range, small numbers, every power of two with both neighbours and its half-way sums, then
/// random words of random magnitude.
std::vector<std::int64_t> words(int width, std::size_t random_count, std::uint64_t seed) {
  const std::int64_t max = (std::int64_t{1} << (width - 1)) - 1;
  std::vector<std::int64_t> result{-max - 1, -max, -max + 1, max, max - 1, -3, -2, -1, 0, 1, 2, 3};
  for (int bit = 1; bit < width - 1; ++bit) {
    const std::int64_t power = std::int64_t{1} << bit;
    for (const std::int64_t word : {power, power + power / 2, max - power, max - power / 2}) {
      result.insert(result.end(), {word - 1, word, word + 1, -word - 1, -word, -word + 1});
    }
  }
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < random_count; ++i) {
    const std::uint64_t bits = random();
    result.push_back(static_cast<std::int64_t>(bits) >> (random() % 64));
  }
  return result;
}

template <class T>
std::vector<T> samples(std::size_t random_count, std::uint64_t seed) {
  std::vector<T> result;
  for (const std::int64_t word : words(T::width, random_count, seed)) {
    const T x = from_raw<T>(word);
    // The one word that a symmetric type never holds.
    const bool lowest = raw(x) == -(std::int64_t{1} << (T::width - 1));
    if (Modes<T>::overflow != Overflow::saturate_symmetric || !lowest) result.push_back(x);
  }
  return result;
}

/// Counts cases and reports the first differences in full, the rest by number.
class Comparison {
 public:
  template <class A, class B>
  void check(const char* operation, std::int64_t ours, std::int64_t theirs, A a, B b) {
    ++cases_;
    if (ours != theirs) report(operation, ours, theirs, name<A>(), raw(a), name<B>(), raw(b));
  }

  void finish(std::uint64_t least_cases) const {
    std::cout << cases_ << " cases against sc_fixed, " << differences_ << " differences\n";
    testing::Test::RecordProperty("cases", std::to_string(cases_));
    EXPECT_EQ(differences_, 0U);
    EXPECT_GE(cases_, least_cases);
  }

 private:
  void report(const char* operation, std::int64_t ours, std::int64_t theirs, const std::string& type_a,
              std::int64_t a, const std::string& type_b, std::int64_t b) {
    if (++differences_ > 20) return;
    ADD_FAILURE() << operation << " of " << type_a << " " << a << " and " << type_b << " " << b << ": ours "
                  << ours << ", sc_fixed " << theirs;
  }

  std::uint64_t cases_ = 0;
  std::uint64_t differences_ = 0;
};

template <class T, class S>
void compare_quantise(Comparison& comparison, const std::vector<S>& sources) {
  for (const S& x : sources) {
    const Sc<T> expected = quantise_sc<T>(to_sc(x));
    comparison.check("quantise", raw(quantise<T>(x)), word_of<T>(expected), x, T{});
    comparison.check("saturates", saturates<T>(x), expected.overflow_flag(), x, T{});
  }
}

template <int W, int I, class S>
void compare_modes(Comparison& comparison, std::uint64_t seed, std::size_t random_count) {
  const std::vector<S> sources = samples<S>(random_count, seed);
  compare_quantise<Fixed<W, I, Round::floor, Overflow::wrap>>(comparison, sources);
  compare_quantise<Fixed<W, I, Round::floor, Overflow::saturate>>(comparison, sources);
  compare_quantise<Fixed<W, I, Round::floor, Overflow::saturate_symmetric>>(comparison, sources);
  compare_quantise<Fixed<W, I, Round::half_up, Overflow::wrap>>(comparison, sources);
  compare_quantise<Fixed<W, I, Round::half_up, Overflow::saturate>>(comparison, sources);
  compare_quantise<Fixed<W, I, Round::half_up, Overflow::saturate_symmetric>>(comparison, sources);
  compare_quantise<Fixed<W, I, Round::half_even, Overflow::wrap>>(comparison, sources);
  compare_quantise<Fixed<W, I, Round::half_even, Overflow::saturate>>(comparison, sources);
  compare_quantise<Fixed<W, I, Round::half_even, Overflow::saturate_symmetric>>(comparison, sources);
}

template <class A, class B>
void compare_order(Comparison& comparison, A a, B b) {
  const Sc<A> x = to_sc(a);
  const Sc<B> y = to_sc(b);
  comparison.check("==", a == b, x == y, a, b);
  comparison.check("!=", a != b, x != y, a, b);
  comparison.check("<", a < b, x < y, a, b);
  comparison.check("<=", a <= b, x <= y, a, b);
  comparison.check(">", a > b, x > y, a, b);
  comparison.check(">=", a >= b, x >= y, a, b);
  comparison.check("is_negative", is_negative(a), x < 0, a, b);
}

template <class A, class B>
void compare_wrap(Comparison& comparison, A a, B b) {
  using Wrapped = Fixed<A::width, A::integer>;
  if constexpr (B::fraction <= A::fraction) {
    comparison.check("wrap_add", raw(wrap_add(a, b)), word_of<A>(quantise_sc<Wrapped>(to_sc(a) + to_sc(b))),
                     a, b);
    comparison.check("wrap_sub", raw(wrap_sub(a, b)), word_of<A>(quantise_sc<Wrapped>(to_sc(a) - to_sc(b))),
                     a, b);
  }
}

template <class A, class B>
void compare_arithmetic(Comparison& comparison, A a, B b) {
  constexpr int sum_width = std::max(A::integer, B::integer) + 1 + std::max(A::fraction, B::fraction);
  if constexpr (sum_width <= 63) {
    using Sum = decltype(a + b);
    comparison.check("+", raw(a + b), word_of<Sum>(to_sc(a) + to_sc(b)), a, b);
    comparison.check("-", raw(a - b), word_of<Sum>(to_sc(a) - to_sc(b)), a, b);
  }
  if constexpr (A::width + B::width <= 63) {
    comparison.check("*", raw(a * b), word_of<decltype(a * b)>(to_sc(a) * to_sc(b)), a, b);
  }
  if constexpr (A::width < 63) {
    comparison.check("unary -", raw(-a), word_of<decltype(-a)>(-to_sc(a)), a, b);
  }
}

/// Every second operand meets `per_operand` of the first ones, and itself where the types allow it: random
/// pairs alone would hardly ever be equal.
template <class A, class B>
void compare_pair(Comparison& comparison, std::uint64_t seed, std::size_t per_operand) {
  const std::vector<A> first = samples<A>(100, seed);
  std::mt19937_64 random(seed);
  for (const B& b : samples<B>(100, seed + 1)) {
    std::vector<A> partners{A(b), wrap_sub(A(b), from_raw<A>(1)), wrap_add(A(b), from_raw<A>(1))};
    for (std::size_t i = 0; i < per_operand; ++i) partners.push_back(first[random() % first.size()]);
    for (const A& a : partners) {
      compare_order(comparison, a, b);
      compare_wrap(comparison, a, b);
      compare_arithmetic(comparison, a, b);
    }
  }
}

/// Widths of 1 to 63 bits with binary points from far outside on the left to far outside on the right,
/// spread by the multiplicative congruence of Lehmer over the index.
template <std::size_t Index>
struct Shape {
  static constexpr std::uint64_t state = (Index + 1) * 48271 * 48271 % 2147483647 * 48271 % 2147483647;
  static constexpr int width = static_cast<int>(state % 63) + 1;
  static constexpr int integer = static_cast<int>(state / 63 % 48) - 6;
};

template <std::size_t Index>
using ShapeType = Fixed<Shape<Index>::width, Shape<Index>::integer>;

template <std::size_t... Index>
void compare_shapes_quantised(Comparison& comparison, std::index_sequence<Index...>) {
  (compare_modes<Shape<2 * Index>::width, Shape<2 * Index>::integer, ShapeType<2 * Index + 1>>(comparison,
                                                                                               Index, 1000),
   ...);
}

template <std::size_t... Index>
void compare_shape_pairs(Comparison& comparison, std::index_sequence<Index...>) {
  (compare_pair<ShapeType<2 * Index>, ShapeType<2 * Index + 1>>(comparison, Index, 5), ...);
}

TEST(FixedAgainstSystemC, QuantiseNarrowsAndWidens) {
  Comparison comparison;
  compare_modes<16, 1, Fixed<24, 1>>(comparison, 1, 3000);
  compare_modes<16, 1, Fixed<46, 20>>(comparison, 2, 3000);
  compare_modes<24, 1, Fixed<16, 1>>(comparison, 3, 3000);
  compare_modes<24, 2, Fixed<40, 2>>(comparison, 4, 3000);
  compare_modes<32, 16, Fixed<33, 16>>(comparison, 5, 3000);
  compare_modes<33, 16, Fixed<32, 15>>(comparison, 6, 3000);
  compare_modes<18, -4, Fixed<30, -2>>(comparison, 7, 3000);
  compare_modes<12, 20, Fixed<40, 22>>(comparison, 8, 3000);
  compare_modes<63, 20, Fixed<63, 21>>(comparison, 9, 3000);
  compare_modes<63, 21, Fixed<63, 20>>(comparison, 10, 3000);
  compare_modes<63, 0, Fixed<63, 62>>(comparison, 11, 3000);
  compare_modes<63, 63, Fixed<63, 0>>(comparison, 12, 3000);
  compare_modes<63, 64, Fixed<63, 0>>(comparison, 13, 3000);
  compare_modes<1, 1, Fixed<63, 2>>(comparison, 14, 3000);
  compare_modes<63, 2, Fixed<1, 1>>(comparison, 15, 0);
  compare_modes<62, 8, Fixed<62, 8, Round::half_up, Overflow::saturate_symmetric>>(comparison, 16, 3000);
  compare_modes<8, -70, Fixed<20, 3>>(comparison, 17, 3000);
  compare_modes<8, 90, Fixed<20, 3>>(comparison, 18, 3000);
  comparison.finish(1'000'000);
}

TEST(FixedAgainstSystemC, QuantiseInSpreadShapes) {
  Comparison comparison;
  compare_shapes_quantised(comparison, std::make_index_sequence<16>());
  comparison.finish(300'000);
}

TEST(FixedAgainstSystemC, ArithmeticAndOrder) {
  Comparison comparison;
  compare_pair<Fixed<16, 1>, Fixed<16, 1>>(comparison, 1, 10);
  compare_pair<Fixed<24, 1>, Fixed<18, 3>>(comparison, 2, 10);
  compare_pair<Fixed<46, 22>, Fixed<17, -2>>(comparison, 3, 10);
  compare_pair<Fixed<32, 1>, Fixed<31, 1>>(comparison, 4, 10);
  compare_pair<Fixed<62, 40>, Fixed<62, 40>>(comparison, 5, 10);
  compare_pair<Fixed<62, 40>, Fixed<1, -22>>(comparison, 6, 10);
  compare_pair<Fixed<63, 1>, Fixed<63, 1>>(comparison, 7, 10);
  compare_pair<Fixed<63, 0>, Fixed<63, 63>>(comparison, 8, 10);
  compare_pair<Fixed<63, 63>, Fixed<63, 0>>(comparison, 9, 10);
  compare_pair<Fixed<48, 0>, Fixed<40, 2>>(comparison, 10, 10);
  compare_pair<Fixed<12, -60>, Fixed<5, 70>>(comparison, 11, 10);
  compare_pair<Fixed<1, 1>, Fixed<1, 1>>(comparison, 13, 10);
  comparison.finish(200'000);
}

TEST(FixedAgainstSystemC, ArithmeticAndOrderInSpreadShapes) {
  Comparison comparison;
  compare_shape_pairs(comparison, std::make_index_sequence<24>());
  comparison.finish(300'000);
}

TEST(FixedAgainstSystemC, ShiftAndScale) {
  Comparison comparison;
  const auto compare = [&comparison](auto zero) {
    using T = decltype(zero);
    for (const T& x : samples<T>(500, 1)) {
      for (int n = 0; n < 64; ++n) {
        comparison.check("shift_right", raw(shift_right(x, n)), word_of<T>(quantise_sc<T>(to_sc(x) >> n)), x,
                         T{});
      }
      const auto larger = scale<7>(x);
      const auto smaller = scale<-70>(x);
      comparison.check("scale<7>", raw(larger), word_of<decltype(larger)>(to_sc(x) << 7), x, T{});
      comparison.check("scale<-70>", raw(smaller), word_of<decltype(smaller)>(to_sc(x) >> 70), x, T{});
    }
  };
  compare(Fixed<16, 1>{});
  compare(Fixed<46, 20>{});
  compare(Fixed<63, -3>{});
  compare(Fixed<63, 70>{});
  comparison.finish(100'000);
}

}  // namespace
}  // namespace hemi::hls
