// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace hemi::recording {
namespace {

constexpr double kSilent_s = 2.0;
constexpr double kInterval_s = 0.1;
constexpr std::string_view kWipe = "\r\x1b[K";

void put(int descriptor, const std::string& text) {
  // A terminal that has gone away is no reason to stop the work.
  [[maybe_unused]] const ssize_t ignored = ::write(descriptor, text.data(), text.size());
}

}  // namespace

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string progress_line(std::string_view label, double fraction, double elapsed_s) {
  const double done = std::clamp(fraction, 0.0, 1.0);
  const auto percent = static_cast<int>(100.0 * done);
  if (done <= 0.0) return fmt::format("{}  0 %", label);
  const auto left_s = static_cast<long long>(std::ceil(elapsed_s * (1.0 - done) / done));
  if (left_s >= 3600) {
    return fmt::format("{}  {} %, {}:{:02}:{:02} left", label, percent, left_s / 3600, left_s / 60 % 60,
                       left_s % 60);
  }
  return fmt::format("{}  {} %, {}:{:02} left", label, percent, left_s / 60, left_s % 60);
}

Progress::Progress(std::string label, double total, int descriptor, std::function<double()> clock_s)
    : label_(std::move(label)),
      total_(total),
      descriptor_(descriptor),
      terminal_(::isatty(descriptor) == 1),
      clock_s_(std::move(clock_s)),
      start_s_(clock_s_()),
      last_s_(start_s_) {}

Progress::~Progress() {
  if (shown_) put(descriptor_, std::string(kWipe));
}

void Progress::update(double done) {
  if (!terminal_) return;
  const double now_s = clock_s_();
  if (now_s - start_s_ < kSilent_s || now_s - last_s_ < kInterval_s) return;
  last_s_ = now_s;
  shown_ = true;
  put(descriptor_, std::string(kWipe) + progress_line(label_, done / total_, now_s - start_s_));
}

}  // namespace hemi::recording
