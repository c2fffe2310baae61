// SPDX-License-Identifier: Apache-2.0
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "cli/recording/hdf5_attributes.hpp"
#include "cli/recording/write.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

class BadHdf5 : public ScratchTest {
 protected:
  // Reads with the library's own stack going to stderr if anything lets it.
  void expect_bad(const std::vector<Hdf5Item>& items, std::initializer_list<std::string_view> parts) {
    write_hdf5_items(path("a.h5"), items);
    expect_bad_file(parts);
  }
  void expect_bad_file(std::initializer_list<std::string_view> parts) {
    ::testing::internal::CaptureStderr();
    expect_input_error([&] { read_recording(path("a.h5")); }, parts);
    expect_input_error([&] { read_recording(path("a.h5")); }, {path("a.h5")});
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }
};

const Hdf5Item kTime{"time_s", {3}, {0, 1, 2}, "s"};

TEST_F(BadHdf5, NotHdf5) {
  file("a.h5", "time_s,rate_dph\n0,1\n");
  expect_bad_file({"not an HDF5 file"});
  file("a.h5", "MATLAB 5.0 MAT-file, Platform: GLNXA64");
  expect_bad_file({"a MATLAB file", "end in .mat"});
  file("a.h5", "");
  expect_bad_file({"is empty"});
}

TEST_F(BadHdf5, CutOff) {
  Recording recording{.sample_rate_hz = 1.0};
  recording.channels = {{"time_s", "s", std::vector<double>(1000)},
                        {"rate_dph", "deg/h", std::vector<double>(1000)}};
  for (std::size_t i = 0; i < 1000; ++i) recording.channels[0].values[i] = static_cast<double>(i);
  write_hdf5(path("a.h5"), recording);
  std::filesystem::resize_file(path("a.h5"), std::filesystem::file_size(path("a.h5")) / 2);
  expect_bad_file({"damaged or cut off"});
}

TEST_F(BadHdf5, DamagedBytesNeverCrash) {
  Recording recording{.sample_rate_hz = 1.0};
  recording.channels = {{"time_s", "s", {0, 1, 2}}, {"rate_dph", "deg/h", {4, 5, 6}}};
  write_hdf5(path("good.h5"), recording);
  const std::string good = content("good.h5");
  // In a child: the library itself loses some memory over damaged files, which is not for our leak check to
  // find.
  const pid_t child = ::fork();
  if (child == 0) {
    int refused = 0;
    for (std::size_t i = 0; i < good.size(); i += 5) {
      std::string bad = good;
      bad[i] = static_cast<char>(~bad[i]);
      file("a.h5", bad);
      try {
        read_recording(path("a.h5"));
      } catch (const InputError&) {
        ++refused;
      }
    }
    // Many bytes are checksums, signatures or addresses; the rest are values, names and padding.
    ::_exit(refused > 10 ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(BadHdf5, WrongUnit) {
  expect_bad({kTime, {"rate_dph", {3}, {1, 2, 3}, "deg/s"}},
             {"rate_dph", "attribute unit is 'deg/s' where rate_dph is in deg/h", "\"scale\": 3600"});
}

TEST_F(BadHdf5, UnequalLengths) {
  expect_bad({{"rate_dph", {4}, {1, 2, 3, 4}}, kTime},
             {"time_s: has 3 values where rate_dph has 4", "equal length"});
}

TEST_F(BadHdf5, InfiniteAndMissingTimes) {
  const double inf = std::numeric_limits<double>::infinity();
  expect_bad({kTime, {"rate_dph", {3}, {1, inf, 3}}}, {"row 2: rate_dph", "infinite"});
  expect_bad({{"time_s", {3}, {0, 2, 1}}}, {"row 3: time_s", "backwards"});
  expect_bad({{"time_s", {3}, {0, 1, 1}}}, {"row 3: time_s", "repeated"});
  expect_bad({{"time_s", {3}, {0, std::nan(""), 1}}}, {"row 2: time_s", "missing"});
}

TEST_F(BadHdf5, UnknownDatasetAndShape) {
  expect_bad({kTime, {"rate_dps", {3}, {1, 2, 3}}}, {"rate_dps", "unknown channel", "'rate_dph'", "columns"});
  expect_bad({kTime, {"rate_dph", {3, 2}, {1, 2, 3, 4, 5, 6}}}, {"rate_dph", "not one-dimensional"});
  expect_bad({}, {"no channel with values"});
  expect_bad({{"time_s", {0}, {}}}, {"no channel with values"});
  expect_bad({{"raw/adc_x", {2}, {1, 2}}}, {"no channel with values"});
}

TEST_F(BadHdf5, TextDataset) {
  write_hdf5_items(path("a.h5"), {kTime});
  {
    const Hdf5Handle opened(H5Fopen(path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle dataset(
        H5Dcreate2(opened, "rate_dph", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  }
  expect_bad_file({"rate_dph", "neither integers nor floating-point"});
}

TEST_F(BadHdf5, ClaimedSizeWithoutBytes) {
  {
    const Hdf5Silence silence;
    const Hdf5Handle created(H5Fcreate(path("a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                             H5Fclose);
    const hsize_t length = hsize_t{1} << 50;
    const Hdf5Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
    const Hdf5Handle dataset(
        H5Dcreate2(created, "time_s", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
  }
  expect_bad_file({"time_s", "claims 1125899906842624 values"});
}

using ForeignHdf5 = ScratchTest;

TEST_F(ForeignHdf5, IntegersFloatsMatlabShapesAndAttributes) {
  // As MATLAB stores it: n x 1 and 1 x n, lone numbers as 1 x 1, text as UTF-16 datasets.
  const std::string mat = path("a.mat");
  write_hdf5_items(mat, {{"rate_dph", {1, 3}, {1, 2, 3}},
                         {"frequency_hz", {3, 1}, {4425, 4426, 4427}},
                         {"sample_rate_hz", {1, 1}, {4}},
                         {"#refs#/a", {1}, {0}}});
  {
    const Hdf5Handle opened(H5Fopen(mat.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const hsize_t length = 3;
    const std::uint16_t text[] = {'A', 0x00E4, 0x20AC};
    const Hdf5Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
    const Hdf5Handle dataset(
        H5Dcreate2(opened, "device", H5T_NATIVE_UINT16, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    H5Dwrite(dataset, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
    ASSERT_TRUE(write_attribute(dataset, "MATLAB_class", "char"));
  }
  const Recording recording = read_recording(mat);
  EXPECT_EQ(recording.device, "Aä€");
  EXPECT_EQ(recording.sample_rate_hz, 4.0);
  EXPECT_TRUE(recording.time_from_rate);
  EXPECT_TRUE(same_values(recording.find("rate_dph")->values, {1, 2, 3}));
  EXPECT_TRUE(same_values(recording.find("frequency_hz")->values, {4425, 4426, 4427}));
  EXPECT_TRUE(recording.notes.empty());
}

TEST_F(ForeignHdf5, ColumnsOfTheSidecarApplyToDatasets) {
  write_hdf5_items(path("a.h5"), {kTime, {"z", {3}, {1, 2, 3}, "deg/s"}, {"junk", {2, 2}, {1, 2, 3, 4}}},
                   {{"sample_rate_hz", 2.0}});
  file("a.json",
       R"({"sample_rate_hz": 1, "columns": {"z": {"name": "rate_dph", "scale": 3600}, "junk": null}})");
  const Recording recording = read_recording(path("a.h5"));
  EXPECT_TRUE(same_values(recording.find("rate_dph")->values, {3600, 7200, 10800}));
  EXPECT_EQ(recording.sample_rate_hz, 1.0);  // the sidecar goes before the attribute
}

}  // namespace
}  // namespace hemi::recording::testing
