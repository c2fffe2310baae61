// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/program/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <numbers>
#include <random>
#include <thread>

#include "cli/recording/write.hpp"

namespace hemi::cli::testing {
namespace {

using recording::Json;

constexpr const char* out_name = ".stdout";
constexpr const char* err_name = ".stderr";

[[noreturn]] void become(const std::string& directory, const Arguments& arguments) {
  std::vector<char*> pointers = {const_cast<char*>("hemi")};
  for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  if (::chdir(directory.c_str()) != 0) ::_exit(126);
  const int out = ::open(out_name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int err = ::open(err_name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  ::dup2(out, 1);
  ::dup2(err, 2);
  ::execv(HEMI_PROGRAM, pointers.data());
  ::_exit(127);
}

Json model_document() {
  return Json::parse(R"({
    "format": "hemi-model/1",
    "device": "test",
    "frequency": {"reference_degc": 0.0,
                  "coefficients_hz": [4424.90095, 0.371555556, -9.70238095e-4, 1.52777778e-5]},
    "bias": {"reference_hz": 4432.07, "terms_dph": {"1": 2.0, "f": -0.31, "f^2": 0.004, "df": 850.0}},
    "scale_factor": 1.0})");
}

}  // namespace

Json Outcome::json() const {
  Json parsed = Json::parse(out, nullptr, false);
  EXPECT_FALSE(parsed.is_discarded()) << "no JSON: " << out;
  return parsed;
}

Outcome ProgramTest::start(const Arguments& arguments, int interrupt_after_ms) const {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const pid_t child = ::fork();
  if (child == 0) become(path("."), arguments);
  int status = 0;
  bool interrupted = false;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    const auto elapsed = Clock::now() - begin;
    if (interrupt_after_ms > 0 && !interrupted && elapsed > std::chrono::milliseconds(interrupt_after_ms)) {
      ::kill(child, SIGINT);
      interrupted = true;
    }
    if (elapsed > std::chrono::minutes(5)) ::kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), content(out_name),
                        content(err_name)};
  std::filesystem::remove(path(out_name));
  std::filesystem::remove(path(err_name));
  return outcome;
}

Outcome ProgramTest::hemi(const Arguments& arguments) const {
  return start(arguments, 0);
}

Outcome ProgramTest::hemi_interrupted(const Arguments& arguments, int delay_ms) const {
  return start(arguments, delay_ms);
}

Outcome ProgramTest::good(const Arguments& arguments) const {
  const Outcome outcome = hemi(arguments);
  EXPECT_EQ(outcome.code, 0) << fmt::format("{}\n", fmt::join(arguments, " ")) << outcome.out << outcome.err;
  return outcome;
}

void ProgramTest::expect_bad(const Arguments& arguments,
                             std::initializer_list<std::string_view> parts) const {
  SCOPED_TRACE(fmt::format("hemi {}", fmt::join(arguments, " ")));
  const auto before = names();
  const Outcome outcome = hemi(arguments);
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("hemi: ")) << outcome.err;
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("; "), std::string::npos) << "no remedy: " << outcome.err;
  for (const std::string_view part : parts)
    EXPECT_NE(outcome.err.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.err;
  EXPECT_EQ(names(), before);
}

recording::RawCapture tone(std::size_t pairs, double sample_rate_hz, double frequency_hz) {
  recording::RawCapture capture;
  capture.sample_rate_hz = sample_rate_hz;
  capture.full_scale_lsb = 32768.0;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise_lsb(0.0, 0.5);
  const double amplitude_lsb = 0.8 * capture.full_scale_lsb;
  for (std::size_t i = 0; i < pairs; ++i) {
    const double turns = frequency_hz / sample_rate_hz * static_cast<double>(i);
    const double x = std::cos(2.0 * std::numbers::pi * (turns - std::floor(turns)));
    capture.adc_x.push_back(static_cast<std::int32_t>(std::lround(amplitude_lsb * x + noise_lsb(random))));
    capture.adc_y.push_back(
        static_cast<std::int32_t>(std::lround(0.01 * amplitude_lsb * x + noise_lsb(random))));
  }
  return capture;
}

void ProgramTest::write_tone(std::size_t pairs) const {
  recording::write_csv(path("tone.raw.csv"), tone(pairs, 100e3, 4425.0));
}

std::string model_text(std::string_view key, std::string_view value) {
  Json document = model_document();
  document[std::string(key)] = Json::parse(value);
  return recording::json_text(document, 2);
}

void ProgramTest::write_model() const {
  file("hrg.model.json", recording::json_text(model_document(), 2));
}

void ProgramTest::write_telemetry(std::size_t rows, std::size_t skip_from, std::size_t skip_to) const {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise_dph(0.0, 0.5);
  std::string text = "time_s,frequency_hz,rate_dph\n";
  for (std::size_t i = 0; i < rows; ++i) {
    const double f_hz = 4430.0 + 4.0 * std::cos(2e-3 * static_cast<double>(i));
    const double rate_dph = 2.0 - 0.31 * (f_hz - 4432.07) + noise_dph(random);
    if (i >= skip_from && i < skip_to) continue;
    text += fmt::format("{:.1f},{:.6f},{:.6f}\n", 0.1 * static_cast<double>(i), f_hz, rate_dph);
  }
  file("chamber.csv", text);
}

std::string bell() {
  const std::string debian = "/usr/share/sonic-pi/samples/perc_bell.flac";
  if (std::filesystem::exists(debian)) return debian;
  const auto shared = recording::testing::shared_recordings();
  const std::string beside = shared ? *shared + "/real/bell.wav" : "";
  return std::filesystem::exists(beside) ? beside : "";
}

}  // namespace hemi::cli::testing
