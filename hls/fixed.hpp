// SPDX-License-Identifier: Apache-2.0
//
// Fixed<W, I, R, O>: a signed number of W bits, I of them before the binary point (sign included):
//
//   value = raw * 2^-F,  F = W - I,  -2^(W-1) <= raw < 2^(W-1),  1 <= W <= 63
//
// I may be negative or larger than W. Every operation is exact or is a quantisation that the source
// text names; widths of results are derived at compile time and a result over 63 bits does not compile.
//
//   a + b, a - b       exact; I = max(Ia, Ib) + 1, F = max(Fa, Fb)
//   a * b              exact; W = Wa + Wb, I = Ia + Ib
//   -a                 exact; one integer bit more
//   == != < <= > >=    exact between any two types
//   quantise<T>(x)     x rounded and brought into range in the way T's modes say; same as T(x)
//   saturates<T>(x)    would x, rounded as T rounds, lie outside the range of T?
//   raw(x)             the word as a sign-extended std::int64_t
//   from_raw<T>(n)     the number whose word is the low W bits of n
//   is_negative(x)     x < 0
//   shift_right(x, n)  x * 2^-n, floored onto x's own grid and of its type; 0 <= n <= 63
//   scale<N>(x)        x * 2^N exactly: the binary point moves, the word stays
//   wrap_add(a, b)     a + b modulo the range of a, in a's type; b has no more fraction bits than a
//   wrap_sub(a, b)     a - b likewise
//
// Results of + - * and unary - floor and wrap, which they never have to do. Kernels use the alias,
// the operators, the functions above and fixed_traits<T>, never members, so that HEMI_FIXED_BACKEND
// can put a vendor's type in place of ours:
//
//   0  Fixed of fixed_own.hpp (default): plain 64-bit integer arithmetic
//   1  ap_fixed (Vitis HLS)    2  ac_fixed (Catapult)    3  sc_fixed (SystemC)
//
// A type that saturates symmetrically never holds -2^(W-1), and from_raw must not be given it: backends
// differ there. SystemC's expressions have no width of their own: quantise into a named type right after
// each. Constant expressions work with backend 0 only; tables are arrays of integers, read with from_raw.
#ifndef HEMI_HLS_FIXED_HPP_
#define HEMI_HLS_FIXED_HPP_

#ifndef HEMI_FIXED_BACKEND
#define HEMI_FIXED_BACKEND 0
#endif

#if HEMI_FIXED_BACKEND == 0
#include "hls/fixed_own.hpp"
#elif HEMI_FIXED_BACKEND == 1
#include "hls/fixed_ap.hpp"
#elif HEMI_FIXED_BACKEND == 2
#include "hls/fixed_ac.hpp"
#elif HEMI_FIXED_BACKEND == 3
#include "hls/fixed_sc.hpp"
#else
#error "HEMI_FIXED_BACKEND: 0 own, 1 ap_fixed, 2 ac_fixed, 3 sc_fixed"
#endif

#endif  // HEMI_HLS_FIXED_HPP_
