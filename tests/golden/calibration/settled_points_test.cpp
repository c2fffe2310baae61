// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/settled_points.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace hemi::calibration {
namespace {

class SettledPointsFile : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = std::filesystem::path(::testing::TempDir()) /
            (std::string("settled_") + std::to_string(::getpid()) + "_" +
             ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  SettledPoints read(const std::string& text, int order = 1) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_settled_points(path_, order);
  }

  void expect_error(const std::string& text, const std::string& where_and_what, int order = 1) {
    try {
      read(text, order);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find(path_.string() + ":" + where_and_what), 0u) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_NE(message.find("; "), std::string::npos) << "no remedy: " << message;
    }
  }

  std::filesystem::path path_;
};

TEST_F(SettledPointsFile, ReadsCommentsAnyColumnOrderAndRepeatedTemperatures) {
  const SettledPoints points = read(
      "# where "
      "from\r\n\r\nnote,frequency_hz,settled_degc\r\na,4416.97,-20\r\nb,4416.9,-20.0\r\nc,4421.5,+1e1\r\n");
  ASSERT_EQ(points.frequency_hz.size(), 3);
  EXPECT_EQ(points.frequency_hz(1), 4416.9);
  EXPECT_EQ(points.temperature_degc(1), -20.0);
  EXPECT_EQ(points.temperature_degc(2), 10.0);
  EXPECT_DOUBLE_EQ(points.resolution_hz, 0.01);
}

TEST_F(SettledPointsFile, PaperTableIsAsPrinted) {
  const SettledPoints points = read_settled_points(HEMI_SOURCE_DIR "/tests/data/paper_table1.csv", 5);
  const Eigen::VectorXd printed =
      (Eigen::VectorXd(7) << 4416.97, 4421.05, 4424.90, 4428.56, 4432.07, 4435.56, 4439.20).finished();
  EXPECT_EQ(points.frequency_hz, printed);
  EXPECT_EQ(points.temperature_degc, Eigen::VectorXd(Eigen::VectorXd::LinSpaced(7, -20.0, 40.0)));
  EXPECT_DOUBLE_EQ(points.resolution_hz, 0.01);
}

TEST_F(SettledPointsFile, SaysFileLineColumnAndRemedy) {
  const std::string header = "settled_degc,frequency_hz\n";
  expect_error("", "0: file: holds no header");
  expect_error("# nothing else\n", "1: file: holds no header");
  expect_error(header, "1: row: 0 settled points, order 1 needs 3");
  expect_error("settled_degc,f\n0,1\n", "1: frequency_hz: there is no such column");
  expect_error(header + "0,1\n1,abc\n", "3: frequency_hz: 'abc' is not a number");
  expect_error(header + "0,1\n1,4 Hz\n", "3: frequency_hz: '4 Hz' is not a number");
  expect_error(header + "0,1\nnan,2\n", "3: settled_degc: 'nan' is not finite");
  expect_error(header + "0,inf\n", "2: frequency_hz: 'inf' is not finite");
  expect_error(header + "0,1e999\n", "2: frequency_hz: '1e999' is not a number");
  expect_error(header + "0,\n", "2: frequency_hz: the value is missing");
  expect_error(header + "0,-3\n", "2: frequency_hz: a frequency must be above zero");
  expect_error(header + "0,1,2\n", "2: row: 3 values where the header names 2 columns");
  expect_error(header + "0,1\n1,2\n2,3\n", "4: row: 3 settled points, order 3 needs 5", 3);
  expect_error(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "1: settled_degc: there is no such column");
}

TEST_F(SettledPointsFile, MissingFileAndDirectoryAreSaid) {
  EXPECT_THROW(read_settled_points(path_), InputError);
  EXPECT_THROW(read_settled_points(::testing::TempDir()), InputError);
}

TEST(PrintedResolution, IsTheLargestNumberOfDecimals) {
  EXPECT_DOUBLE_EQ(printed_resolution({"1", "2.5", "3.125"}).value(), 1e-3);
  EXPECT_DOUBLE_EQ(printed_resolution({"17", "4"}).value(), 1.0);
  EXPECT_FALSE(printed_resolution({"1.25e3"}).has_value());
  EXPECT_FALSE(printed_resolution({}).has_value());
}

}  // namespace
}  // namespace hemi::calibration
