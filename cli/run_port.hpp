// SPDX-License-Identifier: Apache-2.0
// `hemi run --port`: the reference design at the other end of a serial line.
#ifndef HEMI_CLI_RUN_PORT_HPP
#define HEMI_CLI_RUN_PORT_HPP

#include <optional>
#include <string>
#include <vector>

#include "cli/recording/model.hpp"
#include "cli/settings.hpp"
#include "tb/engine.hpp"

namespace hemi::cli {

struct PortOptions {
  std::string port;
  double seconds = 0.0;                ///< of instrument time
  std::optional<double> frequency_hz;  ///< where the nco starts; else the model's at 20 degC
  std::optional<double> window_s;      ///< of df/dt
};

struct PortRun {
  Setup setup;
  std::vector<tb::Record> records;
  std::vector<std::string> faults;  ///< that the board saw meanwhile
};

/// Registers of the board: those of the model; without one, of the nominal instrument without temperature.
Setup board_setup(const PortOptions& options, const recording::InstrumentModel* model);

/// Loads the registers, starts the board, reads its records, stops it: also where an error or Ctrl-C ends the
/// run. InputError where the port cannot be opened, nobody answers or a record is lost.
PortRun run_port(const PortOptions& options, const recording::InstrumentModel* model);

}  // namespace hemi::cli

#endif  // HEMI_CLI_RUN_PORT_HPP
