// SPDX-License-Identifier: Apache-2.0
// The blocks of docs/chain.md, each a stretch of the schedule. Their words meet by name in the state memory.
// Clocks are instructions issued; latencies are filled with other blocks' instructions by the scheduler.
#ifndef HEMI_RTL_MICROCODE_BLOCKS_HPP
#define HEMI_RTL_MICROCODE_BLOCKS_HPP

#include "rtl/microcode/assembler.hpp"

namespace hemi::microcode {

constexpr int channels = 4;
inline const char* const channel_names[channels] = {"xi", "xq", "yi", "yq"};

void nco(Assembler& m);
void demodulator(Assembler& m);
void modulator_carrier(Assembler& m);
void modulator_sample(Assembler& m);
void modulator_take_over(Assembler& m);
void modulator_tick(Assembler& m);
void start_up(Assembler& m);
void actuator_loops(Assembler& m);
void cic_sample(Assembler& m);
void cic_tick(Assembler& m);
void image_filter(Assembler& m);
void phase_detector(Assembler& m);
void reference_phase_loop(Assembler& m);
void frequency_tracker_tick(Assembler& m);
void frequency_tracker_output(Assembler& m);
void rate_filter_tick(Assembler& m);
void rate_filter_output(Assembler& m);
void thermometer(Assembler& m);
void derivative_sum(Assembler& m);
void derivative_block(Assembler& m);
void derivative_state(Assembler& m);
void bias_model(Assembler& m);
void parity(Assembler& m);
void status(Assembler& m);
void record(Assembler& m);

/// The whole program: regions in the order of their addresses.
void write_program(Assembler& m);

}  // namespace hemi::microcode

#endif  // HEMI_RTL_MICROCODE_BLOCKS_HPP
