// SPDX-License-Identifier: Apache-2.0
// Tops of the kernels that work at each sample.
#include "hls/cic.hpp"
#include "hls/demodulator.hpp"
#include "hls/modulator.hpp"
#include "hls/tops/ports.hpp"
#include "hls/tops/tops.hpp"

using namespace hemi::hls;
using hemi::config::Reference;

HEMI_TOP_OUTPUT(phase)
HEMI_TOP_OUTPUT(cosine)
HEMI_TOP_OUTPUT(sine)
extern "C" void hemi_nco(bool reset, std::int64_t increment, std::int64_t* phase, std::int32_t* cosine,
                         std::int32_t* sine) {
  static Nco nco;
  if (reset) nco.reset();
  const SinCos output = nco.output();
  *phase = raw(nco.phase());
  *cosine = word(output.cosine);
  *sine = word(output.sine);
  if (!reset) nco.advance(from_raw<Increment>(increment));
}

HEMI_TOP_OUTPUT(xi)
HEMI_TOP_OUTPUT(xq)
HEMI_TOP_OUTPUT(yi)
HEMI_TOP_OUTPUT(yq)
extern "C" void hemi_demodulator(std::int32_t x, std::int32_t y, std::int32_t cosine, std::int32_t sine,
                                 std::int32_t* xi, std::int32_t* xq, std::int32_t* yi, std::int32_t* yq) {
  using Mixer = Demodulator<Reference>;
  Product products[channels];
  Mixer::mix(from_raw<Mixer::Adc>(x), from_raw<Mixer::Adc>(y), {from_raw<Sine>(cosine), from_raw<Sine>(sine)},
             products);
  *xi = word(products[0]);
  *xq = word(products[1]);
  *yi = word(products[2]);
  *yq = word(products[3]);
}

HEMI_TOP_OUTPUT(baseband_xi)
HEMI_TOP_OUTPUT(baseband_xq)
HEMI_TOP_OUTPUT(baseband_yi)
HEMI_TOP_OUTPUT(baseband_yq)
extern "C" void hemi_cic(bool reset, bool tick, std::int32_t xi, std::int32_t xq, std::int32_t yi,
                         std::int32_t yq, std::int32_t* baseband_xi, std::int32_t* baseband_xq,
                         std::int32_t* baseband_yi, std::int32_t* baseband_yq) {
  static Cic<Reference> cic[channels];
  const std::int32_t in[channels] = {xi, xq, yi, yq};
  std::int32_t out[channels] = {0, 0, 0, 0};
  for (int i = 0; i < channels; ++i) {
    if (reset) {
      cic[i].reset();
    } else {
      cic[i].integrate(from_raw<Product>(in[i]));
      if (tick) out[i] = word(cic[i].decimate());
    }
  }
  *baseband_xi = out[0];
  *baseband_xq = out[1];
  *baseband_yi = out[2];
  *baseband_yq = out[3];
}

namespace {

/// hls/actuators.hpp has the modulator's parts among the loops; here they are by themselves.
class Modulator {
 public:
  void reset() {
    drive_dac_.reset();
    rebalance_dac_.reset();
    quadrature_dac_.reset();
    drive_ = rebalance_ = pending_drive_ = pending_rebalance_ = Command();
    offset_ = pending_offset_ = Angle();
    quadrature_word_ = pending_quadrature_word_ = DacWord();
  }

  void sample(const Phase& phase, Sine& carrier, DacWord& drive, DacWord& rebalance) {
    carrier = Nco::look_up(wrap_add(phase, offset_)).sine;
    drive = drive_dac_.step(-(drive_ * carrier));
    rebalance = rebalance_dac_.step(-(rebalance_ * carrier));
  }

  void take_over() {
    drive_ = pending_drive_;
    rebalance_ = pending_rebalance_;
    offset_ = pending_offset_;
    quadrature_word_ = pending_quadrature_word_;
  }

  void leave(const Command& drive, const Command& rebalance, const Command& quadrature,
             const Increment& increment, const Registers& r) {
    pending_drive_ = drive;
    pending_rebalance_ = rebalance;
    pending_offset_ = CarrierOffset::value(increment, r);
    pending_quadrature_word_ = quadrature_dac_.step(quadrature);
  }

  DacWord quadrature_word() const { return quadrature_word_; }
  Angle pending_offset() const { return pending_offset_; }

 private:
  ShapedDac drive_dac_, rebalance_dac_, quadrature_dac_;
  Command drive_, rebalance_, pending_drive_, pending_rebalance_;
  Angle offset_, pending_offset_;
  DacWord quadrature_word_, pending_quadrature_word_;
};

}  // namespace

HEMI_TOP_OUTPUT(carrier)
HEMI_TOP_OUTPUT(dac_drive)
HEMI_TOP_OUTPUT(dac_rebalance)
HEMI_TOP_OUTPUT(dac_quadrature)
HEMI_TOP_OUTPUT(carrier_offset)
extern "C" void hemi_modulator(bool reset, bool tick, std::int64_t phase, std::int32_t drive,
                               std::int32_t rebalance, std::int32_t quadrature, std::int64_t increment,
                               std::int32_t modulation_phase, std::int32_t modulation_delay,
                               std::int32_t* carrier, std::int32_t* dac_drive, std::int32_t* dac_rebalance,
                               std::int32_t* dac_quadrature, std::int32_t* carrier_offset) {
  static Modulator modulator;
  Sine sine;
  DacWord drive_word, rebalance_word;
  if (reset) {
    modulator.reset();
  } else {
    modulator.sample(from_raw<Phase>(phase), sine, drive_word, rebalance_word);
  }
  *carrier = word(sine);
  *dac_drive = word(drive_word);
  *dac_rebalance = word(rebalance_word);
  *dac_quadrature = word(modulator.quadrature_word());
  if (tick && !reset) {
    Registers r;
    r.modulation_phase = from_raw<Angle>(modulation_phase);
    r.modulation_delay = from_raw<RegisterWord<hemi::config::reg_modulation_delay>>(modulation_delay);
    modulator.take_over();
    modulator.leave(from_raw<Command>(drive), from_raw<Command>(rebalance), from_raw<Command>(quadrature),
                    from_raw<Increment>(increment), r);
  }
  *carrier_offset = word(modulator.pending_offset());
}
