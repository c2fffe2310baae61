// SPDX-License-Identifier: Apache-2.0
// A concealed recording as files: what the diagnosis may see, and the truth elsewhere.
#ifndef HEMI_CLI_PROVE_WRITE_HPP
#define HEMI_CLI_PROVE_WRITE_HPP

#include <string>

#include "cli/recording/json.hpp"
#include "golden/concealed/cases.hpp"

namespace hemi::prove {

/// NAME.csv, NAME.json and NAME.model.json in `directory`; nothing in them tells the class. OutputError.
void write_concealed(const concealed::Case& hidden, const std::string& directory, const std::string& name);

/// What write_concealed kept back; docs/prove.md has the keys.
recording::Json truth_json(const concealed::Case& hidden, const std::string& name);

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_WRITE_HPP
