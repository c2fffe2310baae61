// SPDX-License-Identifier: Apache-2.0
// The paper's Table 1 and what it publishes from it, as the program prints them.
#include <array>
#include <cmath>
#include <regex>

#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

using Calibrate = ProgramTest;

const std::string table1 = HEMI_SOURCE_DIR "/tests/data/paper_table1.csv";

// Eq. (18) is printed with four significant digits, the constant with three decimals.
TEST_F(Calibrate, CubicOfThePaper) {
  const Outcome outcome = good({"calibrate", table1, "--order", "3"});
  struct Printed {
    double value, half_digit;
  };
  constexpr std::array<Printed, 4> paper = {
      {{4424.901, 0.5e-3}, {0.3716, 0.5e-4}, {-9.702e-4, 0.5e-7}, {1.528e-5, 0.5e-8}}};
  const std::regex coefficient(R"(a(\d) = ([-+][0-9.e-]+) Hz)");
  std::size_t found = 0;
  for (std::sregex_iterator m(outcome.out.begin(), outcome.out.end(), coefficient), end; m != end;
       ++m, ++found) {
    const auto i = static_cast<std::size_t>(std::stoi((*m)[1]));
    ASSERT_LT(i, paper.size());
    EXPECT_NEAR(std::stod((*m)[2]), paper[i].value, paper[i].half_digit) << "a" << i;
  }
  EXPECT_EQ(found, 4U) << outcome.out;
}

TEST_F(Calibrate, Table2OfThePaper) {
  constexpr std::array<double, 7> computed_degc = {-19.976, -10.058, -0.0026, 10.070, 20.011, 29.924, 40.031};
  const Outcome outcome = good({"calibrate", table1, "--order", "3"});
  const std::regex row(R"(\n +(-?\d+\.\d{3}) +(\d+\.\d{4}) +(-?\d+\.\d+) +(-?\d+\.\d+))");
  std::size_t i = 0;
  for (std::sregex_iterator m(outcome.out.begin(), outcome.out.end(), row), end; m != end; ++m, ++i) {
    ASSERT_LT(i, computed_degc.size());
    EXPECT_EQ(std::stod((*m)[1]), -20.0 + 10.0 * static_cast<double>(i));
    EXPECT_NEAR(std::stod((*m)[3]), computed_degc[i], 0.005);
    EXPECT_NEAR(std::stod((*m)[4]), std::stod((*m)[3]) - std::stod((*m)[1]), 1.01e-4);
  }
  EXPECT_EQ(i, 7U) << outcome.out;
}

TEST_F(Calibrate, VerdictOnTheOrder) {
  const Outcome outcome = good({"calibrate", table1});
  for (const char* part : {"cubic leaves up to 0.027 Hz", "rounding explains 0.005 Hz",
                           "Order 4 is supported against order 3: F = 105, p = 0.009",
                           "cubic: up to 0.46 degC", "quartic: up to 0.12 degC", "Chosen: order 4"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " is not in\n" << outcome.out;
  }
  EXPECT_EQ(good({"calibrate", table1, "--json"}).json()["frequency"]["order"], 4);
}

// Table 1, then a chamber run on top: the terms that made the run come back.
TEST_F(Calibrate, ModelThenDrift) {
  write_telemetry(4000);
  good({"calibrate", table1, "-o", "a.model.json"});
  const auto json = good({"calibrate", "chamber.csv", "--base", "a.model.json", "--reference-hz", "4432.07",
                          "-o", "b.model.json", "--json"})
                        .json();
  double slope = 0.0, error = 1.0;
  for (const auto& term : json["bias"]["terms"]) {
    if (term["term"] != "f") continue;
    slope = term["coefficient"];
    error = term["standard_error"];
  }
  EXPECT_LT(error, 0.01);
  EXPECT_NEAR(slope, -0.31, 4.0 * error);
  const auto run = good({"run", "chamber.csv", "-m", "b.model.json", "--json"}).json();
  // What is left is the noise of 0.5 deg/h; its standard deviation from 4000 rows is known to 1 / sqrt(8000).
  EXPECT_NEAR(run["compensated_deviation_dph"].get<double>(), 0.5, 4.0 * 0.5 / std::sqrt(8000.0));
  EXPECT_GT(run["rate_deviation_dph"].get<double>(), 0.9);
}

}  // namespace
}  // namespace hemi::cli::testing
