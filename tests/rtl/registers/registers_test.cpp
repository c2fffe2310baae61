// SPDX-License-Identifier: Apache-2.0
// The generated C header against the description that it comes from, as C99 and as C++.
#include <gtest/gtest.h>

#include <random>

#include "rtl/address_map.hpp"
#include "tb/registers.hpp"
#include "tests/rtl/registers/header_check.h"

namespace {

using namespace hemi;

class Header : public testing::TestWithParam<bool> {
 protected:
  header_view view = GetParam() ? view_of_cxx() : view_of_c();
};

TEST_P(Header, NamesAndFormatsAreThoseOfTheDescription) {
  ASSERT_EQ(view.register_count, config::register_count);
  for (int i = 0; i < config::register_count; ++i) {
    EXPECT_STREQ(view.register_name(i), config::registers[i].name);
    EXPECT_EQ(view.register_width(i), config::registers[i].format.width);
    EXPECT_EQ(view.register_fraction(i), config::registers[i].format.fraction);
  }
  ASSERT_EQ(view.record_words, config::record_words);
  for (int i = 0; i < config::record_words; ++i) {
    EXPECT_STREQ(view.record_name(i), record_layout[i].name);
    EXPECT_EQ(view.record_fraction(i), record_layout[i].format.fraction);
    // The words' formats stand in the benches as well.
    EXPECT_EQ(record_layout[i].format.width, tb::record_formats[i].width) << record_layout[i].name;
    EXPECT_EQ(record_layout[i].format.fraction, tb::record_formats[i].fraction) << record_layout[i].name;
  }
  EXPECT_EQ(view.parity_index, config::reg_parity);
  EXPECT_EQ(view.status_register, config::word_status);
  EXPECT_EQ(view.nco_start_fraction, 48);
  EXPECT_EQ(view.parity_width, 54);
  EXPECT_EQ(view.record_rate_width, 36);
}

// Written out: these are what firmware in the field has compiled in.
TEST_P(Header, AddressesAreThoseOfTheDocumentation) {
  EXPECT_EQ(view.axi_rebalance_limit, 8U * config::reg_rebalance_limit);
  EXPECT_EQ(view.axi_status_high, 0x254U);
  EXPECT_EQ(view.axi_interrupt_pending, 0x30cU);
  EXPECT_EQ(view.axi_live_status, 0x318U);
  EXPECT_EQ(view.axi_identity, 0x48454d49U);
  EXPECT_EQ(view.board_status, 0x4a);
  EXPECT_EQ(view.board_control, 0x62);
  EXPECT_EQ(view.board_identity, 0x48454d42U);
  EXPECT_EQ(view.board_baud, 1000000);
  EXPECT_EQ(view.telemetry_rate_index, telemetry_rate_address);
  EXPECT_EQ(view.sticky_frequency_invalid,
            std::int64_t{1} << (config::status_frequency_invalid + config::status_shift));
}

TEST_P(Header, ConvertsAsTheBenchesDo) {
  std::mt19937_64 random(1);
  for (const auto& r : config::registers) {
    const double limit = std::ldexp(1.0, std::min(r.format.width, 53) - 1 - r.format.fraction);
    const double step = std::ldexp(1.0, -r.format.fraction);
    std::uniform_real_distribution<double> uniform(-limit, limit - step);
    for (int i = 0; i < 1000; ++i) {
      const double value = i == 0   ? -limit
                           : i == 1 ? limit - step
                           : i == 2 ? 2.5 * step
                           : i == 3 ? -2.5 * step
                                    : uniform(random);
      const std::int64_t raw = view.to_raw(value, r.format.fraction);
      ASSERT_EQ(raw, tb::to_raw(value, r.format, r.name));
      ASSERT_EQ(view.to_value(raw, r.format.fraction), tb::to_value(raw, r.format));
      ASSERT_EQ(view.through_halves(raw), raw);
    }
  }
}

TEST_P(Header, ParityIsThatOfTheCore) {
  std::mt19937_64 random(2);
  for (int n = 0; n < 100; ++n) {
    tb::RegisterValues values{};
    for (int i = 0; i < config::register_count; ++i) {
      const auto format = config::registers[i].format;
      values[i] = std::ldexp(
          static_cast<double>(static_cast<std::int64_t>(random()) >> (64 - std::min(format.width, 53))),
          -format.fraction);
    }
    const tb::RegisterImage image = tb::to_image(values);
    EXPECT_EQ(view.parity(image.data()), image[config::reg_parity]);
  }
}

INSTANTIATE_TEST_SUITE_P(Languages, Header, testing::Bool(),
                         [](const auto& instance) { return instance.param ? "cxx" : "c99"; });

}  // namespace
