// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/start_up.hpp"

namespace hemi::golden {

using namespace config;

void StartUp::tick(double amplitude, bool locked) {
  low_ = amplitude < settings_.amplitude_threshold;
  restart_ = false;
  if (!settings_.control) {
    state_ = state_open;
    return;
  }
  switch (state_) {
    case state_open:
    case state_search:
      if (amplitude >= settings_.search_amplitude) {
        state_ = state_acquire;
      } else {
        search();
      }
      break;
    case state_acquire:
      if (low_) {
        state_ = state_search;
      } else if (locked) {
        state_ = state_rise;
      }
      break;
    case state_rise:
    case state_run:
      if (low_) {
        hold_over();
        break;
      }
      holdover_count_ = 0.0;
      if (!locked) {
        state_ = state_acquire;
      } else if (amplitude >= settings_.closing_amplitude) {
        state_ = state_run;
      }
      break;
  }
}

void StartUp::search() {
  state_ = state_search;
  search_count_ += 1.0;
  if (search_count_ < settings_.search_ticks) return;
  search_count_ = 0.0;
  offset_ = arithmetic_.wrap(offset_ + settings_.search_step, increment);
  if (offset_ > settings_.search_span) offset_ = 0.0 - settings_.search_span;
  restart_ = true;
}

void StartUp::hold_over() {
  holdover_count_ += 1.0;
  if (holdover_count_ < settings_.holdover_ticks) return;
  state_ = state_search;
  holdover_count_ = search_count_ = offset_ = 0.0;
  restart_ = true;
}

}  // namespace hemi::golden
