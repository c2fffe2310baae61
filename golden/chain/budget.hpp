// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "golden/chain/chain.hpp"

namespace hemi::golden {

/// Difference between the ideal and the quantised chain: never more than `worst`; `rms` where the single
/// errors are uniform in their step and independent of each other (a tone whose frequency is no simple
/// fraction of the ADC rate, with noise of a good part of an LSB on it).
struct Budget {
  double worst;
  double rms;
};

/// Where the chain works. Amplitudes are fractions of full scale.
struct OperatingPoint {
  InstrumentParameters instrument;
  double primary_amplitude;
  double secondary_amplitude;
  double secondary_phase_rad;  ///< ahead of the primary
};

/// The budget block by block, each with what the blocks before it pass on.
///
/// nco, error of cos or sin (1), h = pi/2/512 the angle between lines, t in [0, 1) the place between two of
/// them:
///   a chord lies inside the arc by (h^2 / 2) t (1 - t) sin: at most h^2 / 8, mean h^2 / 12 (an amplitude
///   error, the same for ever), standard deviation h^2 / (2 sqrt 180); sin has rms 1 / sqrt 2. lines rounded
///   to 2^-20: 2^-21; rms 2^-20 sqrt(2 / 3) / sqrt 12, as t^2 + (1 - t)^2 has mean 2 / 3. result rounded to
///   2^-19: 2^-20; rms 2^-19 / sqrt 12. angle within 2^-25 turn of the phase: pi 2^-24; rms pi 2^-23 / sqrt
///   12 / sqrt 2.
/// demodulator, error of a product: |x| times the above plus 2^-24; squares: a^2/2 times the above plus 2^-46
/// / 12. baseband: through the decimating filter with response c (cic and image filter, sum c = G = R^5/2^g
/// 49/64): worst
///   sum |c| <= G 81/49, rms sqrt(sum c^2); two roundings to 2^-27, the first passing the image filter
///   (81/64).
/// phase_detector, V = a/2 S/2^20 G the length of its vector, error of both coordinates E: sqrt 2 E / V rad,
/// rms E / V;
///   the CORDIC leaves an angle of at most 2^-23 rad, rms 2^-23 / sqrt 3; it drops up to 2^-32 from each
///   coordinate 24 times, a vector of at most 24 sqrt 2 2^-32 against V (mean square of a drop 2^-64 / 3); 24
///   angles, rounded to 2^-32 turn.
/// words: sums over ticks with weights s. What is independent from sample to sample is added in squares of
///   sum_t s_t c, what comes once a tick in squares of s; frequency is 8 Hz times (25 newer - 25 older)
///   phases, phases with the nco's floored to 2^-32 turn.
/// loop: the phase error is what the nco does not follow. With damping 1 the closed loop's impulse response
/// is
///   wn (2 - wn t) exp(-wn t), the integral of its magnitude 1 + 2 exp(-2) = 1.27: the nco's phase differs by
///   up to 1.27, the phase error by up to 2.27 times an error of the detector. The integral's rounding by
///   2^-49 counts as 2^-49 / Ki turns of it.
/// The nco's steps by Kp of that also pass the 1.5 samples by which nco and detector time differ.
/// rate: as baseband, of y; the nco's phase difference turns quadrature into in-phase.
/// rebalance_loop (control register odd): the rate is made of the command, of which this covers the
///   proportional part, i.e. rebalance_integral = 0 and a settled chain within its limits: Kp times the error
///   of in-phase, rounded to 2^-40, floored to 2^-30 (mean 2^-31, rms about it 2^-30 / sqrt 12). The
///   integrals of two chains that see the same samples drift apart without bound, as no plant brings them
///   together.
struct ChainBudget {
  Budget nco;                    ///< 1
  Budget baseband;               ///< 1, primary
  Budget detector_turns;         ///< one tick
  Budget frequency_hz;           ///< nominal Hz, record word
  Budget amplitude_sum;          ///< record word; rms includes the constant part
  Budget phase_error_sum_turns;  ///< record word
  Budget rate_dph;               ///< record word; rms includes the constant part
};

ChainBudget quantisation_budget(const OperatingPoint& point, const RegisterValues& values);

/// Response of the baseband words to the products, newest sample first: cic and image filter, sum G = R^5/2^g
/// 49/64.
Eigen::VectorXd baseband_response(int decimation);

/// Response of a sum over ticks to single samples: sum over t of tick_weights[t] response shifted by t R.
Eigen::VectorXd spread(const Eigen::VectorXd& response, const Eigen::VectorXd& tick_weights, int decimation);

/// +1 for the 25 ticks of the newer interval, -1 for those of the older one: frequency = 8 Hz times the
/// phases' sum.
Eigen::VectorXd frequency_tick_weights();

/// 1, 2, ..., 25, ..., 2, 1.
Eigen::VectorXd triangular_tick_weights();

}  // namespace hemi::golden
