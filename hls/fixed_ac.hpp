// SPDX-License-Identifier: Apache-2.0
//
// Backend 2 of hls/fixed.hpp, where the contract stands: ac_fixed of Siemens' Algorithmic C types.
#ifndef HEMI_HLS_FIXED_AC_HPP_
#define HEMI_HLS_FIXED_AC_HPP_

#include <ac_fixed.h>

#include <cstdint>

#include "hls/fixed_modes.hpp"

namespace hemi {
namespace hls {
namespace detail {

constexpr ac_q_mode ac_rounding(Round mode) {
  return mode == Round::floor ? AC_TRN : (mode == Round::half_up ? AC_RND : AC_RND_CONV);
}

constexpr ac_o_mode ac_overflow(Overflow mode) {
  return mode == Overflow::wrap ? AC_WRAP : (mode == Overflow::saturate ? AC_SAT : AC_SAT_SYM);
}

}  // namespace detail

/// ac_fixed, but zero where nothing else is said: Siemens' own leaves the word undefined.
template <int W, int I, Round R = Round::floor, Overflow O = Overflow::wrap>
struct Fixed : ac_fixed<W, I, true, detail::ac_rounding(R), detail::ac_overflow(O)> {
  using Vendor = ac_fixed<W, I, true, detail::ac_rounding(R), detail::ac_overflow(O)>;
  Fixed() : Vendor(0) {}
  Fixed(const Vendor& x) : Vendor(x) {}
  using Vendor::Vendor;
};

template <int W, int I, ac_q_mode Q, ac_o_mode O>
struct fixed_traits<ac_fixed<W, I, true, Q, O>> {
  static_assert(W >= 1 && W <= 63, "Fixed holds 1 to 63 bits: quantise the operands before this operation");
  static constexpr int width = W;
  static constexpr int integer = I;
  static constexpr int fraction = W - I;
};

template <int W, int I, Round R, Overflow O>
struct fixed_traits<Fixed<W, I, R, O>> : fixed_traits<typename Fixed<W, I, R, O>::Vendor> {};

template <int W, int I, ac_q_mode Q, ac_o_mode O>
std::int64_t raw(const ac_fixed<W, I, true, Q, O>& x) {
  static_assert(W <= 63, "raw: quantise to at most 63 bits first");
  return x.template slc<W>(0).to_int64();
}

template <class T>
T from_raw(std::int64_t word) {
  T x;
  x.set_slc(0, ac_int<fixed_traits<T>::width, true>(static_cast<long long>(word)));
  return x;
}

template <class T, int W, int I, ac_q_mode Q, ac_o_mode O>
T quantise(const ac_fixed<W, I, true, Q, O>& x) {
  return T(x);
}

namespace detail {

template <class T>
struct AcSaturationTest;

template <int W, int I, ac_q_mode Q, ac_o_mode O>
struct AcSaturationTest<ac_fixed<W, I, true, Q, O>> {
  /// Rounds like the target into a type that holds every rounded x, then asks whether the target does.
  template <int Wx, int Ix, ac_q_mode Qx, ac_o_mode Ox>
  static bool apply(const ac_fixed<Wx, Ix, true, Qx, Ox>& x) {
    constexpr int integer = (Ix > I ? Ix : I) + 1;
    const ac_fixed<integer + W - I, integer, true, Q, AC_WRAP> rounded(x);
    return rounded != ac_fixed<W, I, true, Q, O>(rounded);
  }
};

template <int W, int I, Round R, Overflow O>
struct AcSaturationTest<Fixed<W, I, R, O>> : AcSaturationTest<typename Fixed<W, I, R, O>::Vendor> {};

}  // namespace detail

template <class T, int W, int I, ac_q_mode Q, ac_o_mode O>
bool saturates(const ac_fixed<W, I, true, Q, O>& x) {
  return detail::AcSaturationTest<T>::apply(x);
}

template <int W, int I, ac_q_mode Q, ac_o_mode O>
bool is_negative(const ac_fixed<W, I, true, Q, O>& x) {
  return x[W - 1];
}

template <int W, int I, ac_q_mode Q, ac_o_mode O>
ac_fixed<W, I, true, Q, O> shift_right(const ac_fixed<W, I, true, Q, O>& x, int n) {
  return from_raw<ac_fixed<W, I, true, Q, O>>((x.template slc<W>(0) >> n).to_int64());
}

template <int N, int W, int I, ac_q_mode Q, ac_o_mode O>
ac_fixed<W, I + N, true, Q, O> scale(const ac_fixed<W, I, true, Q, O>& x) {
  ac_fixed<W, I + N, true, Q, O> y;
  y.set_slc(0, x.template slc<W>(0));
  return y;
}

template <int W, int I, ac_q_mode Q, ac_o_mode O, int Wb, int Ib, ac_q_mode Qb, ac_o_mode Ob>
ac_fixed<W, I, true, Q, O> wrap_add(const ac_fixed<W, I, true, Q, O>& a,
                                    const ac_fixed<Wb, Ib, true, Qb, Ob>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_add: the second operand has more fraction bits than the first");
  const ac_fixed<W, I, true> wrapped(a + b);
  return ac_fixed<W, I, true, Q, O>(wrapped);
}

template <int W, int I, ac_q_mode Q, ac_o_mode O, int Wb, int Ib, ac_q_mode Qb, ac_o_mode Ob>
ac_fixed<W, I, true, Q, O> wrap_sub(const ac_fixed<W, I, true, Q, O>& a,
                                    const ac_fixed<Wb, Ib, true, Qb, Ob>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_sub: the second operand has more fraction bits than the first");
  const ac_fixed<W, I, true> wrapped(a - b);
  return ac_fixed<W, I, true, Q, O>(wrapped);
}

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_FIXED_AC_HPP_
