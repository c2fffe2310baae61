/* SPDX-License-Identifier: Apache-2.0 */
/* What a firmware sees of hemi_registers.h, as the C and the C++ compiler read it. */
#ifndef HEMI_TESTS_RTL_REGISTERS_HEADER_CHECK_H
#define HEMI_TESTS_RTL_REGISTERS_HEADER_CHECK_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct header_view {
  int register_count, record_words, parity_index, status_register, telemetry_rate_index;
  unsigned axi_rebalance_limit, axi_status_high, axi_live_status, axi_interrupt_pending;
  int board_status, board_control, board_baud;
  uint32_t axi_identity, board_identity;
  int64_t sticky_frequency_invalid;
  int nco_start_fraction, parity_width, record_rate_width;
  const char* (*register_name)(int index);
  int (*register_width)(int index);
  int (*register_fraction)(int index);
  const char* (*record_name)(int index);
  int (*record_fraction)(int index);
  int64_t (*to_raw)(double value, int fraction);
  double (*to_value)(int64_t raw, int fraction);
  int64_t (*parity)(const int64_t* image);
  int64_t (*through_halves)(int64_t raw);
};

struct header_view view_of_c(void);
struct header_view view_of_cxx(void);

#ifdef __cplusplus
}
#endif

#endif
