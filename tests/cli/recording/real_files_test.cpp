// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "cli/recording/model.hpp"
#include "cli/recording/raw_capture.hpp"
#include "cli/recording/write.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

class RealFiles : public ScratchTest {
 protected:
  void SetUp() override {
    const auto found = shared_recordings();
    if (!found) GTEST_SKIP() << "no recordings beside the source tree, and HEMI_SHARED names none";
    recordings_ = *found;
  }
  std::string recordings_;
};

TEST_F(RealFiles, MemsGyro) {
  const Recording recording = read_recording(recordings_ + "/real/mems-gyro-chamber-x.csv");
  EXPECT_EQ(recording.device, "MEMS gyro axis x");
  EXPECT_EQ(recording.sample_rate_hz, 1.0);
  EXPECT_EQ(recording.rows(), 8380U);
  EXPECT_EQ(recording.require("rate_dph", "the test").front(), -14530.52);
  EXPECT_EQ(recording.require("case_temp_degc", "the test").back(), 36.2755);
  EXPECT_TRUE(recording.gaps.empty());
}

TEST_F(RealFiles, Silverbox) {
  const Recording recording = read_recording(recordings_ + "/real/silverbox.csv");
  EXPECT_EQ(recording.rows(), 131072U);
  EXPECT_EQ(recording.sample_rate_hz, 610.3515625);
  EXPECT_EQ(recording.require("displacement_v", "the test").back(), -0.0072247);
  EXPECT_TRUE(recording.gaps.empty());
  EXPECT_TRUE(recording.notes.empty());
}

TEST_F(RealFiles, Bell) {
  const RawCapture capture = read_raw_capture(recordings_ + "/real/bell.wav");
  EXPECT_EQ(capture.sample_rate_hz, 44100.0);
  EXPECT_EQ(capture.full_scale_lsb, 32768.0);
  EXPECT_EQ(capture.adc_x.size(), capture.adc_y.size());
}

TEST_F(RealFiles, WrittenElsewhereWithTheirModels) {
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(recordings_ + "/written-elsewhere")) {
    const std::filesystem::path& name = entry.path();
    if (name.extension() != ".csv") continue;
    ++seen;
    EXPECT_FALSE(is_raw(name.string()));
    const Recording recording = read_recording(name.string());
    EXPECT_GT(recording.rows(), 20000U);
    EXPECT_TRUE(recording.gaps.empty());
    EXPECT_NE(recording.find("frequency_hz"), nullptr);
    // A model as it stands comes out as it went in.
    const InstrumentModel model =
        read_model(std::filesystem::path(name).replace_extension(".model.json").string());
    EXPECT_EQ(model.device, recording.device);
    EXPECT_EQ(to_json(model), model.document);
    // Shortest digits may differ from the file's, the values may not.
    write_hdf5(path("a.h5"), recording);
    const Recording again = read_recording(path("a.h5"));
    for (const Channel& channel : recording.channels) {
      EXPECT_TRUE(same_values(again.find(channel.name)->values, channel.values)) << channel.name;
    }
  }
  EXPECT_GT(seen, 0U);
}

}  // namespace
}  // namespace hemi::recording::testing
