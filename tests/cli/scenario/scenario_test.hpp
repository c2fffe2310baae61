// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "cli/scenario/scenario.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::scenario::testing {

/// Scenarios as text, in a directory of their own.
class ScenarioTest : public recording::testing::ScratchTest {
 protected:
  Scenario read(std::string_view text) const { return read_scenario(file("s.toml", text)); }

  /// Refused in one line that names the file, this line of the text, all the parts and a remedy.
  void expect_refused(std::string_view text, int line, std::initializer_list<std::string_view> parts) const {
    SCOPED_TRACE(std::string(text));
    const std::string path = file("s.toml", text);
    const std::string place = path + ":" + std::to_string(line) + ": ";
    recording::testing::expect_input_error([&] { read_scenario(path); }, {place});
    recording::testing::expect_input_error([&] { read_scenario(path); }, parts);
  }
};

}  // namespace hemi::scenario::testing
