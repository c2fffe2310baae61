// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_CLI_PROVE_RIVAL_METHODS_HPP
#define HEMI_CLI_PROVE_RIVAL_METHODS_HPP

#include <map>
#include <string>

#include "cli/prove/answer.hpp"

namespace hemi::prove {

/// What other methods (golden/rivals) say about the same files, by the method's name. InputError.
std::map<std::string, Answer> rival_answers(const std::string& recording_path, const std::string& model_path);

}  // namespace hemi::prove

#endif  // HEMI_CLI_PROVE_RIVAL_METHODS_HPP
