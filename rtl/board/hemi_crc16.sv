// SPDX-License-Identifier: Apache-2.0

/// CRC-16 of the link, a byte further: x^16 + x^12 + x^5 + 1, bits in the order of the line (lowest first), starting
/// from ones, sent inverted and low byte first (ITU-T X.25). Over a whole good frame it leaves f0b8. Combinational.
/// Area on the iCE40 UP5K (docs/fpga.md): 17 LUT4; 136 MHz between registers.
module hemi_crc16 (
    input  logic [15:0] crc_i,   // so far
    input  logic [ 7:0] byte_i,
    output logic [15:0] crc_o    // with this byte
);
  logic [7:0] low, folded;

  assign low    = crc_i[7:0] ^ byte_i;
  assign folded = low ^ {low[3:0], 4'b0};
  assign crc_o  = {8'b0, crc_i[15:8]} ^ {folded, 8'b0} ^ {5'b0, folded, 3'b0} ^ {12'b0, folded[7:4]};
endmodule
