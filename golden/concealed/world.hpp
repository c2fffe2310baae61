// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "golden/concealed/scenario.hpp"

namespace hemi::concealed {

using Values = std::map<std::string, double>;

/// Where in the making of a recording an effect may take a hand, in this order; kWritten comes
/// after the noise.
enum class Stage { kThermometer, kShell, kFrequency, kClock, kDrive, kQuadrature, kRate, kOutput, kWritten };

/// A recording in the making; each stage finds what the stages before it have made.
struct State {
  const Excitation* in = nullptr;
  const Model* model = nullptr;
  Series case_reading_degc{};
  Series shell_degc{};
  Series thermal_hz{};  ///< f of the shell's temperature alone: what the bias follows
  Series frequency_hz{};
  Series drive_v{};
  Series quadrature_v{};
  Series rate_dph{};
  Series amplitude{};

  Series& output(int which);
  const Series& output(int which) const;
};

/// One effect as it acts in one recording. Stateless: act() may be called for any number of recordings.
class Effect {
 public:
  virtual ~Effect() = default;
  virtual void act(State& state, Stage stage) const = 0;
};
using Effects = std::vector<std::shared_ptr<const Effect>>;

/// The instrument's outputs without noise: the baseline equations, and the effects on top.
State simulate(const Model& model, const Excitation& in, double start_offset_degc,
               const Effects& effects = {});

/// Central differences, one-sided at the ends [unit/s].
Series slope(const Series& values);

}  // namespace hemi::concealed
