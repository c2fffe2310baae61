// SPDX-License-Identifier: Apache-2.0

/// An exact sum becomes a word: clipped to its width, or its low bits with the sign drawn out; a residual is 0 when the
/// sum before it was clipped.
/// Area on the iCE40 UP5K (docs/fpga.md): 219 LUT4, 1 flip-flop; 43 MHz between registers.
module hemi_quantiser (
    input  logic                clk_i,      // clock
    input  logic [        56:0] sum_i,      // exact, signed
    input  logic [hemi_pkg::ModeBits-1:0] mode_i,     // width and overflow, a field of the instruction
    output logic [hemi_pkg::WordBits-1:0] word_o,     // sign-extended
    output logic                saturate_o, // the mode clips
    output logic                clipped_o   // and did
);
  logic [hemi_pkg::WordBits-1:0] keep, kept, sign_place;
  logic outside, sign, residual, cleared, clipped_q;

  hemi_modes i_modes (
      .mode_i,
      .keep_o    (keep),
      .saturate_o,
      .residual_o(residual)
  );

  always_ff @(posedge clk_i) clipped_q <= clipped_o;

  // A residual has as many bits as a DAC word drops, at most.
  localparam int ResidualBits = hemi_pkg::ResidualBits;
  assign cleared    = residual & clipped_q;
  assign kept       = keep & {{(hemi_pkg::WordBits - ResidualBits) {1'b1}}, {ResidualBits{~cleared}}};

  assign sign_place = {keep[hemi_pkg::WordBits-2:0], 1'b1} & ~keep;
  assign outside    = |((sum_i[55:0] ^ {56{sum_i[56]}}) & {2'b11, ~keep});
  assign clipped_o  = outside & saturate_o;
  assign sign       = saturate_o ? sum_i[56] : |(sum_i[hemi_pkg::WordBits-1:0] & sign_place) & ~cleared;
  assign word_o     = clipped_o ? kept ^ {hemi_pkg::WordBits{sign}}
                                : (sum_i[hemi_pkg::WordBits-1:0] & kept) | (~kept & {hemi_pkg::WordBits{sign}});
endmodule
