// SPDX-License-Identifier: Apache-2.0
//
// Backend 1 of hls/fixed.hpp, where the contract stands: ap_fixed of AMD's Vitis HLS. Its
// expressions are ap_fixed_base, from which ap_fixed derives.
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

template <int W, int I, Round R = Round::floor, Overflow O = Overflow::wrap>
using Fixed = ap_fixed<W, I, detail::ap_rounding(R), detail::ap_overflow(O)>;

template <int W, int I, ap_q_mode Q, ap_o_mode O>
struct fixed_traits<ap_fixed<W, I, Q, O>> {
  static_assert(W >= 1 && W <= 63, "Fixed holds 1 to 63 bits: quantise the operands before this operation");
  static constexpr int width = W;
  static constexpr int integer = I;
  static constexpr int fraction = W - I;
};

template <int W, int I, ap_q_mode Q, ap_o_mode O>
std::int64_t raw(const ap_fixed_base<W, I, true, Q, O, NN>& x) {
  static_assert(W <= 63, "raw: quantise to at most 63 bits first");
  return x.template slc<W>(0).to_int64();
}

template <class T>
T from_raw(std::int64_t word) {
  T x;
  x.set_slc(0, ap_int<fixed_traits<T>::width>(static_cast<long long>(word)));
  return x;
}

template <class T, int W, int I, ap_q_mode Q, ap_o_mode O>
T quantise(const ap_fixed_base<W, I, true, Q, O, NN>& x) {
  return T(x);
}

namespace detail {

template <class T>
struct ApSaturationTest;

template <int W, int I, ap_q_mode Q, ap_o_mode O>
struct ApSaturationTest<ap_fixed<W, I, Q, O>> {
  /// Rounds like the target into a type that holds every rounded x, then asks whether the target does.
  template <int Wx, int Ix, ap_q_mode Qx, ap_o_mode Ox>
  static bool apply(const ap_fixed_base<Wx, Ix, true, Qx, Ox, NN>& x) {
    constexpr int integer = (Ix > I ? Ix : I) + 1;
    const ap_fixed<integer + W - I, integer, Q, AP_WRAP> rounded(x);
    return rounded != ap_fixed<W, I, Q, O>(rounded);
  }
};

}  // namespace detail

template <class T, int W, int I, ap_q_mode Q, ap_o_mode O>
bool saturates(const ap_fixed_base<W, I, true, Q, O, NN>& x) {
  return detail::ApSaturationTest<T>::apply(x);
}

template <int W, int I, ap_q_mode Q, ap_o_mode O>
bool is_negative(const ap_fixed_base<W, I, true, Q, O, NN>& x) {
  return x[W - 1];
}

template <int W, int I, ap_q_mode Q, ap_o_mode O>
ap_fixed<W, I, Q, O> shift_right(const ap_fixed_base<W, I, true, Q, O, NN>& x, int n) {
  return from_raw<ap_fixed<W, I, Q, O>>((x.template slc<W>(0) >> n).to_int64());
}

template <int N, int W, int I, ap_q_mode Q, ap_o_mode O>
ap_fixed<W, I + N, Q, O> scale(const ap_fixed_base<W, I, true, Q, O, NN>& x) {
  ap_fixed<W, I + N, Q, O> y;
  y.set_slc(0, x.template slc<W>(0));
  return y;
}

template <int W, int I, ap_q_mode Q, ap_o_mode O, int Wb, int Ib, ap_q_mode Qb, ap_o_mode Ob>
ap_fixed<W, I, Q, O> wrap_add(const ap_fixed_base<W, I, true, Q, O, NN>& a,
                                    const ap_fixed_base<Wb, Ib, true, Qb, Ob, NN>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_add: the second operand has more fraction bits than the first");
  const ap_fixed<W, I> wrapped(a + b);
  return ap_fixed<W, I, Q, O>(wrapped);
}

template <int W, int I, ap_q_mode Q, ap_o_mode O, int Wb, int Ib, ap_q_mode Qb, ap_o_mode Ob>
ap_fixed<W, I, Q, O> wrap_sub(const ap_fixed_base<W, I, true, Q, O, NN>& a,
                                    const ap_fixed_base<Wb, Ib, true, Qb, Ob, NN>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_sub: the second operand has more fraction bits than the first");
  const ap_fixed<W, I> wrapped(a - b);
  return ap_fixed<W, I, Q, O>(wrapped);
}

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_FIXED_AP_HPP_
