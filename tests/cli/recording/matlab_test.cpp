// SPDX-License-Identifier: Apache-2.0
// MATLAB files from elsewhere: versions, shapes, metadata, and what cannot be read. The files under
// tests/data were written by another program (scipy).
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>

#include "cli/recording/matlab_file.hpp"
#include "cli/recording/matlab_handle.hpp"
#include "cli/recording/matlab_version.hpp"
#include "cli/recording/raw_capture.hpp"
#include "cli/recording/write.hpp"
#include "tests/cli/recording/scratch.hpp"

#ifdef __SANITIZE_ADDRESS__
// libmatio asks for as many bytes as a damaged file claims, and takes no for an answer.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "allocator_may_return_null=1";
}
#endif

namespace hemi::recording::testing {
namespace {

std::string foreign(const std::string& name) {
  return std::string(HEMI_SOURCE_DIR) + "/tests/data/" + name;
}

// A file made variable by variable.
class Matlab : public ScratchTest {
 protected:
  void open(mat_ft version, matio_compression compression = MAT_COMPRESSION_NONE) {
    file_.reset(Mat_CreateVer(path("a.mat").c_str(), nullptr, version));
    ASSERT_TRUE(file_);
    compression_ = compression;
  }
  void add(MatlabVariable variable) {
    ASSERT_TRUE(variable);
    ASSERT_EQ(Mat_VarWrite(file_.get(), variable.get(), compression_), 0);
  }
  MatlabVariable doubles(const char* name, std::vector<double> values, std::size_t rows, int flags = 0) {
    std::array<std::size_t, 2> shape = {rows, rows == 0 ? 0 : values.size() / rows};
    return MatlabVariable(
        Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape.data(), values.data(), flags));
  }
  MatlabVariable structure(const char* name, std::vector<MatlabVariable> fields) {
    std::vector<const char*> names;
    for (const auto& field : fields) names.push_back(field->name);
    std::array<std::size_t, 2> shape = {1, 1};
    MatlabVariable result(
        Mat_VarCreateStruct(name, 2, shape.data(), names.data(), static_cast<unsigned>(names.size())));
    for (std::size_t i = 0; i < fields.size(); ++i)
      Mat_VarSetStructFieldByIndex(result.get(), i, 0, fields[i].release());
    return result;
  }
  void expect_bad(std::initializer_list<std::string_view> parts) {
    file_.reset();
    expect_input_error([&] { read_recording(path("a.mat")); }, parts);
    expect_input_error([&] { read_recording(path("a.mat")); }, {path("a.mat")});
  }

  MatlabFile file_;
  matio_compression compression_ = MAT_COMPRESSION_NONE;
};

class Versions : public Matlab, public ::testing::WithParamInterface<mat_ft> {};

TEST_P(Versions, VectorsOfAnyClassAndSidecarStruct) {
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    open(GetParam(), compression);
    add(doubles("rate_dph", {1, 2.5, 3}, 1));
    std::array<std::int16_t, 3> counts = {-7, 0, 32767};
    std::array<std::size_t, 2> shape = {3, 1};
    add(MatlabVariable(Mat_VarCreate("status", MAT_C_INT16, MAT_T_INT16, 2, shape.data(), counts.data(), 0)));
    std::array<float, 3> volts = {0.5F, 0.1F, -2.0F};
    add(MatlabVariable(
        Mat_VarCreate("drive_v", MAT_C_SINGLE, MAT_T_SINGLE, 2, shape.data(), volts.data(), 0)));
    std::vector<MatlabVariable> inner;
    inner.push_back(doubles("gain", {2.0}, 1));
    std::vector<MatlabVariable> fields;
    fields.push_back(doubles("sample_rate_hz", {4}, 1));
    fields.push_back(structure("own", std::move(inner)));
    add(structure("sidecar", std::move(fields)));
    file_.reset();
    const Recording recording = read_recording(path("a.mat"));
    EXPECT_EQ(recording.sample_rate_hz, 4.0);
    EXPECT_TRUE(same_values(recording.find("rate_dph")->values, {1, 2.5, 3}));
    EXPECT_TRUE(same_values(recording.find("status")->values, {-7, 0, 32767}));
    EXPECT_TRUE(same_values(recording.find("drive_v")->values, {0.5, 0.1F, -2.0}));
    EXPECT_EQ(recording.sidecar["own"]["gain"], 2.0);
    EXPECT_FALSE(recording.sidecar.contains("sidecar"));
    EXPECT_TRUE(recording.notes.empty());
  }
}

TEST_P(Versions, WhatIsNoVectorIsNamedWithItsRemedy) {
  open(GetParam());
  add(doubles("rate_dph", {1, 2, 3, 4}, 2));
  expect_bad({"rate_dph", GetParam() == MAT_FT_MAT5 ? "is a matrix" : "not one-dimensional"});
  open(GetParam());
  std::vector<MatlabVariable> fields;
  fields.push_back(doubles("rate_dph", {1, 2}, 2));
  add(structure("log", std::move(fields)));
  expect_bad({"log", "is a struct", "save(..., '-struct', 'log')"});
  open(GetParam());
  add(doubles("rate_dps", {1, 2, 3}, 3));
  expect_bad({"rate_dps", "unknown channel", "'rate_dph'", "columns"});
  open(GetParam());
  add(doubles("sample_rate_hz", {1, 2}, 2));
  expect_bad({"sample_rate_hz", "not a single number"});
}

TEST_P(Versions, UnequalAndEmpty) {
  open(GetParam());
  add(doubles("frequency_hz", {1, 2, 3}, 3));
  add(doubles("rate_dph", {1, 2}, 2));
  expect_bad({"rate_dph: has 2 values where frequency_hz has 3"});
  open(GetParam());
  add(doubles("rate_dph", {}, 0));
  expect_bad({"no channel with values"});
}

INSTANTIATE_TEST_SUITE_P(V5AndV73, Versions, ::testing::Values(MAT_FT_MAT5, MAT_FT_MAT73));

TEST_F(Matlab, ColumnsOfTheSidecarFileApply) {
  open(MAT_FT_MAT5, MAT_COMPRESSION_ZLIB);
  add(doubles("z", {1, 2, 3}, 3));
  add(doubles("junk", {1, 2, 3, 4}, 2));
  std::vector<MatlabVariable> fields;
  fields.push_back(doubles("a", {1}, 1));
  add(structure("config", std::move(fields)));
  file_.reset();
  file("a.json", R"({"sample_rate_hz": 1, "columns": {"junk": null, "config": null,
                     "z": {"name": "rate_dph", "scale": 3600}}})");
  const Recording recording = read_recording(path("a.mat"));
  EXPECT_TRUE(same_values(recording.find("rate_dph")->values, {3600, 7200, 10800}));
  EXPECT_EQ(recording.channels.size(), 2U);
}

TEST_F(Matlab, ComplexAndSparse) {
  open(MAT_FT_MAT5);
  std::array<double, 2> re = {1, 2}, im = {3, 4};
  mat_complex_split_t parts{re.data(), im.data()};
  std::array<std::size_t, 2> shape = {2, 1};
  add(MatlabVariable(
      Mat_VarCreate("rate_dph", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape.data(), &parts, MAT_F_COMPLEX)));
  expect_bad({"rate_dph", "complex numbers", "real numbers"});
}

// Structs, compression, rows instead of columns, non-ASCII text, and the other order of bytes.
TEST_F(Matlab, WrittenByAnotherProgram) {
  for (const char* name : {"foreign_v5.mat", "foreign_v7.mat"}) {
    const Recording recording = read_recording(foreign(name));
    EXPECT_EQ(recording.device, "Kreisel Ä€");
    EXPECT_EQ(recording.sample_rate_hz, 10.0);
    EXPECT_TRUE(same_values(recording.find("time_s")->values, {0.0, 0.1, 0.2, 0.3})) << name;
    EXPECT_TRUE(same_values(recording.find("rate_dph")->values, {1.5, -2.25, std::nan(""), 1e-300})) << name;
    EXPECT_TRUE(same_values(recording.find("status")->values, {0, 1, 2, 40000})) << name;
    const RawCapture capture = read_raw_capture(foreign(name));
    EXPECT_EQ(capture.adc_x, (std::vector<std::int32_t>{-32768, 0, 32767}));
    EXPECT_EQ(capture.sample_rate_hz, 1e5);
    EXPECT_EQ(capture.device, "Kreisel Ä€");
  }
}

TEST_F(Matlab, OtherVersionsAreNamed) {
  expect_input_error([] { read_recording(foreign("foreign_v4.mat")); }, {"MATLAB v4", "'-v7'"});
  std::string head = "MATLAB 9.0 MAT-file";
  head.resize(124, ' ');
  file("a.mat", head + std::string("\x00\x03IM", 4) + std::string(64, '\0'));
  expect_bad({"version 0x0300", "'-v7'"});
  file("a.mat", head + std::string("\x00\x02IM", 4) + std::string(600, '\0'));
  expect_bad({"v7.3", "damaged or cut off"});
  file("a.mat", head.substr(0, 100));
  expect_bad({"header is damaged"});
  file("a.mat", "time_s,rate_dph\n0,1\n");
  expect_bad({"not a MATLAB file"});
  file("a.mat", "");
  expect_bad({"is empty"});
}

TEST_F(Matlab, CutOffIsFound) {
  for (const char* name : {"foreign_v5.mat", "foreign_v7.mat"}) {
    std::filesystem::copy_file(foreign(name), path("a.mat"),
                               std::filesystem::copy_options::overwrite_existing);
    const std::string good = content("a.mat");
    int whole = 0;
    for (std::size_t length = 1; length < good.size(); length += 3) {
      file("a.mat", good.substr(0, length));
      try {
        read_recording(path("a.mat"));
        ++whole;
      } catch (const InputError&) {
      }
    }
    // A cut between two variables leaves a complete file with fewer of them; time_s and a rate must be there.
    EXPECT_LT(whole, 6) << name;
  }
}

// Every third byte inverted, alone: no crash, and many refused.
TEST_F(Matlab, DamagedBytesNeverCrash) {
  for (const char* name : {"foreign_v5.mat", "foreign_v7.mat"}) {
    std::filesystem::copy_file(foreign(name), path("good.mat"),
                               std::filesystem::copy_options::overwrite_existing);
    const std::string good = content("good.mat");
    const pid_t child = ::fork();
    if (child == 0) {
      int refused = 0;
      for (std::size_t i = 0; i < good.size(); i += 3) {
        std::string bad = good;
        bad[i] = static_cast<char>(~bad[i]);
        file("a.mat", bad);
        for (const bool raw : {false, true}) {
          try {
            raw ? static_cast<void>(read_raw_capture(path("a.mat")))
                : static_cast<void>(read_recording(path("a.mat")));
          } catch (const InputError&) {
            ++refused;
          }
        }
      }
      ::_exit(refused > 10 ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status)) << name << " ended by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0) << name;
  }
}

}  // namespace
}  // namespace hemi::recording::testing
