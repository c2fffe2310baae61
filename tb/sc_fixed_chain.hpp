// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TB_SC_FIXED_CHAIN_HPP
#define HEMI_TB_SC_FIXED_CHAIN_HPP

#include <memory>

#include "tb/engine.hpp"

namespace hemi::tb {

/// The same core of hls/ with SystemC's sc_fixed in place of our own type: proves the swap, and is the
/// yardstick for speed. Reference instrument; sends no taps.
std::unique_ptr<Engine> make_sc_fixed_engine();

}  // namespace hemi::tb

#endif  // HEMI_TB_SC_FIXED_CHAIN_HPP
