// SPDX-License-Identifier: Apache-2.0
// Addresses of the register port: the registers in the order of config::RegisterIndex, then telemetry.
#ifndef HEMI_RTL_ADDRESS_MAP_HPP
#define HEMI_RTL_ADDRESS_MAP_HPP

#include "hls/config.hpp"

namespace hemi {

constexpr int telemetry_frequency_address = config::register_count;  ///< of the next telemetry sample
constexpr int telemetry_rate_address = telemetry_frequency_address + 1;
constexpr int first_state_address = telemetry_rate_address + 1;  ///< from here on the port writes nothing

}  // namespace hemi

#endif  // HEMI_RTL_ADDRESS_MAP_HPP
