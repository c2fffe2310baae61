// SPDX-License-Identifier: Apache-2.0
// Heat on its way from the chamber to the shell, and from the electronics to its board.
#pragma once

#include <array>

#include "golden/physics/instrument.hpp"

namespace hemi::physics {

/// exp(-dt/tau) and what follows from it, kept while the step stays the same.
class Pole {
 public:
  /// tau_s: 0 for no lag.
  explicit Pole(double tau_s) : tau_s_(tau_s) {}

  /// Exact solution of tau x' = u - x after dt_s, u linear from u0 to u1.
  double advance(double x, double u0, double u1, double dt_s);
  double tau_s() const { return tau_s_; }

 private:
  double tau_s_;
  double dt_s_ = 0.0;
  double decay_ = 1.0;       ///< e = exp(-dt/tau)
  double slope_gain_ = 0.0;  ///< 1 - (1 - e) tau/dt: part of u1 - u0 that arrives
};

/// Rise of something that is heated from the moment of power-on: tau r' = rise - r while on, tau r' = -r
/// while off. From rest this is rise (1 - exp(-t/tau)); a later moment of power-on is a power cycle, which
/// goes on from the rise reached.
class PowerOnRise {
 public:
  PowerOnRise(double rise_degc, double tau_s) : rise_degc_(rise_degc), pole_(tau_s) {}

  /// At the first instant: on since power_on_s, or off before it.
  void start(double time_s, double power_on_s);
  void advance(double time_s, double power_on_s);
  double value_degc() const { return value_degc_; }

 private:
  double rise_degc_;
  Pole pole_;
  double time_s_ = 0.0;
  double value_degc_ = 0.0;
};

/// Chamber -> case -> stem -> shell, one pole each, time constants from the instrument (0: that node follows
/// at once):
///
///     tau_k T_k' = T_(k-1) - T_k,   k = case, stem, shell,   T_0 = chamber
///
/// solved exactly (matrix exponential) for a chamber that is linear between updates.
class ThermalNetwork {
 public:
  ThermalNetwork(const Instrument& instrument, double start_degc);

  /// Takes over other time constants; cheap where they are the same.
  void set_time_constants(const Instrument& instrument);
  void advance(double chamber_degc, double dt_s);

  double case_degc() const { return nodes_[0]; }
  double stem_degc() const { return nodes_[1]; }
  double shell_degc() const { return nodes_[2]; }
  /// dT/dt of the shell at this instant.
  double shell_slope_degc_s() const { return slope_degc_s_; }

 private:
  static constexpr int kNodes = 3;
  void prepare(double dt_s);

  std::array<double, kNodes> tau_s_;
  std::array<double, kNodes> nodes_;
  double chamber_degc_;
  double slope_degc_s_ = 0.0;
  double dt_s_ = 0.0;  ///< of the coefficients below; 0: none yet
  /// nodes(t + dt) = transition (nodes, chamber at the start, its rise over the step)
  std::array<std::array<double, kNodes + 2>, kNodes> transition_{};
};

/// Steps that differ by rounding of the time stamps alone count as the same: their effect on a temperature is
/// below 1e-9 of its change over one step.
inline bool same_step(double a_s, double b_s) {
  return a_s - b_s < 1e-9 * b_s && b_s - a_s < 1e-9 * b_s;
}

}  // namespace hemi::physics
