// SPDX-License-Identifier: Apache-2.0

/// Logic that names registers by hemi_registers_pkg: asks the core to write one of two.
module registers_user (
    input  logic        second_i,
    output logic [ 7:0] address_o,
    output logic [ 7:0] fraction_o,
    output logic [63:0] mask_o
);
  assign address_o  = second_i ? 8'(hemi_registers_pkg::RegParity) : 8'(hemi_registers_pkg::RegControl);
  assign fraction_o = 8'(hemi_registers_pkg::RecordFrequencyFraction);
  assign mask_o     = 64'd1 << (hemi_registers_pkg::StatusFrequencyInvalid + hemi_registers_pkg::StatusStickyShift);
endmodule
