// SPDX-License-Identifier: Apache-2.0
//
// Backend 3 of hls/fixed.hpp, where the contract stands: SystemC's sc_fixed (IEEE 1666). For
// simulation; every function goes through SystemC's own arithmetic of unlimited precision.
#ifndef HEMI_HLS_FIXED_SC_HPP_
#define HEMI_HLS_FIXED_SC_HPP_

#ifndef SC_INCLUDE_FX
#define SC_INCLUDE_FX
#endif
#include <cstdint>
#include <systemc>

#include "hls/fixed_modes.hpp"

#ifndef SC_FIXED_H
#error "define SC_INCLUDE_FX before the first #include <systemc>"
#endif

namespace hemi {
namespace hls {
namespace detail {

constexpr sc_dt::sc_q_mode sc_rounding(Round mode) {
  return mode == Round::floor ? sc_dt::SC_TRN : (mode == Round::half_up ? sc_dt::SC_RND : sc_dt::SC_RND_CONV);
}

constexpr sc_dt::sc_o_mode sc_overflow(Overflow mode) {
  return mode == Overflow::wrap ? sc_dt::SC_WRAP
                                : (mode == Overflow::saturate ? sc_dt::SC_SAT : sc_dt::SC_SAT_SYM);
}

/// x * 2^n, n of either sign.
inline sc_dt::sc_fxval sc_shift(const sc_dt::sc_fxval& x, int n) {
  return n >= 0 ? x << n : x >> -n;
}

}  // namespace detail

template <int W, int I, Round R = Round::floor, Overflow O = Overflow::wrap>
using Fixed = sc_dt::sc_fixed<W, I, detail::sc_rounding(R), detail::sc_overflow(O)>;

template <int W, int I, sc_dt::sc_q_mode Q, sc_dt::sc_o_mode O, int N>
struct fixed_traits<sc_dt::sc_fixed<W, I, Q, O, N>> {
  static_assert(W >= 1 && W <= 63, "Fixed holds 1 to 63 bits");
  static constexpr int width = W;
  static constexpr int integer = I;
  static constexpr int fraction = W - I;
};

/// By way of the bits: to_int64() of SystemC 2.3.4 gives 0 for multiples of 2^32 of more than 32 bits.
template <int W, int I, sc_dt::sc_q_mode Q, sc_dt::sc_o_mode O, int N>
std::int64_t raw(const sc_dt::sc_fixed<W, I, Q, O, N>& x) {
  return x.range().to_int64();
}

template <class T>
T from_raw(std::int64_t word) {
  using Traits = fixed_traits<T>;
  const sc_dt::sc_fixed<Traits::width, Traits::width> wrapped(static_cast<sc_dt::int64>(word));
  return T(detail::sc_shift(wrapped, -Traits::fraction));
}

template <class T>
T quantise(const sc_dt::sc_fxval& x) {
  return T(x);
}

template <class T>
T quantise(const sc_dt::sc_fxnum& x) {
  return T(x);
}

template <class T>
bool saturates(const sc_dt::sc_fxval& x) {
  return T(x).overflow_flag();
}

template <class T>
bool saturates(const sc_dt::sc_fxnum& x) {
  return T(x).overflow_flag();
}

/// Zero may carry either sign in SystemC's values.
inline bool is_negative(const sc_dt::sc_fxval& x) {
  return x.is_neg() && !x.is_zero();
}
inline bool is_negative(const sc_dt::sc_fxnum& x) {
  return x.is_neg() && !x.is_zero();
}

template <int W, int I, sc_dt::sc_q_mode Q, sc_dt::sc_o_mode O, int N>
sc_dt::sc_fixed<W, I, Q, O, N> shift_right(const sc_dt::sc_fixed<W, I, Q, O, N>& x, int n) {
  const sc_dt::sc_fixed<W, I> floored(detail::sc_shift(x, -n));
  return sc_dt::sc_fixed<W, I, Q, O, N>(floored);
}

template <int S, int W, int I, sc_dt::sc_q_mode Q, sc_dt::sc_o_mode O, int N>
sc_dt::sc_fixed<W, I + S, Q, O, N> scale(const sc_dt::sc_fixed<W, I, Q, O, N>& x) {
  return sc_dt::sc_fixed<W, I + S, Q, O, N>(detail::sc_shift(x, S));
}

template <int W, int I, sc_dt::sc_q_mode Q, sc_dt::sc_o_mode O, int N, int Wb, int Ib, sc_dt::sc_q_mode Qb,
          sc_dt::sc_o_mode Ob, int Nb>
sc_dt::sc_fixed<W, I, Q, O, N> wrap_add(const sc_dt::sc_fixed<W, I, Q, O, N>& a,
                                        const sc_dt::sc_fixed<Wb, Ib, Qb, Ob, Nb>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_add: the second operand has more fraction bits than the first");
  const sc_dt::sc_fixed<W, I> wrapped(a + b);
  return sc_dt::sc_fixed<W, I, Q, O, N>(wrapped);
}

template <int W, int I, sc_dt::sc_q_mode Q, sc_dt::sc_o_mode O, int N, int Wb, int Ib, sc_dt::sc_q_mode Qb,
          sc_dt::sc_o_mode Ob, int Nb>
sc_dt::sc_fixed<W, I, Q, O, N> wrap_sub(const sc_dt::sc_fixed<W, I, Q, O, N>& a,
                                        const sc_dt::sc_fixed<Wb, Ib, Qb, Ob, Nb>& b) {
  static_assert(Wb - Ib <= W - I, "wrap_sub: the second operand has more fraction bits than the first");
  const sc_dt::sc_fixed<W, I> wrapped(a - b);
  return sc_dt::sc_fixed<W, I, Q, O, N>(wrapped);
}

}  // namespace hls
}  // namespace hemi

#endif  // HEMI_HLS_FIXED_SC_HPP_
