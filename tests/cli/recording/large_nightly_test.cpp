// SPDX-License-Identifier: Apache-2.0
// One channel of more than 2^31 bytes, and of more than 2^28 values: exact in HDF5 and MATLAB (v7.3 then).
// Takes 4.4 GB of memory and 2.2 GB of disk in the build directory.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <filesystem>

#include "cli/recording/matlab_version.hpp"
#include "cli/recording/write.hpp"

namespace hemi::recording::testing {
namespace {

constexpr std::size_t kRows = (std::size_t{1} << 28) + 1001;

/// Any finite double, from the row alone (splitmix64's finaliser), so that no second copy is needed.
double value(std::size_t row) {
  std::uint64_t z = (static_cast<std::uint64_t>(row) + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  // The lowest bit of the exponent cleared: neither infinite nor NaN.
  return std::bit_cast<double>((z ^ (z >> 31)) & ~(std::uint64_t{1} << 52));
}

class Large : public ::testing::TestWithParam<const char*> {
 protected:
  Large() : path_(std::string(HEMI_BINARY_DIR) + "/large-round-trip" + GetParam()) {}
  ~Large() override { std::filesystem::remove(path_); }
  std::string path_;
};

TEST_P(Large, RoundTripIsExact) {
  {
    Recording written{.device = "HRG-A17", .sample_rate_hz = 200.0};
    written.channels = {{"rate_dph", "deg/h", std::vector<double>(kRows)}};
    for (std::size_t row = 0; row < kRows; ++row) written.channels[0].values[row] = value(row);
    write_file(path_, written);
  }
  EXPECT_GT(std::filesystem::file_size(path_), std::uintmax_t{1} << 31);
  if (output_kind(path_) == OutputKind::kMatlab) {
    EXPECT_EQ(matlab_version(path_), MatlabVersion::k73);
  }
  const Recording read = read_recording(path_);
  EXPECT_EQ(read.device, "HRG-A17");
  const std::vector<double>& rate = read.require("rate_dph", "the test");
  ASSERT_EQ(rate.size(), kRows);
  std::size_t different = 0;
  for (std::size_t row = 0; row < kRows; ++row)
    different += std::bit_cast<std::uint64_t>(rate[row]) != std::bit_cast<std::uint64_t>(value(row)) ? 1 : 0;
  EXPECT_EQ(different, 0U);
  EXPECT_EQ(read.find("time_s")->values.back(), static_cast<double>(kRows - 1) / 200.0);
}

INSTANTIATE_TEST_SUITE_P(Formats, Large, ::testing::Values(".h5", ".mat"), [](const auto& each) {
  return each.param == std::string(".h5") ? "Hdf5" : "Matlab";
});

}  // namespace
}  // namespace hemi::recording::testing
