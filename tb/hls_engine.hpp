// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TB_HLS_ENGINE_HPP
#define HEMI_TB_HLS_ENGINE_HPP

#include <memory>

#include "tb/engine.hpp"

namespace hemi::tb {

/// The fixed-point core of hls/ on the host: config::Wide when `wide`, else config::Reference.
std::unique_ptr<Engine> make_hls_engine(bool wide);

}  // namespace hemi::tb

#endif  // HEMI_TB_HLS_ENGINE_HPP
