// SPDX-License-Identifier: Apache-2.0
// What does not fit the core's registers, said in the terms of the instrument model.
#ifndef HEMI_CLI_REGISTER_CHECK_HPP
#define HEMI_CLI_REGISTER_CHECK_HPP

#include "cli/settings.hpp"

namespace hemi::cli {

/// InputError at the first register whose value its format cannot hold: names the model's key, the value, the
/// register's range and what would fit. The same for all engines, those without rounding included.
void check_registers(const Setup& setup, const recording::InstrumentModel* model);

}  // namespace hemi::cli

#endif  // HEMI_CLI_REGISTER_CHECK_HPP
