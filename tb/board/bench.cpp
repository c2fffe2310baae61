// SPDX-License-Identifier: Apache-2.0
#include "tb/board/bench.hpp"

#include <verilated.h>

#include <stdexcept>
#include <utility>

#include "Vhemi_board.h"
#include "tb/board/converters.hpp"

namespace hemi::tb {

struct BoardBench::Model {
  VerilatedContext context;
  Vhemi_board top{&context};
  AdcPins adc;
  DacPins dac;
};

BoardBench::BoardBench(PlantPort& plant, std::function<void(const BoardPeriod&)> on_period,
                       double host_bit_clocks)
    : plant_(plant),
      on_period_(std::move(on_period)),
      model_(std::make_unique<Model>()),
      sender_(host_bit_clocks),
      receiver_(host_bit_clocks) {
  model_->top.button_ni = 0;
  model_->top.rx_i = 1;
  model_->top.adc_sdo_x_i = 1;
  model_->top.adc_sdo_y_i = 1;
  // The PLL locks while the button is held; until then the pins need not rest.
  constexpr int start_clocks = 32;
  for (int i = 0; i < start_clocks; ++i) {
    for (const int level : {1, 0}) {
      model_->top.crystal_i = level != 0;
      model_->top.eval();
    }
  }
  model_->top.button_ni = 1;
}

BoardBench::~BoardBench() {
  model_->top.final();
}

DacWords BoardBench::waiting() const {
  return model_->dac.waiting();
}

bool BoardBench::active() const {
  return model_->top.active_no == 0;
}

bool BoardBench::fault() const {
  return model_->top.fault_no == 0;
}

std::optional<std::uint8_t> BoardBench::clock() {
  Vhemi_board& top = model_->top;
  top.rx_i = sender_.clock();
  top.crystal_i = 1;
  top.eval();
  top.crystal_i = 0;
  top.eval();
  ++clocks_;
  converters();
  return receiver_.clock(top.tx_o != 0);
}

void BoardBench::converters() {
  Vhemi_board& top = model_->top;
  model_->dac.clock({top.dac_ldac_no != 0, top.dac_cs_no != 0, top.dac_sck_o != 0, top.dac_drive_o != 0,
                     top.dac_rebalance_o != 0, top.dac_quadrature_o != 0});
  const bool instant = model_->adc.clock(top.adc_cnv_o != 0, top.adc_sck_o != 0);
  top.adc_sdo_x_i = model_->adc.sdo_x();
  top.adc_sdo_y_i = model_->adc.sdo_y();
  if (instant) begin_period();
  if (model_->dac.received() && awaiting_frame_) end_frame();
}

/// Here the ADCs sample, and the DACs take what came in the period before.
void BoardBench::begin_period() {
  if (awaiting_frame_) throw std::runtime_error("board: no DAC frame between two samples");
  if (!model_->dac.loaded()) throw std::runtime_error("board: LDAC does not fall when the ADCs sample");
  awaiting_frame_ = true;
}

/// The plant takes words one period before they act, so it goes on to this instant only now that they are
/// known: the ADC is still converting.
void BoardBench::end_frame() {
  awaiting_frame_ = false;
  if (samples_ > 0) plant_.act(model_->dac.waiting());
  period_ = {samples_, plant_.sample(), model_->dac.in_force(), model_->dac.waiting()};
  model_->adc.convert(period_.pair);
  ++samples_;
  on_period_(period_);
}

}  // namespace hemi::tb
