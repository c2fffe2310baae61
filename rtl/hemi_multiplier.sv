// SPDX-License-Identifier: Apache-2.0

/// Signed product of 32 and 24 bits, a new one each clock, two clocks later. Split so that each of the four
/// partial products fits a signed 16 by 16 bit multiplier: a = a1 2^15 + a0 + c 2^31 with a1 the bits 30..15 as a
/// signed number, a0 the 15 bits below, and c = a[30] - a[31], which mends the sign; b = b1 2^15 + b0.
///
/// Each partial product has exactly the bits that its factors need: Yosys 0.23 leaves the upper bits of a wider
/// register undriven when it packs it into a multiplier block.
/// Area on the iCE40 UP5K (docs/fpga.md): 181 LUT4, 81 flip-flops, 4 multipliers; 40 MHz between registers.
module hemi_multiplier (
    input  logic        clk_i,     // clock
    input  logic [31:0] a_i,       // wide factor, signed
    input  logic [23:0] b_i,       // narrow factor, signed
    output logic [55:0] product_o  // exact; two clocks behind the factors
);
  logic [14:0] a0, b0;
  logic signed [15:0] a0_signed, a1, b0_signed;
  logic signed [8:0] b1;
  logic [29:0] low_q;
  logic signed [31:0] middle_a_q;
  logic signed [24:0] middle_b_q, high_q;
  logic signed [24:0] b, mend_d, mend_q;
  logic [1:0] top;
  logic [55:0] low, middle, high, product_d;

  assign a0        = a_i[14:0];
  assign b0        = b_i[14:0];
  assign a0_signed = {1'b0, a0};
  assign b0_signed = {1'b0, b0};
  assign a1        = a_i[30:15];
  assign b1        = b_i[23:15];
  assign b         = {b_i[23], b_i};
  assign top       = a_i[31:30];

  always_comb begin
    unique case (top)
      2'b01:   mend_d = b;
      2'b10:   mend_d = -b;
      default: mend_d = '0;
    endcase
  end

  always_ff @(posedge clk_i) begin
    low_q      <= {15'b0, a0} * {15'b0, b0};
    middle_a_q <= a1 * b0_signed;
    middle_b_q <= a0_signed * b1;
    high_q     <= a1 * b1;
    mend_q     <= mend_d;
  end

  assign low       = {26'b0, low_q};
  assign middle    = {{24{middle_a_q[31]}}, middle_a_q} + {{31{middle_b_q[24]}}, middle_b_q};
  assign high      = {{31{high_q[24]}}, high_q} + {{30{mend_q[24]}}, mend_q, 1'b0};
  assign product_d = low + (middle << 15) + (high << 30);

  always_ff @(posedge clk_i) product_o <= product_d;
endmodule
