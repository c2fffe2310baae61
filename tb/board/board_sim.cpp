// SPDX-License-Identifier: Apache-2.0
// hemi_board_sim: the reference design in simulation behind a pseudo-terminal, for `hemi run --port`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>

#include "cli/recording/interrupt.hpp"
#include "rtl/address_map.hpp"
#include "tb/board/bench.hpp"
#include "tb/board/pty.hpp"
#include "tb/board/world.hpp"

namespace hemi::tb {
namespace {

struct Options {
  BoardWorld world;
  std::string words;
  double host_baud = board::baud;
};

/// One line a sample: what was converted, and what the DACs gave from that instant on.
class WordsFile {
 public:
  explicit WordsFile(const std::string& path) : path_(path) {
    if (path.empty()) return;
    file_.open(path);
    file_ << "sample,adc_x,adc_y,drive,rebalance,quadrature\n";
    check();
  }

  void write(const BoardPeriod& p) {
    if (path_.empty()) return;
    file_ << fmt::format("{},{},{},{},{},{}\n", p.sample, p.pair.x, p.pair.y, p.in_force.drive,
                         p.in_force.rebalance, p.in_force.quadrature);
  }

  void close() {
    if (path_.empty()) return;
    file_.close();
    check();
  }

 private:
  void check() const {
    if (!file_) throw std::runtime_error("cannot write " + path_);
  }

  std::string path_;
  std::ofstream file_;
};

/// Until the host that once came has gone.
void serve(BoardBench& bench, Pty& pty) {
  constexpr int patience_ms = 20;
  while (!pty.connected(patience_ms)) recording::check_interrupt();
  constexpr int byte_clocks = 10 * board::baud_clocks;
  constexpr int bytes_a_look = 8;  // at whether the host is there
  std::vector<std::uint8_t> received;
  while (pty.connected(0)) {
    recording::check_interrupt();
    for (int i = 0; i < bytes_a_look; ++i) {
      for (const std::uint8_t byte : pty.read()) bench.send(byte);
      for (int k = 0; k < byte_clocks; ++k) {
        if (const auto byte = bench.clock()) received.push_back(*byte);
      }
      if (!received.empty()) pty.write(received);
      received.clear();
    }
  }
}

int simulate(const Options& options) {
  physics::Plant plant = plant_of(options.world);
  PhysicsPort port(plant);
  WordsFile words(options.words);
  std::uint64_t samples = 0;
  BoardBench bench(
      port,
      [&](const BoardPeriod& period) {
        ++samples;
        words.write(period);
      },
      board::clock_hz / options.host_baud);
  Pty pty;
  fmt::print("{}\n", pty.name());
  std::fflush(stdout);
  serve(bench, pty);
  words.close();
  fmt::print("{} samples in {} clocks{}\n", samples, bench.clocks(), bench.fault() ? "; a fault is lit" : "");
  return 0;
}

}  // namespace
}  // namespace hemi::tb

int main(int argc, char** argv) {
  using namespace hemi;
  CLI::App app{
      "The reference design on the iCE40 UP5K in simulation: prints the name of a pseudo-terminal, its "
      "serial "
      "line, serves one host on it, and ends when the host closes it."};
  tb::Options options;
  app.add_option("--temperature", options.world.temperature_degc, "of the resonator [degC]")
      ->check(CLI::Range(-40.0, 80.0))
      ->capture_default_str();
  app.add_option("--rate", options.world.rate_dps, "about the sensing axis [deg/s]")
      ->check(CLI::Range(-100.0, 100.0))
      ->capture_default_str();
  app.add_option("--amplitude", options.world.amplitude, "at the start, nominal: 1")
      ->check(CLI::Range(0.0, 1.2))
      ->capture_default_str();
  app.add_option("--seed", options.world.seed, "of the noise")->capture_default_str();
  app.add_option("--host-baud", options.host_baud, "as the host's oscillator has it")
      ->check(CLI::Range(0.9 * board::baud, 1.1 * board::baud))
      ->capture_default_str();
  app.add_option("--words", options.words, "CSV file of each sample's ADC words and the DAC words in force");
  app.footer("Example: hemi_board_sim --rate 1 &  hemi run --port /dev/pts/3 --seconds 2 -o run.h5");
  CLI11_PARSE(app, argc, argv);
  recording::install_interrupt_handler();
  try {
    return tb::simulate(options);
  } catch (const recording::Interrupted&) {
    return recording::kInterruptedExitCode;
  } catch (const std::exception& error) {
    fmt::print(stderr, "hemi_board_sim: {}\n", error.what());
    return 3;
  }
}
