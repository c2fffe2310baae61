// SPDX-License-Identifier: Apache-2.0

/// An exact sum becomes a word: clipped to its width, or its low bits with the sign drawn out.
module hemi_quantiser (
    input  logic [        56:0] sum_i,      // exact, signed
    input  logic [hemi_pkg::ModeBits-1:0] mode_i,     // width and overflow, a field of the instruction
    output logic [hemi_pkg::WordBits-1:0] word_o,     // sign-extended
    output logic                saturate_o, // the mode clips
    output logic                clipped_o   // and did
);
  logic [hemi_pkg::WordBits-1:0] keep, sign_place;
  logic outside, sign;

  hemi_modes i_modes (
      .mode_i,
      .keep_o    (keep),
      .saturate_o
  );

  assign sign_place = {keep[hemi_pkg::WordBits-2:0], 1'b1} & ~keep;
  assign outside    = |((sum_i[55:0] ^ {56{sum_i[56]}}) & {2'b11, ~keep});
  assign clipped_o  = outside & saturate_o;
  assign sign       = saturate_o ? sum_i[56] : |(sum_i[hemi_pkg::WordBits-1:0] & sign_place);
  assign word_o     = clipped_o ? keep ^ {hemi_pkg::WordBits{sign}}
                                : (sum_i[hemi_pkg::WordBits-1:0] & keep) | (~keep & {hemi_pkg::WordBits{sign}});
endmodule
