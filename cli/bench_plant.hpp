// SPDX-License-Identifier: Apache-2.0
// Speed of the simulations: the plant closed around an engine, and the slow twin.
#ifndef HEMI_CLI_BENCH_PLANT_HPP
#define HEMI_CLI_BENCH_PLANT_HPP

#include <string>
#include <vector>

namespace hemi::cli {

/// Instrument time over computing time of the nominal instrument in force-to-rebalance mode with all its
/// noise, one value a repetition, sorted; each repetition takes about `seconds`.
std::vector<double> closed_loop_speed(const std::string& engine, double seconds, int repetitions);

/// Milliseconds for five hours of 1 Hz telemetry with all channels and noise, sorted.
std::vector<double> slow_twin_ms(int repetitions);

}  // namespace hemi::cli

#endif  // HEMI_CLI_BENCH_PLANT_HPP
