// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "golden/chain/actuators.hpp"
#include "golden/chain/cic.hpp"
#include "golden/chain/compensation.hpp"
#include "golden/chain/frequency_tracker.hpp"
#include "golden/chain/modulator.hpp"
#include "golden/chain/nco.hpp"
#include "golden/chain/phase_detector.hpp"
#include "golden/chain/reference_phase_loop.hpp"
#include "golden/chain/start_up.hpp"
#include "golden/chain/status.hpp"

namespace hemi::golden {

/// What distinguishes one instrument from another.
struct InstrumentParameters {
  int adc_bits;
  double adc_rate_hz;  ///< nominal
  int decimation;      ///< samples a tick

  static InstrumentParameters reference();
  static InstrumentParameters wide();
};

/// One output: the words of config::RecordWord in real units. frequency: nominal Hz; amplitude, phase
/// error [turns], drive and quadrature commands are sums over 50 ticks; rates and bias in deg/h; derivative
/// as a fraction of its full scale; status as a number.
struct ChainRecord {
  std::array<double, config::record_words> words;
};

/// Receives the outputs of all blocks, in the order of config::TapIndex within a sample, a tick and an
/// output.
class TapListener {
 public:
  virtual ~TapListener() = default;
  /// value: in the tap's unit; a multiple of 2^-fraction when quantised.
  virtual void tap(config::TapIndex index, double value) = 0;
};

/// The signal chain from two pickoffs, or from telemetry, to the compensated rate, in double precision
/// (docs/chain.md).
///
/// Quantised, its taps, words and status bits are those of the fixed-point core bit for bit. Ideal, it is the
/// same chain without rounding, table, saturation or parity: cosine, sine, arc tangent and magnitude (times
/// the CORDIC gain) as such. What limits the instrument itself stays: the limits of the actuator loops and
/// the range of the DACs. Of the status bits those remain that are states of the instrument and not of its
/// arithmetic.
class Chain {
 public:
  /// values: registers in real units, indexed by config::RegisterIndex; on the grids of their formats when
  /// quantised (std::invalid_argument otherwise). parity: its 54-bit word as a signed number.
  Chain(Precision precision, const InstrumentParameters& instrument, const RegisterValues& values);

  /// Takes samples in and appends the records that they complete. x_lsb, y_lsb: ADC words, equally many; gap:
  /// nonzero where the sample follows a gap, or null.
  void samples(const Eigen::Ref<const Eigen::VectorXd>& x_lsb, const Eigen::Ref<const Eigen::VectorXd>& y_lsb,
               const std::vector<std::uint8_t>* gap, std::vector<ChainRecord>& out);

  /// Takes one sample in, ADC words, and returns what the DACs get with it; the closed loop's way. Its
  /// records, taps and states are those of samples().
  DacWords step(double x_lsb, double y_lsb, bool gap, std::vector<ChainRecord>& out);

  /// Takes one telemetry sample in and appends its record; words are brought to the nearest of their formats.
  void telemetry(double frequency_hz, double rate_dph, bool valid, std::vector<ChainRecord>& out);

  /// Null: nobody listens. The listener must outlive its use.
  void set_taps(TapListener* listener) { listener_ = listener; }

 private:
  struct IntervalSums {
    double now = 0.0;
    double before = 0.0;
    double close();
  };

  void tap(config::TapIndex index, double value) {
    if (listener_ != nullptr) listener_->tap(index, value);
  }
  void part_of_tick(const Eigen::Ref<const Eigen::VectorXd>& x_lsb,
                    const Eigen::Ref<const Eigen::VectorXd>& y_lsb);
  void tap_samples(Eigen::Index count,
                   const Eigen::Ref<const Cic::Products, 0, Eigen::OuterStride<>>& products);
  void close_part(Eigen::Index count, std::vector<ChainRecord>& out);
  void tick();
  void actuate(const Polar& primary, const Secondary& secondary);
  void tap_actuators();
  void output(std::vector<ChainRecord>& out);
  void finish(ChainRecord record, double frequency_hz, double rate_dph, bool good,
              std::vector<ChainRecord>& out);

  Arithmetic arithmetic_;
  InstrumentParameters instrument_;
  RegisterValues values_;
  bool parity_error_;
  bool control_;

  Nco nco_;
  Cic cic_;
  ImageFilter image_filter_;
  StartUp start_up_;
  ReferencePhaseLoop loop_;
  Actuators actuators_;
  Modulator modulator_;
  FrequencyTracker tracker_;
  RateFilter rate_filter_;
  Thermometer thermometer_;
  Derivative derivative_;
  BiasModel bias_model_;
  Status status_;

  Eigen::Index sample_in_tick_ = 0;
  int tick_in_output_ = 0;
  int outputs_ = 0;  // counted up to the first valid frequency
  IntervalSums amplitude_;
  IntervalSums phase_error_;
  IntervalSums drive_;
  IntervalSums quadrature_;
  Eigen::ArrayXd phase_;
  Eigen::ArrayXd cosine_;
  Eigen::ArrayXd sine_;
  Eigen::ArrayXd carrier_;
  Eigen::ArrayXd dac_drive_;
  Eigen::ArrayXd dac_rebalance_;
  TapListener* listener_ = nullptr;
};

}  // namespace hemi::golden
