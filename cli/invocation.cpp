// SPDX-License-Identifier: Apache-2.0
#include "cli/invocation.hpp"

#include <vector>

#include "cli/report/report.hpp"

namespace hemi::cli {
namespace {

std::string& line() {
  static std::string text;
  return text;
}

}  // namespace

void set_invocation(int argc, const char* const* argv) {
  std::vector<std::string> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  words.insert(words.begin(), "hemi");
  line() = report::command_line(words);
}

const std::string& invocation() {
  return line();
}

}  // namespace hemi::cli
