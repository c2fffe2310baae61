// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <limits>

#include "cli/recording/partial_file.hpp"
#include "cli/recording/write.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

using Output = ScratchTest;

Recording large_recording() {
  Recording recording{.sample_rate_hz = 1.0};
  recording.channels = {{"time_s", "s", std::vector<double>(100000)}};
  for (std::size_t i = 0; i < 100000; ++i) recording.channels[0].values[i] = static_cast<double>(i);
  return recording;
}

RawCapture large_capture() {
  return {.sample_rate_hz = 1e5,
          .full_scale_lsb = 32768,
          .adc_x = std::vector<std::int32_t>(200000, -12345),
          .adc_y = std::vector<std::int32_t>(200000, 12345)};
}

// A file-size limit stops writing in the middle of a file, as a full disk does.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~SizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SizeLimit(const SizeLimit&) = delete;
  SizeLimit& operator=(const SizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(Output, FullDeviceIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  expect_output_error([] { write_csv("/dev/full", large_recording()); }, {"/dev/full", "No space left"});
  expect_output_error([] { write_csv("/dev/full", large_capture()); }, {"/dev/full", "No space left"});
  expect_output_error([] { write_hdf5("/dev/full", large_recording()); }, {"/dev/full", "No space left"});
  expect_output_error([] { write_matlab("/dev/full", large_recording()); }, {"/dev/full", "No space left"});
  expect_output_error([] { write_text("/dev/full", "x"); }, {"/dev/full", "No space left"});
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_FALSE(std::filesystem::exists("/dev/full.partial"));
}

TEST_F(Output, StopInTheMiddleLeavesNothing) {
  const Recording recording = large_recording();
  const RawCapture capture = large_capture();
  const SizeLimit limit(100000);
  ::testing::internal::CaptureStderr();
  expect_output_error([&] { write_csv(path("a.csv"), recording); }, {"a.csv", "File too large", "space"});
  expect_output_error([&] { write_hdf5(path("a.h5"), recording); }, {"a.h5", "File too large"});
  expect_output_error([&] { write_matlab(path("a.mat"), recording); }, {"a.mat", "File too large"});
  expect_output_error([&] { write_csv(path("a.raw.csv"), capture); }, {"a.raw.csv", "File too large"});
  expect_output_error([&] { write_hdf5(path("b.h5"), capture); }, {"b.h5", "File too large"});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(names().empty());
}

TEST_F(Output, FailedWriteKeepsTheOldFile) {
  file("a.csv", "old\n");
  file("a.json", "{}");
  const Recording recording = large_recording();
  {
    const SizeLimit limit(100000);
    expect_output_error([&] { write_csv(path("a.csv"), recording); }, {"a.csv"});
  }
  EXPECT_EQ(content("a.csv"), "old\n");
  EXPECT_EQ(content("a.json"), "{}");
  EXPECT_EQ(names(), (std::vector<std::string>{"a.csv", "a.json"}));
}

TEST_F(Output, SmallFullFileSystem) {
  // A file system of one page: needs the right to mount, which containers often lack.
  ASSERT_EQ(::mkdir(path("small").c_str(), 0755), 0);
  const std::string mount = "mount -t tmpfs -o size=64k none " + path("small") + " 2>/dev/null";
  if (std::system(mount.c_str()) != 0) GTEST_SKIP() << "mounting is not allowed here";
  expect_output_error([&] { write_csv(path("small/a.csv"), large_recording()); }, {"a.csv", "No space left"});
  expect_output_error([&] { write_hdf5(path("small/a.h5"), large_recording()); }, {"a.h5", "No space left"});
  expect_output_error([&] { write_matlab(path("small/a.mat"), large_recording()); },
                      {"a.mat", "No space left"});
  EXPECT_TRUE(std::filesystem::is_empty(path("small")));
  ASSERT_EQ(std::system(("umount " + path("small")).c_str()), 0);
}

TEST_F(Output, BadTargets) {
  const Recording recording = large_recording();
  expect_output_error([&] { write_csv(path("no/such/a.csv"), recording); },
                      {"a.csv", "No such file", "directory"});
  expect_output_error([&] { write_hdf5(path("no/such/a.h5"), recording); }, {"a.h5", "No such file"});
  expect_output_error([&] { write_matlab(path("no/such/a.mat"), recording); }, {"a.mat", "No such file"});
  ASSERT_EQ(::mkdir(path("d").c_str(), 0755), 0);
  expect_output_error([&] { write_csv(path("d"), recording); }, {"is a directory"});
}

TEST_F(Output, InfiniteValuesAreRefused) {
  Recording recording = large_recording();
  recording.channels[0].values[41] = std::numeric_limits<double>::infinity();
  expect_output_error([&] { write_csv(path("a.csv"), recording); }, {"row 42: time_s", "infinite"});
  expect_output_error([&] { write_hdf5(path("a.h5"), recording); }, {"row 42: time_s", "infinite"});
  expect_output_error([&] { write_matlab(path("a.mat"), recording); }, {"row 42: time_s", "infinite"});
  EXPECT_TRUE(names().empty());
}

TEST_F(Output, UnequalChannelsAreAProgrammingError) {
  Recording recording = large_recording();
  recording.channels.push_back({"rate_dph", "deg/h", {1.0}});
  EXPECT_THROW(write_csv(path("a.csv"), recording), std::invalid_argument);
  EXPECT_THROW(write_hdf5(path("a.h5"), recording), std::invalid_argument);
  EXPECT_TRUE(names().empty());
}

TEST_F(Output, NothingUnderTheNameBeforeCommit) {
  {
    PartialFile partial(path("a.txt"));
    partial.write("abc");
    EXPECT_EQ(names(), std::vector<std::string>{"a.txt.partial"});
    partial.finish();
    EXPECT_EQ(names(), std::vector<std::string>{"a.txt.partial"});
    partial.commit();
  }
  EXPECT_EQ(names(), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(content("a.txt"), "abc");
}

TEST_F(Output, LinksStayLinks) {
  file("real.txt", "old");
  std::filesystem::create_symlink(path("real.txt"), path("link.txt"));
  write_text(path("link.txt"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.txt")));
  EXPECT_EQ(content("real.txt"), "new");
}

}  // namespace
}  // namespace hemi::recording::testing
