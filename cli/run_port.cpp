// SPDX-License-Identifier: Apache-2.0
#include "cli/run_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "cli/calibrate.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/progress.hpp"
#include "golden/loops/control.hpp"
#include "tb/board/host.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

using recording::InputError;

/// A serial line of the system, raw, at the board's baud rate.
class SerialPort : public tb::LinkPort {
 public:
  explicit SerialPort(std::string path)
      : path_(std::move(path)), descriptor_(open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (descriptor_ < 0) refuse(std::strerror(errno), "check its name and that you may open it");
    try {
      set_line();
    } catch (...) {
      close(descriptor_);
      throw;
    }
  }

  ~SerialPort() override { close(descriptor_); }
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// From now on Ctrl-C does not end a wait.
  void finish() { interruptible_ = false; }

  void write(std::span<const std::uint8_t> bytes) override {
    while (!bytes.empty()) {
      const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
      if (n > 0) bytes = bytes.subspan(static_cast<std::size_t>(n));
      if (n < 0 && errno != EAGAIN && errno != EINTR)
        refuse(std::strerror(errno), "is the board still there?");
      if (!bytes.empty()) wait(POLLOUT);
    }
  }

  std::vector<std::uint8_t> read() override {
    std::vector<std::uint8_t> bytes(4096);
    ssize_t n = -1;
    // Of a tenth of a second each at most; fewer on the way out, where nobody wants to wait.
    const int waits = interruptible_ ? 50 : 5;
    for (int i = 0; i < waits && n < 0; ++i) {
      wait(POLLIN);
      n = ::read(descriptor_, bytes.data(), bytes.size());
      if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR))
        refuse("the line is closed", "is the board still there?");
    }
    bytes.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return bytes;
  }

 private:
  [[noreturn]] void refuse(const char* problem, const char* remedy) const {
    throw InputError({path_}, problem, remedy);
  }

  void set_line() const {
    termios line{};
    if (tcgetattr(descriptor_, &line) != 0)
      refuse("is no serial line", "name the board's, such as /dev/ttyUSB1");
    cfmakeraw(&line);
    line.c_cflag |= CLOCAL | CREAD;
    static_assert(board::baud == 1000000, "the speed below is the board's");
    cfsetspeed(&line, B1000000);
    if (tcsetattr(descriptor_, TCSANOW, &line) != 0)
      refuse("does not go at 1 Mbaud", "take another serial adapter");
    tcflush(descriptor_, TCIOFLUSH);
  }

  void wait(short events) const {
    if (interruptible_) recording::check_interrupt();
    pollfd here{descriptor_, events, 0};
    constexpr int slice_ms = 100;
    poll(&here, 1, slice_ms);
  }

  std::string path_;
  int descriptor_;
  bool interruptible_ = true;
};

std::vector<std::string> fault_names(int faults) {
  constexpr std::array<std::pair<board::Fault, const char*>, 4> names = {
      {{board::fault_sample_lost, "a sample was lost"},
       {board::fault_words_late, "DAC words came late"},
       {board::fault_bad_request, "a request arrived spoilt"},
       {board::fault_request_lost, "a request came before the answer to the last"}}};
  std::vector<std::string> found;
  for (const auto& [bit, name] : names) {
    if ((faults & bit) != 0) found.emplace_back(name);
  }
  return found;
}

void read_records(tb::BoardHost& host, std::size_t count, PortRun& run) {
  recording::Progress progress("recording", static_cast<double>(count));
  while (run.records.size() < count) {
    run.records.push_back(host.record());
    progress.update(static_cast<double>(run.records.size()));
    recording::check_interrupt();
  }
}

}  // namespace

Setup board_setup(const PortOptions& options, const recording::InstrumentModel* model) {
  Setup setup;
  if (model != nullptr) {
    setup = core_setup(*model, options.window_s);
  } else {
    const physics::Instrument nominal;
    recording::RawCapture capture;
    capture.sample_rate_hz = sampling(false).adc_rate_hz;
    capture.full_scale_lsb = std::ldexp(1.0, sampling(false).adc_bits - 1);
    const double start_hz =
        nominal.at(loops::ControlWishes{}.start_degc).omega_rad_s / (2 * std::numbers::pi);
    setup = capture_setup(capture, nullptr, options.frequency_hz.value_or(start_hz), options.window_s);
    loops::set_control(setup.values, nominal, loops::CoreSampling::reference());
  }
  if (options.frequency_hz)
    setup.values[config::reg_nco_start] = *options.frequency_hz / sampling(false).adc_rate_hz;
  return setup;
}

PortRun run_port(const PortOptions& options, const recording::InstrumentModel* model) {
  PortRun run{board_setup(options, model), {}, {}};
  const auto count = static_cast<std::size_t>(std::ceil(options.seconds / run.setup.output_period_s - 1e-9));
  SerialPort port(options.port);
  tb::BoardHost host(port);
  try {
    host.identify();
    host.start(tb::to_image(run.setup.values));
    read_records(host, count, run);
    run.faults = fault_names(host.faults());
    host.stop();
  } catch (...) {
    // Whatever ended this, the actuators come to rest where the board still listens.
    const auto why = std::current_exception();
    port.finish();
    try {
      host.stop();
    } catch (const std::exception&) {
    }
    try {
      std::rethrow_exception(why);
    } catch (const tb::LinkError& error) {
      throw InputError({options.port}, error.what(), "check the line, reset the board and run again");
    }
  }
  return run;
}

}  // namespace hemi::cli
