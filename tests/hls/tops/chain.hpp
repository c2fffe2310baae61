// SPDX-License-Identifier: Apache-2.0
// The reference instrument's core put together from the kernels' tops, by docs/chain.md.
//
// Tops keep their state inside: there is one such chain in a program, and reset() starts it anew.
#ifndef HEMI_TESTS_HLS_TOPS_CHAIN_HPP
#define HEMI_TESTS_HLS_TOPS_CHAIN_HPP

#include <array>
#include <cstdint>
#include <optional>

#include "hls/registers.hpp"
#include "tb/engine.hpp"
#include "tests/hls/tops/recorder.hpp"

namespace hemi::tests {

class TopChain {
 public:
  using Words = std::array<std::int64_t, config::record_words>;
  struct Dac {
    std::int32_t drive, rebalance, quadrature;
  };

  /// `taps` hears the outputs of the tops, but for dac_quadrature, which dac() has.
  TopChain(Recorder& call, tb::TapSink& taps) : call_(call), taps_(taps) {}

  void reset(const tb::RegisterImage& image);
  /// One sample pair; the record's raw words where one has become complete.
  std::optional<Words> sample(std::int32_t x, std::int32_t y, bool gap);
  Words telemetry(std::int64_t frequency, std::int64_t rate, bool valid);
  const Dac& dac() const { return dac_; }

 private:
  struct Channels {
    std::int32_t xi, xq, yi, yq;
  };
  struct Polar {
    std::int64_t amplitude;
    std::int32_t phase_error;
    std::int32_t in_phase, quadrature;
  };
  /// What a tick leaves for the modulator.
  struct Commands {
    std::int32_t drive = 0, rebalance = 0, quadrature = 0;
  };

  void raise(config::StatusBit bit, bool condition);
  Polar detect(const Channels& decimated);
  Commands close_loops(const Polar& polar);
  void track(std::int64_t phase, const Polar& polar, const Commands& commands, bool output);
  Words output();
  Words finish(std::int64_t frequency, std::int64_t rate, bool valid, bool good, Words words);
  std::int64_t reg(config::RegisterIndex index) const { return image_[index]; }

  Recorder& call_;
  tb::TapSink& taps_;
  tb::RegisterImage image_{};
  hls::Registers registers_;
  std::int64_t increment_ = 0, pending_increment_ = 0;
  bool locked_ = false;
  std::int32_t raised_ = 0;
  std::int64_t frequency_ = 0, amplitude_sum_ = 0, phase_error_sum_ = 0, rate_ = 0;
  hls::CommandSum drive_sum_, last_drive_sum_, quadrature_sum_, last_quadrature_sum_;
  Dac dac_{};
  int samples_ = 0, ticks_ = 0, outputs_ = 0;
};

}  // namespace hemi::tests

#endif  // HEMI_TESTS_HLS_TOPS_CHAIN_HPP
