// SPDX-License-Identifier: Apache-2.0
// hemi run --port against the simulated board: what is written down is what the fixed-point core alone makes
// in the same closed loop, word by word.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "cli/recording/recording.hpp"
#include "golden/loops/control.hpp"
#include "tb/board/world.hpp"
#include "tb/closed_loop.hpp"
#include "tb/hls_engine.hpp"
#include "tb/registers.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

/// build/hemi_board_sim in the background; ended with the object, should it still run.
class SimulatedBoard {
 public:
  explicit SimulatedBoard(std::vector<std::string> arguments) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) throw std::runtime_error("no pipe");
    arguments.insert(arguments.begin(), HEMI_BOARD_SIM);
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(pipe[1], 1);
      ::close(pipe[0]);
      ::close(pipe[1]);
      std::vector<char*> pointers;
      for (auto& argument : arguments) pointers.push_back(argument.data());
      pointers.push_back(nullptr);
      ::execv(HEMI_BOARD_SIM, pointers.data());
      ::_exit(127);
    }
    ::close(pipe[1]);
    words_ = ::fdopen(pipe[0], "r");
    port_ = line();
  }
  ~SimulatedBoard() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
    std::fclose(words_);
  }
  SimulatedBoard(const SimulatedBoard&) = delete;
  SimulatedBoard& operator=(const SimulatedBoard&) = delete;

  const std::string& port() const { return port_; }
  /// Its last words; it ends when the host has closed the port, or never where none came.
  std::string finish() {
    const std::string last = line();
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = 0;
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    return last;
  }

 private:
  std::string line() {
    std::array<char, 256> text{};
    if (std::fgets(text.data(), text.size(), words_) == nullptr) return {};
    const std::string whole = text.data();
    return whole.substr(0, whole.find('\n'));
  }

  pid_t child_ = 0;
  FILE* words_ = nullptr;
  std::string port_;
};

struct Alone {
  std::vector<tb::SamplePair> pairs;
  std::vector<tb::DacWords> words;
  std::vector<tb::Record> records;
};

class Port : public ProgramTest {
 protected:
  /// The registers of a model, as hemi export writes them.
  tb::RegisterValues exported(const std::string& model) const {
    std::istringstream lines(good({"export", model, "--format", "mem"}).out);
    tb::RegisterValues values{};
    int i = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("//", 0) == 0) continue;
      const auto raw = static_cast<std::int64_t>(std::stoull(line.substr(0, 14), nullptr, 16) << 10) >> 10;
      if (i != config::reg_parity) values[i] = tb::to_value(raw, config::registers[i].format);
      ++i;
    }
    return values;
  }

  /// The same plant around the hls core.
  static Alone alone(const tb::BoardWorld& world, const tb::RegisterValues& values, std::size_t samples) {
    physics::Plant plant = tb::plant_of(world);
    const auto hls = tb::make_hls_engine(false);
    hls->reset(values);
    Alone out;
    tb::close_loop(
        *hls, plant, samples, out.records, [](tb::SamplePair&) {},
        [&](const tb::SamplePair& pair, const tb::DacWords& words) {
          out.pairs.push_back(pair);
          out.words.push_back(words);
        });
    return out;
  }

  /// Every sample that the simulated converters saw; words of sample n are in force from n + 2 on.
  std::size_t expect_words(const std::string& name, const Alone& expected) const {
    std::istringstream lines(content(name));
    std::string line;
    std::getline(lines, line);
    std::size_t n = 0;
    for (; std::getline(lines, line); ++n) {
      if (n >= expected.pairs.size()) break;
      const tb::DacWords words = n < 2 ? tb::DacWords{} : expected.words[n - 2];
      const std::string wanted = fmt::format("{},{},{},{},{},{}", n, expected.pairs[n].x, expected.pairs[n].y,
                                             words.drive, words.rebalance, words.quadrature);
      EXPECT_EQ(line, wanted);
      if (line != wanted) return n;
    }
    return n;
  }

  static void expect_records(const recording::Recording& out, const Alone& expected, std::size_t count) {
    ASSERT_EQ(out.rows(), count);
    ASSERT_GE(expected.records.size(), count);
    const double amplitude = 50 * loops::full_scale_amplitude(20) * 0.8;
    using namespace config;
    const std::tuple<const char*, RecordWord, double> channels[] = {
        {"frequency_hz", word_frequency, 1.0},
        {"temperature_degc", word_temperature, 1.0},
        {"dfdt_hz_per_s", word_derivative, 0.125},
        {"amplitude", word_amplitude, 1.0 / amplitude},
        {"phase_error_turns", word_phase_error, 0},
        {"bias_dph", word_bias, 1.0},
        {"rate_dph", word_rate, 1.0},
        {"compensated_rate_dph", word_compensated, 1.0},
        {"status", word_status, 1.0}};
    for (std::size_t i = 0; i < count; ++i) {
      for (const auto& [name, word, scale] : channels) {
        const double raw = expected.records[i].words[word];
        const double wanted = word == word_phase_error ? raw / 50.0 : raw * scale;
        ASSERT_EQ(out.find(name)->values[i], wanted) << name << " of record " << i;
      }
    }
  }

  void expect_equal(double seconds) const {
    write_model();
    const tb::BoardWorld world{.temperature_degc = 22.0, .rate_dps = 1.5, .amplitude = 0.9, .seed = 5};
    SimulatedBoard board({"--temperature", "22", "--rate", "1.5", "--amplitude", "0.9", "--seed", "5",
                          "--words", path("words.csv")});
    const auto count = static_cast<std::size_t>(std::lround(200 * seconds));
    const Outcome run = good({"run", "--port", board.port(), "--seconds", fmt::format("{}", seconds),
                              "--model", "hrg.model.json", "-o", "out.h5", "--json"});
    ASSERT_EQ(run.code, 0);
    EXPECT_EQ(run.err, "");
    EXPECT_TRUE(run.json()["board_faults"].empty());
    EXPECT_EQ(board.finish().find("fault"), std::string::npos);
    // The board goes on until it has been told to stop: less than a second later.
    const Alone expected = alone(world, exported("hrg.model.json"), (count + 200) * 500);
    EXPECT_GE(expect_words("words.csv", expected), count * 500);
    expect_records(recording::read_recording(path("out.h5")), expected, count);
    EXPECT_LT(std::abs(expected.records[count - 1].words[config::word_rate] - 1.5 * 3600), 5400 * 0.5)
        << "the loop is closed";
  }
};

TEST_F(Port, RecordsEqualTheHlsCoreInClosedLoopForTwoSeconds) {
#ifdef __SANITIZE_ADDRESS__
  expect_equal(0.1);  // two seconds of the board take minutes here
#else
  expect_equal(2.0);
#endif
}

TEST_F(Port, CtrlCStopsTheBoardAndLeavesNoFile) {
  SimulatedBoard board({"--words", path("words.csv")});
  const Outcome run =
      hemi_interrupted({"run", "--port", board.port(), "--seconds", "1000", "-o", "out.csv"}, 700);
  ASSERT_EQ(run.code, 130) << run.err;
  board.finish();
  EXPECT_EQ(content("words.csv").substr(0, 7), "sample,");
  EXPECT_FALSE(std::filesystem::exists(path("out.csv")));
}

TEST_F(Port, SaysWhatIsWrong) {
  expect_bad({"run", "--port", "/dev/null", "--seconds", "1"}, {"/dev/null", "no serial line"});
  expect_bad({"run", "--port", "no-such-port"}, {"no-such-port", "No such file"});
  expect_bad({"run", "--port", "/dev/null", "--seconds", "-1"}, {"--seconds"});
  file("a.csv", "time_s\n");
  expect_bad({"run", "a.csv", "--port", "/dev/null"}, {"--port", "recording"});
  expect_bad({"run", "a.csv", "--seconds", "3"}, {"--port"});
}

}  // namespace
}  // namespace hemi::cli::testing
