// SPDX-License-Identifier: Apache-2.0

/// Sine or cosine of a phase from a quarter wave of 512 lines, interpolated: magnitude and sign. The angle is half a
/// unit behind its 22 bits, which makes the complement the exact mirror image. Spurs -117 dBc (20 bits).
/// Area on the iCE40 UP5K (docs/fpga.md): 42 LUT4, 47 flip-flops, 1 multiplier; 71 MHz between registers.
module hemi_nco_table (
    input  logic        clk_i,        // clock
    input  logic [23:0] angle_i,      // turns, 24 bits below the binary point
    input  logic        cosine_i,     // cosine instead of sine
    output logic [18:0] magnitude_o,  // s0.19; behind two clocks
    output logic        negative_o    // its sign; with it
);
  logic [                      1:0] quadrant;
  logic [       hemi_pkg::TableIndexBits-1:0] index;
  logic [        hemi_pkg::TableFineBits-1:0] fine_q;
  logic                             mirror;
  logic                             negative_q, negative_qq;
  logic [                     31:0] line;
  logic [        hemi_pkg::TableBaseBits-1:0] base_q;
  logic [hemi_pkg::TableDeltaBits-1:0] step, step_q;
  logic [hemi_pkg::TableDeltaBits+hemi_pkg::TableFineBits:0] delta, fraction;
  logic [hemi_pkg::TableFineBits:0] unused_fraction;
  logic [hemi_pkg::TableBaseBits-1:0] sum;
  logic unused_half;

  assign quadrant = angle_i[23:22];
  assign mirror   = quadrant[0] ^ cosine_i;
  assign index    = angle_i[21:hemi_pkg::TableFineBits] ^ {hemi_pkg::TableIndexBits{mirror}};

  hemi_sine_rom i_rom (
      .clk_i,
      .address_i(index),
      .line_o   (line)
  );

  assign delta = {{(hemi_pkg::TableFineBits + 1) {1'b0}}, line[31:hemi_pkg::TableBaseBits]};
  assign fraction = {{hemi_pkg::TableDeltaBits{1'b0}}, fine_q, 1'b1};
  assign {step, unused_fraction} = delta * fraction;

  always_ff @(posedge clk_i) begin
    fine_q      <= angle_i[hemi_pkg::TableFineBits-1:0] ^ {hemi_pkg::TableFineBits{mirror}};
    negative_q  <= quadrant[1] ^ (cosine_i & quadrant[0]);
    step_q      <= step;
    base_q      <= line[hemi_pkg::TableBaseBits-1:0];
    negative_qq <= negative_q;
  end

  // floor((base 2^14 + delta (2 fine + 1) + 2^14) / 2^15): the product's low bits carry nowhere, the sum is below 2^20.
  assign sum = base_q + {{(hemi_pkg::TableBaseBits - hemi_pkg::TableDeltaBits) {1'b0}}, step_q} + 1'b1;
  assign {magnitude_o, unused_half} = sum;
  assign negative_o = negative_qq;
endmodule
