// SPDX-License-Identifier: Apache-2.0
//
// Backend 0 of hls/fixed.hpp, where the contract stands. The word is kept sign-extended, so a value
// is read without any work; arithmetic runs in 64 bits and the compiler, of a processor or of a
// circuit, finds the widths from the shifts. Right shifts of negative words are arithmetic and
// conversions to signed are modulo 2^64, which C++14 leaves to the compiler and all of ours do.
#ifndef HEMI_HLS_FIXED_OWN_HPP_
#define HEMI_HLS_FIXED_OWN_HPP_

#include <cstdint>
#include <type_traits>

#include "hls/fixed_modes.hpp"

namespace hemi {
namespace hls {

template <int W, int I, Round R = Round::floor, Overflow O = Overflow::wrap>
class Fixed;

template <int W, int I, Round R, Overflow O>
constexpr std::int64_t raw(const Fixed<W, I, R, O>& x);
template <class T>
constexpr T from_raw(std::int64_t word);

namespace detail {

/// from_raw for a word that is known to fit: nothing to cut off.
template <class T>
constexpr T from_fitting(std::int64_t word);

constexpr int larger(int a, int b) {
  return a > b ? a : b;
}
constexpr int clamp(int x, int low, int high) {
  return x < low ? low : (x > high ? high : x);
}

/// The low W bits, sign-extended.
template <int W>
constexpr std::int64_t wrap(std::uint64_t bits) {
  return static_cast<std::int64_t>(bits << (64 - W)) >> (64 - W);
}

/// word * 2^N modulo 2^64, N >= 0.
template <int N>
constexpr std::uint64_t shift_left(std::int64_t word) {
  return N > 63 ? 0 : static_cast<std::uint64_t>(word) << clamp(N, 0, 63);
}

/// floor(word * 2^-N), N >= 0.
template <int N>
constexpr std::int64_t shift_down(std::int64_t word) {
  return word >> clamp(N, 0, 63);
}

/// word * 2^-N rounded to an integer, N >= 0, for a word of at most 63 bits. The sums stay below
/// 2^62 + 2^61; from N = 63 on the value lies in [-1/2, 1/2) and both nearest modes give 0.
template <Round R, int N>
constexpr std::int64_t drop_bits(std::int64_t word) {
  constexpr int n = clamp(N, 1, 62);
  constexpr std::int64_t half = std::int64_t{1} << (n - 1);
  if (N <= 0) return word;
  if (R == Round::floor) return shift_down<N>(word);
  if (N > 62) return 0;
  if (R == Round::half_up) return (word + half) >> n;
  return (word + (half - 1) + ((word >> n) & 1)) >> n;
}

/// Quantisation of a word with Ws bits, Fs of them fraction, to W bits, F of them fraction.
template <int Ws, int Fs, int W, int F, Round R, Overflow O>
struct Quantiser {
  static constexpr int dropped = Fs > F ? Fs - F : 0;
  static constexpr int added = F > Fs ? F - Fs : 0;
  /// Bits that hold every rounded word; rounding to nearest can carry into a new one.
  static constexpr int bits = larger(Ws - dropped, 1) + (dropped > 0 && R != Round::floor ? 1 : 0) + added;
  static constexpr bool fits = O == Overflow::saturate_symmetric ? bits < W : bits <= W;

  static constexpr std::int64_t max = static_cast<std::int64_t>((std::uint64_t{1} << (W - 1)) - 1);
  static constexpr std::int64_t min = O == Overflow::saturate_symmetric ? -max : -max - 1;
  /// The same range on the rounded word before it moves up by `added` bits.
  static constexpr std::int64_t high = shift_down<added>(max);
  static constexpr std::int64_t low = O == Overflow::saturate_symmetric || added >= W ? -high : -high - 1;

  static constexpr bool overflows(std::int64_t word) {
    const std::int64_t rounded = drop_bits<R, dropped>(word);
    return !fits && (rounded < low || rounded > high);
  }

  static constexpr std::int64_t apply(std::int64_t word) {
    const std::int64_t rounded = drop_bits<R, dropped>(word);
    const std::uint64_t moved = shift_left<added>(rounded);
    if (fits) return static_cast<std::int64_t>(moved);
    if (O == Overflow::wrap) return wrap<W>(moved);
    return rounded < low ? min : (rounded > high ? max : static_cast<std::int64_t>(moved));
  }
};

}  // namespace detail

/// See hls/fixed.hpp.
template <int W, int I, Round R, Overflow O>
class Fixed {
  static_assert(W >= 1 && W <= 63, "Fixed holds 1 to 63 bits: quantise the operands before this operation");

 public:
  static constexpr int width = W;
  static constexpr int integer = I;
  static constexpr int fraction = W - I;

  constexpr Fixed() = default;

  /// Quantises with the rounding and overflow modes of this type.
  template <int Ws, int Is, Round Rs, Overflow Os>
  constexpr explicit Fixed(const Fixed<Ws, Is, Rs, Os>& x)
      : word_(static_cast<Word>(detail::Quantiser<Ws, Ws - Is, W, W - I, R, O>::apply(raw(x)))) {}

 private:
  using Word = typename std::conditional<(W <= 32), std::int32_t, std::int64_t>::type;

  friend constexpr std::int64_t raw<W, I, R, O>(const Fixed& x);
  friend constexpr Fixed detail::from_fitting<Fixed>(std::int64_t word);

  Word word_ = 0;
};

template <int W, int I, Round R, Overflow O>
struct fixed_traits<Fixed<W, I, R, O>> {
  static constexpr int width = W;
  static constexpr int integer = I;
  static constexpr int fraction = W - I;
};

template <int W, int I, Round R, Overflow O>
constexpr std::int64_t raw(const Fixed<W, I, R, O>& x) {
  return x.word_;
}

template <class T>
constexpr T detail::from_fitting(std::int64_t word) {
  T x;
  x.word_ = static_cast<typename T::Word>(word);
  return x;
}

template <class T>
constexpr T from_raw(std::int64_t word) {
  return detail::from_fitting<T>(detail::wrap<T::width>(static_cast<std::uint64_t>(word)));
}

template <class T, int W, int I, Round R, Overflow O>
constexpr T quantise(const Fixed<W, I, R, O>& x) {
  return T(x);
}

namespace detail {

template <class T>
struct SaturationTest;

template <int W, int I, Round R, Overflow O>
struct SaturationTest<Fixed<W, I, R, O>> {
  template <int Ws, int Is, Round Rs, Overflow Os>
  static constexpr bool apply(const Fixed<Ws, Is, Rs, Os>& x) {
    return Quantiser<Ws, Ws - Is, W, W - I, R, O>::overflows(raw(x));
  }
};

template <int Ia, int Fa, int Ib, int Fb>
using SumType = Fixed<larger(Ia, Ib) + 1 + larger(Fa, Fb), larger(Ia, Ib) + 1>;

/// x's word on the finer grid of T, which holds it.
template <class T, int W, int I, Round R, Overflow O>
constexpr std::int64_t aligned(const Fixed<W, I, R, O>& x) {
  return static_cast<std::int64_t>(shift_left<T::fraction - (W - I)>(raw(x)));
}

}  // namespace detail

template <class T, int W, int I, Round R, Overflow O>
constexpr bool saturates(const Fixed<W, I, R, O>& x) {
  return detail::SaturationTest<T>::apply(x);
}

template <int W, int I, Round R, Overflow O>
constexpr bool is_negative(const Fixed<W, I, R, O>& x) {
  return raw(x) < 0;
}

template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr detail::SumType<Ia, Wa - Ia, Ib, Wb - Ib> operator+(const Fixed<Wa, Ia, Ra, Oa>& a,
                                                              const Fixed<Wb, Ib, Rb, Ob>& b) {
  using Sum = detail::SumType<Ia, Wa - Ia, Ib, Wb - Ib>;
  return detail::from_fitting<Sum>(detail::aligned<Sum>(a) + detail::aligned<Sum>(b));
}

template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr detail::SumType<Ia, Wa - Ia, Ib, Wb - Ib> operator-(const Fixed<Wa, Ia, Ra, Oa>& a,
                                                              const Fixed<Wb, Ib, Rb, Ob>& b) {
  using Sum = detail::SumType<Ia, Wa - Ia, Ib, Wb - Ib>;
  return detail::from_fitting<Sum>(detail::aligned<Sum>(a) - detail::aligned<Sum>(b));
}

template <int W, int I, Round R, Overflow O>
constexpr Fixed<W + 1, I + 1> operator-(const Fixed<W, I, R, O>& x) {
  return detail::from_fitting<Fixed<W + 1, I + 1>>(-raw(x));
}

template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr Fixed<Wa + Wb, Ia + Ib> operator*(const Fixed<Wa, Ia, Ra, Oa>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  return detail::from_fitting<Fixed<Wa + Wb, Ia + Ib>>(raw(a) * raw(b));
}

/// a * 2^D < b on integers: the finer operand is cut to the coarser grid (by the floor on the left of
/// `<`, by the ceiling on the right), so that no word grows and nothing is lost from the answer.
template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr bool operator<(const Fixed<Wa, Ia, Ra, Oa>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  constexpr int finer = (Wa - Ia) - (Wb - Ib);
  return finer >= 0 ? detail::shift_down<finer>(raw(a)) < raw(b)
                    : raw(a) < -detail::shift_down<-finer>(-raw(b));
}

/// The finer word must be the coarser one with zeros behind it; both shifts together say so for any
/// distance, as a nonzero word of 63 bits never equals one that is 63 or more places away.
template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr bool operator==(const Fixed<Wa, Ia, Ra, Oa>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  constexpr int distance = (Wa - Ia) - (Wb - Ib);
  constexpr int n = detail::clamp(distance < 0 ? -distance : distance, 0, 63);
  const std::int64_t fine = distance >= 0 ? raw(a) : raw(b);
  const std::int64_t coarse = distance >= 0 ? raw(b) : raw(a);
  return (fine >> n) == coarse && detail::shift_left<n>(coarse) == static_cast<std::uint64_t>(fine);
}

template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr bool operator!=(const Fixed<Wa, Ia, Ra, Oa>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  return !(a == b);
}

template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr bool operator>(const Fixed<Wa, Ia, Ra, Oa>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  return b < a;
}

template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr bool operator<=(const Fixed<Wa, Ia, Ra, Oa>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  return !(b < a);
}

template <int Wa, int Ia, Round Ra, Overflow Oa, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr bool operator>=(const Fixed<Wa, Ia, Ra, Oa>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  return !(a < b);
}

template <int W, int I, Round R, Overflow O>
constexpr Fixed<W, I, R, O> shift_right(const Fixed<W, I, R, O>& x, int n) {
  return detail::from_fitting<Fixed<W, I, R, O>>(raw(x) >> n);
}

template <int N, int W, int I, Round R, Overflow O>
constexpr Fixed<W, I + N, R, O> scale(const Fixed<W, I, R, O>& x) {
  return detail::from_fitting<Fixed<W, I + N, R, O>>(raw(x));
}

template <int W, int I, Round R, Overflow O, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr Fixed<W, I, R, O> wrap_add(const Fixed<W, I, R, O>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_add: the second operand has more fraction bits than the first");
  return from_raw<Fixed<W, I, R, O>>(static_cast<std::int64_t>(
      static_cast<std::uint64_t>(raw(a)) + detail::shift_left<(W - I) - (Wb - Ib)>(raw(b))));
}

template <int W, int I, Round R, Overflow O, int Wb, int Ib, Round Rb, Overflow Ob>
constexpr Fixed<W, I, R, O> wrap_sub(const Fixed<W, I, R, O>& a, const Fixed<Wb, Ib, Rb, Ob>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_sub: the second operand has more fraction bits than the first");
  return from_raw<Fixed<W, I, R, O>>(static_cast<std::int64_t>(
      static_cast<std::uint64_t>(raw(a)) - detail::shift_left<(W - I) - (Wb - Ib)>(raw(b))));
}

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_FIXED_OWN_HPP_
