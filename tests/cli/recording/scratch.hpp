// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/recording/recording.hpp"

namespace hemi::recording::testing {

/// A directory of its own for each test, removed afterwards.
class ScratchTest : public ::testing::Test {
 protected:
  ScratchTest();
  ~ScratchTest() override;

  std::string path(const std::string& name) const { return directory_ + "/" + name; }
  /// Writes a file and returns its path.
  std::string file(const std::string& name, std::string_view content) const;
  /// Names in the directory, sorted.
  std::vector<std::string> names() const;
  std::string content(const std::string& name) const;

 private:
  std::string directory_;
};

/// The work throws InputError with one line that holds all the parts and a remedy.
void expect_input_error(const std::function<void()>& work, std::initializer_list<std::string_view> parts);
void expect_output_error(const std::function<void()>& work, std::initializer_list<std::string_view> parts);

/// Same bits; any NaN equals any other.
bool same_values(const std::vector<double>& a, const std::vector<double>& b);

/// Integer PCM by libsndfile, left-justified words shifted up from `bits`. `y` empty: one channel.
void write_sound(const std::string& path, int format, int bits, int rate_hz,
                 const std::vector<std::int32_t>& x, const std::vector<std::int32_t>& y);

/// A ring-down with noise, in words of `bits`; deterministic.
std::vector<std::int32_t> ring_down(std::size_t length, int bits, double cycles_per_sample, unsigned seed);

/// A dataset of doubles with any shape in an HDF5 file that is made if need be.
struct Hdf5Item {
  std::string name;
  std::vector<unsigned long long> shape;
  std::vector<double> values;
  std::string unit{};
};
void write_hdf5_items(const std::string& path, const std::vector<Hdf5Item>& items,
                      const std::vector<std::pair<std::string, double>>& attributes = {});

/// Directory of recordings beside the source tree or named by the environment, where there is one.
std::optional<std::string> shared_recordings();

}  // namespace hemi::recording::testing
