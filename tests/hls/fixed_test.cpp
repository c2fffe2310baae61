// SPDX-License-Identifier: Apache-2.0
//
// What the compiler derives (widths, binary points, constant expressions), and the modes on values
// worked by hand from their definitions.
#include <gtest/gtest.h>

#include <cstdint>
#include <type_traits>
#include <vector>

#include "hls/fixed.hpp"

namespace hemi::hls {
namespace {

template <class Actual, class Expected>
constexpr bool same = std::is_same_v<Actual, Expected>;

using A = Fixed<16, 1, Round::half_even, Overflow::saturate>;
using B = Fixed<24, 4>;
using Narrow = Fixed<5, -3>;
using Coarse = Fixed<10, 20>;

static_assert(A::width == 16 && A::integer == 1 && A::fraction == 15);
static_assert(Narrow::fraction == 8 && Coarse::fraction == -10);
static_assert(fixed_traits<A>::width == 16 && fixed_traits<A>::integer == 1 &&
              fixed_traits<A>::fraction == 15);

static_assert(same<decltype(A{} + A{}), Fixed<17, 2>>);
static_assert(same<decltype(A{} + B{}), Fixed<25, 5>>);
static_assert(same<decltype(B{} - A{}), Fixed<25, 5>>);
static_assert(same<decltype(Narrow{} + Coarse{}), Fixed<29, 21>>);
static_assert(same<decltype(Fixed<62, 1>{} + Fixed<62, 1>{}), Fixed<63, 2>>);
static_assert(same<decltype(A{} * B{}), Fixed<40, 5>>);
static_assert(same<decltype(Narrow{} * Coarse{}), Fixed<15, 17>>);
static_assert(same<decltype(Fixed<31, 1>{} * Fixed<32, 1>{}), Fixed<63, 2>>);
static_assert(same<decltype(-A{}), Fixed<17, 2>>);
static_assert(same<decltype(shift_right(A{}, 3)), A>);
static_assert(same<decltype(scale<-4>(A{})), Fixed<16, -3, Round::half_even, Overflow::saturate>>);
static_assert(same<decltype(wrap_add(B{}, Fixed<30, 12>{})), B>);
static_assert(same<decltype(wrap_sub(B{}, Coarse{})), B>);

static_assert(std::is_trivially_copyable_v<A> && sizeof(A) == 4 && sizeof(Fixed<33, 1>) == 8);
static_assert(!std::is_convertible_v<B, A> && std::is_constructible_v<A, B>, "quantisation is explicit");
static_assert(!std::is_constructible_v<A, int> && !std::is_constructible_v<A, double>,
              "numbers enter by from_raw");

static_assert(raw(A{}) == 0 && raw(from_raw<A>(0x18000)) == -32768, "the low 16 bits, signed");
static_assert(raw(from_raw<A>(3) * from_raw<B>(-5)) == -15);
static_assert(raw(from_raw<A>(1) + from_raw<B>(1)) == 32 + 1);
static_assert(raw(from_raw<Fixed<8, 4>>(1) - from_raw<Fixed<8, 6>>(1)) == 1 - 4);
static_assert(raw(-from_raw<A>(-32768)) == 32768);
static_assert(raw(wrap_add(from_raw<Fixed<8, 8>>(127), from_raw<Fixed<8, 8>>(1))) == -128);
static_assert(raw(wrap_sub(from_raw<Fixed<8, 4>>(-128), from_raw<Fixed<4, 4>>(1))) == 112);
static_assert(from_raw<Fixed<8, 4>>(16) == from_raw<Fixed<8, 8>>(1));
static_assert(from_raw<Fixed<63, 0>>(1) > Fixed<63, 63>{} &&
              from_raw<Fixed<63, 63>>(-1) < from_raw<Fixed<63, 0>>(-1));

/// Quarters quantised to integers of three bits.
template <Round R, Overflow O>
std::vector<std::int64_t> integers_of(const std::vector<std::int64_t>& quarters) {
  std::vector<std::int64_t> result;
  for (const std::int64_t word : quarters) {
    result.push_back(raw(quantise<Fixed<3, 3, R, O>>(from_raw<Fixed<12, 10>>(word))));
  }
  return result;
}

using Words = std::vector<std::int64_t>;

TEST(Fixed, RoundsTheWayEachModeIsDefined) {
  const Words quarters{-10, -9, -7, -6, -5, -2, -1, 0, 1, 2, 3, 5, 6, 7, 10};
  EXPECT_EQ((integers_of<Round::floor, Overflow::saturate>(quarters)),
            (Words{-3, -3, -2, -2, -2, -1, -1, 0, 0, 0, 0, 1, 1, 1, 2}));
  EXPECT_EQ((integers_of<Round::half_up, Overflow::saturate>(quarters)),
            (Words{-2, -2, -2, -1, -1, 0, 0, 0, 0, 1, 1, 1, 2, 2, 3}));
  EXPECT_EQ((integers_of<Round::half_even, Overflow::saturate>(quarters)),
            (Words{-2, -2, -2, -2, -1, 0, 0, 0, 0, 0, 1, 1, 2, 2, 2}));
}

TEST(Fixed, OverflowsTheWayEachModeIsDefined) {
  const Words quarters{-40, -20, -16, -12, 12, 13, 14, 16, 28, 32, 40};
  EXPECT_EQ((integers_of<Round::half_up, Overflow::wrap>(quarters)),
            (Words{-2, 3, -4, -3, 3, 3, -4, -4, -1, 0, 2}));
  EXPECT_EQ((integers_of<Round::half_up, Overflow::saturate>(quarters)),
            (Words{-4, -4, -4, -3, 3, 3, 3, 3, 3, 3, 3}));
  EXPECT_EQ((integers_of<Round::half_up, Overflow::saturate_symmetric>(quarters)),
            (Words{-3, -3, -3, -3, 3, 3, 3, 3, 3, 3, 3}));
}

TEST(Fixed, SaturatesTellsTheOverflowAfterRounding) {
  using HalfUp = Fixed<3, 3, Round::half_up, Overflow::saturate>;
  using Floor = Fixed<3, 3, Round::floor, Overflow::wrap>;
  using Symmetric = Fixed<3, 3, Round::floor, Overflow::saturate_symmetric>;
  const auto quarters = [](std::int64_t word) { return from_raw<Fixed<12, 10>>(word); };
  EXPECT_FALSE(saturates<HalfUp>(quarters(13)));
  EXPECT_TRUE(saturates<HalfUp>(quarters(14))) << "3.5 rounds to 4";
  EXPECT_FALSE(saturates<HalfUp>(quarters(-18))) << "-4.5 rounds to -4";
  EXPECT_FALSE(saturates<Floor>(quarters(15)));
  EXPECT_TRUE(saturates<Floor>(quarters(16)));
  EXPECT_TRUE(saturates<Floor>(quarters(-17)));
  EXPECT_TRUE(saturates<Symmetric>(quarters(-16)));
  EXPECT_FALSE(saturates<Symmetric>(quarters(-12)));
}

}  // namespace
}  // namespace hemi::hls
