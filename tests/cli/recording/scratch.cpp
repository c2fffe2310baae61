// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/recording/scratch.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>

#include "cli/recording/hdf5_attributes.hpp"

namespace hemi::recording::testing {
namespace fs = std::filesystem;

ScratchTest::ScratchTest() {
  std::string pattern = (fs::temp_directory_path() / "hemi-recording-XXXXXX").string();
  directory_ = ::mkdtemp(pattern.data());
}

ScratchTest::~ScratchTest() {
  fs::remove_all(directory_);
}

std::string ScratchTest::file(const std::string& name, std::string_view content) const {
  std::ofstream(path(name), std::ios::binary) << content;
  return path(name);
}

std::vector<std::string> ScratchTest::names() const {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(directory_))
    found.push_back(entry.path().filename().string());
  std::ranges::sort(found);
  return found;
}

std::string ScratchTest::content(const std::string& name) const {
  std::ifstream stream(path(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

namespace {

template <class Error>
void expect_error(const std::function<void()>& work, std::initializer_list<std::string_view> parts) {
  try {
    work();
    ADD_FAILURE() << "no error thrown";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << "no remedy: " << message;
    for (const std::string_view part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
    }
  }
}

}  // namespace

void expect_input_error(const std::function<void()>& work, std::initializer_list<std::string_view> parts) {
  expect_error<InputError>(work, parts);
}

void expect_output_error(const std::function<void()>& work, std::initializer_list<std::string_view> parts) {
  expect_error<OutputError>(work, parts);
}

bool same_values(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b, [](double left, double right) {
    if (std::isnan(left) || std::isnan(right)) return std::isnan(left) && std::isnan(right);
    return std::memcmp(&left, &right, sizeof left) == 0;
  });
}

void write_sound(const std::string& path, int format, int bits, int rate_hz,
                 const std::vector<std::int32_t>& x, const std::vector<std::int32_t>& y) {
  SF_INFO info{};
  info.samplerate = rate_hz;
  info.channels = y.empty() ? 1 : 2;
  info.format = format;
  SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
  ASSERT_NE(file, nullptr) << sf_strerror(nullptr);
  std::vector<int> frames;
  for (std::size_t i = 0; i < x.size(); ++i) {
    frames.push_back(static_cast<int>(static_cast<std::uint32_t>(x[i]) << (32 - bits)));
    if (!y.empty()) frames.push_back(static_cast<int>(static_cast<std::uint32_t>(y[i]) << (32 - bits)));
  }
  EXPECT_EQ(sf_writef_int(file, frames.data(), static_cast<sf_count_t>(x.size())),
            static_cast<sf_count_t>(x.size()));
  sf_close(file);
}

std::vector<std::int32_t> ring_down(std::size_t length, int bits, double cycles_per_sample, unsigned seed) {
  std::mt19937 random(seed);
  const double full_scale = std::ldexp(1.0, bits - 1);
  std::vector<std::int32_t> samples(length);
  for (std::size_t i = 0; i < length; ++i) {
    const auto n = static_cast<double>(i);
    const double noise = static_cast<double>(random() % 1001) / 1000.0 - 0.5;
    const double value =
        std::exp(-n / static_cast<double>(length)) * std::sin(2.0 * std::numbers::pi * cycles_per_sample * n);
    samples[i] = static_cast<std::int32_t>(std::floor(0.9 * full_scale * value + 20.0 * noise));
  }
  // The ends of the scale are the words that a wrong shift or clamp would change.
  samples[0] = static_cast<std::int32_t>(-full_scale);
  samples[1] = static_cast<std::int32_t>(full_scale - 1.0);
  return samples;
}

void write_hdf5_items(const std::string& path, const std::vector<Hdf5Item>& items,
                      const std::vector<std::pair<std::string, double>>& attributes) {
  const Hdf5Silence silence;
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  for (const auto& [name, value] : attributes) ASSERT_TRUE(write_attribute(file, name, value));
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  for (const Hdf5Item& item : items) {
    const std::vector<hsize_t> shape(item.shape.begin(), item.shape.end());
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const Hdf5Handle dataset(
        H5Dcreate2(file, item.name.c_str(), H5T_NATIVE_DOUBLE, space, links, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, item.values.data());
    if (!item.unit.empty()) {
      ASSERT_TRUE(write_attribute(dataset, "unit", item.unit));
    }
  }
}

std::optional<std::string> shared_recordings() {
  const char* named = std::getenv("HEMI_SHARED");
  const fs::path shared = named != nullptr ? fs::path(named) : fs::path(HEMI_SOURCE_DIR) / ".." / "shared";
  std::error_code code;
  if (!fs::is_directory(shared / "recordings", code)) return std::nullopt;
  return (shared / "recordings").string();
}

}  // namespace hemi::recording::testing
