// SPDX-License-Identifier: Apache-2.0
//
// Backend 1 of hls/fixed.hpp, where the contract stands: ap_fixed of AMD's Vitis HLS. Its expressions
// are of type ap_fixed_base, from which ap_fixed derives.
#ifndef HEMI_HLS_FIXED_AP_HPP_
#define HEMI_HLS_FIXED_AP_HPP_

#include <ap_fixed.h>

#include <cstdint>

#include "hls/fixed_modes.hpp"

namespace hemi {
namespace hls {
namespace detail {

constexpr ap_q_mode ap_rounding(Round mode) {
  return mode == Round::floor ? AP_TRN : (mode == Round::half_up ? AP_RND : AP_RND_CONV);
}

constexpr ap_o_mode ap_overflow(Overflow mode) {
  return mode == Overflow::wrap ? AP_WRAP : (mode == Overflow::saturate ? AP_SAT : AP_SAT_SYM);
}

}  // namespace detail

/// ap_fixed, but zero where nothing else is said: AMD's own leaves the word undefined.
template <int W, int I, Round R = Round::floor, Overflow O = Overflow::wrap>
struct Fixed : ap_fixed<W, I, detail::ap_rounding(R), detail::ap_overflow(O)> {
  using Vendor = ap_fixed<W, I, detail::ap_rounding(R), detail::ap_overflow(O)>;
  Fixed() : Vendor(0) {}
  Fixed(const Vendor& x) : Vendor(x) {}
  using Vendor::Vendor;
};

template <int W, int I, ap_q_mode Q, ap_o_mode O, int N>
struct fixed_traits<ap_fixed_base<W, I, true, Q, O, N>> {
  static_assert(W >= 1 && W <= 63, "Fixed holds 1 to 63 bits: quantise the operands before this operation");
  static constexpr int width = W;
  static constexpr int integer = I;
  static constexpr int fraction = W - I;
};

template <int W, int I, ap_q_mode Q, ap_o_mode O, int N>
struct fixed_traits<ap_fixed<W, I, Q, O, N>> : fixed_traits<ap_fixed_base<W, I, true, Q, O, N>> {};

template <int W, int I, Round R, Overflow O>
struct fixed_traits<Fixed<W, I, R, O>> : fixed_traits<typename Fixed<W, I, R, O>::Vendor> {};

template <int W, int I, ap_q_mode Q, ap_o_mode O, int N>
std::int64_t raw(const ap_fixed_base<W, I, true, Q, O, N>& x) {
  static_assert(W <= 63, "raw: quantise to at most 63 bits first");
  const ap_int<W> bits(x.range(W - 1, 0));
  return bits.to_int64();
}

template <class T>
T from_raw(std::int64_t word) {
  T x;
  x.V = ap_int<fixed_traits<T>::width>(word).V;
  return x;
}

template <class T, int W, int I, ap_q_mode Q, ap_o_mode O, int N>
T quantise(const ap_fixed_base<W, I, true, Q, O, N>& x) {
  return T(x);
}

namespace detail {

template <class T>
struct ApSaturationTest;

template <int W, int I, ap_q_mode Q, ap_o_mode O>
struct ApSaturationTest<ap_fixed<W, I, Q, O>> {
  /// Rounds like the target into a type that holds every rounded x, then asks whether the target does.
  template <class X>
  static bool apply(const X& x) {
    constexpr int integer = (fixed_traits<X>::integer > I ? fixed_traits<X>::integer : I) + 1;
    const ap_fixed<integer + W - I, integer, Q, AP_WRAP> rounded(x);
    return rounded != ap_fixed<W, I, Q, O>(rounded);
  }
};

template <int W, int I, Round R, Overflow O>
struct ApSaturationTest<Fixed<W, I, R, O>> : ApSaturationTest<typename Fixed<W, I, R, O>::Vendor> {};

}  // namespace detail

template <class T, int W, int I, ap_q_mode Q, ap_o_mode O, int N>
bool saturates(const ap_fixed_base<W, I, true, Q, O, N>& x) {
  return detail::ApSaturationTest<T>::apply(x);
}

template <int W, int I, ap_q_mode Q, ap_o_mode O, int N>
bool is_negative(const ap_fixed_base<W, I, true, Q, O, N>& x) {
  return x[W - 1];
}

template <int W, int I, ap_q_mode Q, ap_o_mode O>
ap_fixed<W, I, Q, O> shift_right(const ap_fixed<W, I, Q, O>& x, int n) {
  const ap_int<W> bits(x.range(W - 1, 0));
  ap_fixed<W, I, Q, O> y;
  y.V = ap_int<W>(bits >> n).V;
  return y;
}

template <int S, int W, int I, ap_q_mode Q, ap_o_mode O>
ap_fixed<W, I + S, Q, O> scale(const ap_fixed<W, I, Q, O>& x) {
  ap_fixed<W, I + S, Q, O> y;
  y.V = x.V;
  return y;
}

template <int W, int I, ap_q_mode Q, ap_o_mode O, int Wb, int Ib, ap_q_mode Qb, ap_o_mode Ob>
ap_fixed<W, I, Q, O> wrap_add(const ap_fixed<W, I, Q, O>& a, const ap_fixed<Wb, Ib, Qb, Ob>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_add: the second operand has more fraction bits than the first");
  const ap_fixed<W, I> wrapped(a + b);
  return ap_fixed<W, I, Q, O>(wrapped);
}

template <int W, int I, ap_q_mode Q, ap_o_mode O, int Wb, int Ib, ap_q_mode Qb, ap_o_mode Ob>
ap_fixed<W, I, Q, O> wrap_sub(const ap_fixed<W, I, Q, O>& a, const ap_fixed<Wb, Ib, Qb, Ob>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_sub: the second operand has more fraction bits than the first");
  const ap_fixed<W, I> wrapped(a - b);
  return ap_fixed<W, I, Q, O>(wrapped);
}

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_FIXED_AP_HPP_
