// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TB_GOLDEN_ENGINE_HPP
#define HEMI_TB_GOLDEN_ENGINE_HPP

#include <memory>

#include "golden/chain/chain.hpp"
#include "tb/engine.hpp"

namespace hemi::tb {

/// The golden model: quantised, fed with the registers that the core would hold, or ideal, with the values as
/// given. Taps come from the quantised model only.
std::unique_ptr<Engine> make_golden_engine(bool wide, golden::Precision precision);

}  // namespace hemi::tb

#endif  // HEMI_TB_GOLDEN_ENGINE_HPP
