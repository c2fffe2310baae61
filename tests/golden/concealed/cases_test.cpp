// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hemi::concealed {
namespace {

TEST(Cases, AreTheSameForTheSameSeed) {
  const Case one = make_case("single_strong", 4, 2), two = make_case("single_strong", 4, 2);
  EXPECT_TRUE((one.written.rate_dph == two.written.rate_dph).all());
  EXPECT_TRUE((one.case_degc == two.case_degc).all());
  EXPECT_EQ(one.effects.at(0).id, two.effects.at(0).id);
  const Case other = make_case("single_strong", 5, 2);
  EXPECT_FALSE(other.written.rate_dph.size() == one.written.rate_dph.size() &&
               (other.written.rate_dph == one.written.rate_dph).all());
}

TEST(Cases, NullHoldsNothing) {
  const Case null = make_case("null", 2, 0);
  EXPECT_TRUE(null.effects.empty());
  EXPECT_TRUE(null.changed.empty());
  EXPECT_EQ(null.dprime, 0.0);
  EXPECT_EQ(null.stated.frequency_hz, null.unit.model.frequency_hz);
  EXPECT_GE(null.time_s.size(), 5 * 3600);
  EXPECT_LE(null.time_s.size(), 10 * 3600);
}

TEST(Cases, WrongNumbersAreStatedWrong) {
  const Case params = make_case("params", 2, 1);
  EXPECT_TRUE(params.effects.empty());
  EXPECT_FALSE(params.changed.empty());
}

TEST(Cases, StrengthsAreThoseOfTheirClass) {
  for (std::uint64_t index = 0; index < 2; ++index) {
    const Case strong = make_case("single_strong", 3, index);
    EXPECT_GE(strong.dprime, 10.0 * kLimit) << strong.effects.at(0).id;
    const Case moderate = make_case("single_moderate", 3, index);
    EXPECT_GE(moderate.dprime, 3.0 * kLimit) << moderate.effects.at(0).id;
    EXPECT_LT(moderate.dprime, 10.0 * kLimit) << moderate.effects.at(0).id;
    const Case weak = make_case("weak", 3, index);
    EXPECT_LE(weak.dprime, 1.5) << weak.effects.at(0).id;
    EXPECT_GT(weak.dprime, 0.0) << weak.effects.at(0).id;
  }
}

TEST(Cases, PairsHoldTwoAndPoorOnesASetWithTheTruth) {
  const Case pair = make_case("pair", 3, 0);
  ASSERT_EQ(pair.effects.size(), 2u);
  EXPECT_NE(pair.effects[0].id, pair.effects[1].id);
  for (const auto& effect : pair.effects) {
    EXPECT_GE(effect.dprime, 3.0 * kLimit);
    EXPECT_LE(effect.dprime_beside, effect.dprime * 1.000001);
  }
  for (std::uint64_t index = 0; index < 6; ++index) {
    const Case poor = make_case("poor", 3, index);
    EXPECT_NE(std::find(poor.set.begin(), poor.set.end(), poor.effects.back().id), poor.set.end());
    EXPECT_GE(poor.set.size(), 2u);
  }
}

TEST(Cases, UnknownPhysicsIsNotInTheCatalogue) {
  const Case unknown = make_case("unknown", 3, 0);
  for (const Kind& one : catalogue_kinds()) EXPECT_NE(one.id, unknown.effects.at(0).id);
}

TEST(Cases, ConfoundersAreNoEffects) {
  const Case disturbed = make_case("confounder", 3, 1);
  EXPECT_TRUE(disturbed.effects.empty());
}

TEST(Cases, RefuseAClassThatIsNone) {
  EXPECT_THROW(make_case("certain", 1, 0), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::concealed
