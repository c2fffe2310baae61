// SPDX-License-Identifier: Apache-2.0
//
// The contract of hls/fixed.hpp for whichever backend HEMI_FIXED_BACKEND names, against rational
// arithmetic on integers of unlimited length written from the definitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "hls/fixed.hpp"

namespace hemi::hls {
namespace {

using boost::multiprecision::cpp_int;

/// n * 2^-f.
struct Exact {
  cpp_int n;
  int f;
};

cpp_int power(int exponent) {
  return cpp_int(1) << exponent;
}

cpp_int floor_div(const cpp_int& a, const cpp_int& b) {
  const cpp_int quotient = a / b;
  return quotient * b > a ? quotient - 1 : quotient;
}

/// x * 2^f rounded to an integer.
cpp_int rounded(const Exact& x, int f, Round mode) {
  if (f >= x.f) return x.n * power(f - x.f);
  const cpp_int unit = power(x.f - f);
  const cpp_int below = floor_div(x.n, unit);
  const cpp_int twice_rest = 2 * (x.n - below * unit);
  const bool tie_up = mode == Round::half_up || below % 2 != 0;
  const bool up = twice_rest > unit || (twice_rest == unit && tie_up);
  return mode != Round::floor && up ? below + 1 : below;
}

cpp_int wrapped(const cpp_int& word, int width) {
  return word - floor_div(word + power(width - 1), power(width)) * power(width);
}

template <int W, int I, Round R = Round::floor, Overflow O = Overflow::wrap>
struct Format {
  using Type = Fixed<W, I, R, O>;
  static constexpr int width = W;
  static constexpr int integer = I;
  static constexpr int fraction = W - I;
  static constexpr Overflow overflow = O;

  static cpp_int high() { return power(W - 1) - 1; }
  static cpp_int low() { return O == Overflow::saturate_symmetric ? -high() : -high() - 1; }

  static bool saturates(const Exact& x) {
    const cpp_int word = rounded(x, fraction, R);
    return word < low() || word > high();
  }

  static cpp_int quantise(const Exact& x) {
    const cpp_int word = rounded(x, fraction, R);
    if (O == Overflow::wrap) return wrapped(word, W);
    return std::clamp(word, low(), high());
  }
};

/// Words at the ends, around zero and around powers of two, and random ones of random magnitude.
template <class F>
std::vector<std::int64_t> words(std::mt19937_64& random) {
  constexpr std::int64_t max = (std::int64_t{1} << (F::width - 1)) - 1;
  std::vector<std::int64_t> candidates{-max - 1, -max, max, max - 1, -1, 0, 1};
  for (int bit = 1; bit < F::width - 1; bit += 3) {
    const std::int64_t x = std::int64_t{1} << bit;
    candidates.insert(candidates.end(), {x - 1, x, x + 1, -x, -x - 1, x + x / 2});
  }
  for (int i = 0; i < 60; ++i) {
    const std::uint64_t bits = random();
    candidates.push_back(static_cast<std::int64_t>(bits) >> (random() % 64));
  }
  std::vector<std::int64_t> result;
  for (const std::int64_t word : candidates) {
    const cpp_int held = wrapped(word, F::width);
    if (held >= F::low()) result.push_back(static_cast<std::int64_t>(held));
  }
  return result;
}

class FixedBackend : public testing::Test {
 protected:
  ~FixedBackend() override {
    std::cout << cases_ << " cases, backend " << HEMI_FIXED_BACKEND << '\n';
    RecordProperty("cases", std::to_string(cases_));
  }

  void check(const char* operation, const cpp_int& actual, const cpp_int& expected, std::int64_t a,
             std::int64_t b) {
    ++cases_;
    if (actual == expected) return;
    if (++differences_ <= 20) {
      ADD_FAILURE() << operation << " of words " << a << ", " << b << " is " << actual << ", expected "
                    << expected;
    }
  }

  template <class Source, class Target>
  void check_quantise() {
    using S = typename Source::Type;
    using T = typename Target::Type;
    for (const std::int64_t word : words<Source>(random_)) {
      const S x = from_raw<S>(word);
      const Exact value{word, Source::fraction};
      check("raw", raw(x), word, word, 0);
      check("quantise", raw(quantise<T>(x)), Target::quantise(value), word, 0);
      check("conversion", raw(T(x)), Target::quantise(value), word, 0);
      check("saturates", saturates<T>(x), Target::saturates(value), word, 0);
      check("is_negative", is_negative(x), word < 0, word, 0);
    }
  }

  template <int Wt, int It, class Source>
  void check_modes() {
    check_quantise<Source, Format<Wt, It, Round::floor, Overflow::wrap>>();
    check_quantise<Source, Format<Wt, It, Round::floor, Overflow::saturate>>();
    check_quantise<Source, Format<Wt, It, Round::floor, Overflow::saturate_symmetric>>();
    check_quantise<Source, Format<Wt, It, Round::half_up, Overflow::wrap>>();
    check_quantise<Source, Format<Wt, It, Round::half_up, Overflow::saturate>>();
    check_quantise<Source, Format<Wt, It, Round::half_up, Overflow::saturate_symmetric>>();
    check_quantise<Source, Format<Wt, It, Round::half_even, Overflow::wrap>>();
    check_quantise<Source, Format<Wt, It, Round::half_even, Overflow::saturate>>();
    check_quantise<Source, Format<Wt, It, Round::half_even, Overflow::saturate_symmetric>>();
  }

  template <class A, class B>
  void check_pair() {
    const std::vector<std::int64_t> second = words<B>(random_);
    for (const std::int64_t a : words<A>(random_)) {
      for (int i = 0; i < 12; ++i) check_words<A, B>(a, second[random_() % second.size()]);
    }
  }

 private:
  template <class A, class B>
  void check_words(std::int64_t a, std::int64_t b) {
    constexpr int f = std::max(A::fraction, B::fraction);
    constexpr int integer = std::max(A::integer, B::integer) + 1;
    const cpp_int aligned_a = cpp_int(a) * power(f - A::fraction);
    const cpp_int aligned_b = cpp_int(b) * power(f - B::fraction);
    const auto x = from_raw<typename A::Type>(a);
    const auto y = from_raw<typename B::Type>(b);
    if constexpr (integer + f <= 63) {
      using Sum = Fixed<integer + f, integer>;
      check("+", raw(quantise<Sum>(x + y)), aligned_a + aligned_b, a, b);
      check("-", raw(quantise<Sum>(x - y)), aligned_a - aligned_b, a, b);
    }
    if constexpr (A::width + B::width <= 63) {
      using Product = Fixed<A::width + B::width, A::integer + B::integer>;
      check("*", raw(quantise<Product>(x * y)), cpp_int(a) * b, a, b);
      using Rounded = Format<24, 2, Round::half_even, Overflow::saturate>;
      const Exact product{cpp_int(a) * b, A::fraction + B::fraction};
      check("quantised *", raw(quantise<Rounded::Type>(x * y)), Rounded::quantise(product), a, b);
      check("saturates *", saturates<Rounded::Type>(x * y), Rounded::saturates(product), a, b);
    }
    if constexpr (A::width < 63) {
      using Negative = Fixed<A::width + 1, A::integer + 1>;
      check("unary -", raw(quantise<Negative>(-x)), -cpp_int(a), a, b);
    }
    if constexpr (B::fraction <= A::fraction) {
      check("wrap_add", raw(wrap_add(x, y)), wrapped(aligned_a + aligned_b, A::width), a, b);
      check("wrap_sub", raw(wrap_sub(x, y)), wrapped(aligned_a - aligned_b, A::width), a, b);
    }
    check_order(x, y, aligned_a, aligned_b, a, b);
    const int n = static_cast<int>(random_() % 64);
    check("shift_right", raw(shift_right(x, n)), floor_div(a, power(n)), a, n);
    static_assert(fixed_traits<decltype(scale<-9>(x))>::fraction == A::fraction + 9);
    check("scale", raw(scale<-9>(x)), a, a, -9);
    check("scale", raw(scale<70>(x)), a, a, 70);
  }

  template <class X, class Y>
  void check_order(const X& x, const Y& y, const cpp_int& a, const cpp_int& b, std::int64_t word_a,
                   std::int64_t word_b) {
    check("==", x == y, a == b, word_a, word_b);
    check("!=", x != y, a != b, word_a, word_b);
    check("<", x < y, a < b, word_a, word_b);
    check("<=", x <= y, a <= b, word_a, word_b);
    check(">", x > y, a > b, word_a, word_b);
    check(">=", x >= y, a >= b, word_a, word_b);
  }

  std::mt19937_64 random_{20};
  std::uint64_t cases_ = 0;
  std::uint64_t differences_ = 0;
};

TEST_F(FixedBackend, Quantise) {
  check_modes<16, 1, Format<24, 1>>();
  check_modes<16, 1, Format<46, 20>>();
  check_modes<24, 1, Format<16, 1>>();
  check_modes<24, 2, Format<40, 2>>();
  check_modes<33, 16, Format<32, 15>>();
  check_modes<18, -4, Format<30, -2>>();
  check_modes<12, 20, Format<40, 22>>();
  check_modes<63, 20, Format<63, 21>>();
  check_modes<63, 21, Format<63, 20>>();
  check_modes<63, 0, Format<63, 62>>();
  check_modes<63, 63, Format<63, 0>>();
  check_modes<30, 2, Format<30, 2, Round::half_up, Overflow::saturate_symmetric>>();
}

TEST_F(FixedBackend, ArithmeticOrderShiftAndWrap) {
  check_pair<Format<16, 1>, Format<16, 1>>();
  check_pair<Format<24, 1>, Format<18, 3>>();
  check_pair<Format<46, 22>, Format<17, -2>>();
  check_pair<Format<32, 1, Round::half_up, Overflow::saturate>, Format<31, 1>>();
  check_pair<Format<62, 40>, Format<62, 40>>();
  check_pair<Format<63, 1>, Format<63, 1>>();
  check_pair<Format<63, 0>, Format<63, 63>>();
  check_pair<Format<48, 0>, Format<40, 2, Round::half_even, Overflow::saturate_symmetric>>();
  check_pair<Format<12, -20>, Format<5, 40>>();
}

}  // namespace
}  // namespace hemi::hls
