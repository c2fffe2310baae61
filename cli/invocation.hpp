// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_CLI_INVOCATION_HPP
#define HEMI_CLI_INVOCATION_HPP

#include <string>

namespace hemi::cli {

/// The program's own arguments, for the reports that say how they were made. Called once by main().
void set_invocation(int argc, const char* const* argv);

/// The command as one would type it again; empty before set_invocation.
const std::string& invocation();

}  // namespace hemi::cli

#endif  // HEMI_CLI_INVOCATION_HPP
