// SPDX-License-Identifier: Apache-2.0

/// hemi_axi_dac loses, repeats and changes nothing: one word, chosen freely, comes out in its turn and as it went in.
/// Assumed: a sample is only taken where there is room, and has one push of words, later; words change with a push alone.
module hemi_axi_dac_proof (
    input logic                                   clk_i,
    input logic                                   rst_ni,
    input logic                                   sample_i,
    input logic                                   push_i,
    input logic [4*hemi_axi_pkg::DacLaneBits-1:0] words_i,
    input logic                                   tready_i,
    input logic                                   choose_i   // this push is the one to follow
);
  logic room, tvalid;
  logic [4*hemi_axi_pkg::DacLaneBits-1:0] tdata;

  hemi_axi_dac i_dac (
      .clk_i,
      .rst_ni,
      .sample_i,
      .room_o  (room),
      .push_i,
      .words_i,
      .tvalid_o(tvalid),
      .tready_i,
      .tdata_o (tdata)
  );

  // Registers of the device under test; the script that runs the proof connects them.
  logic second_valid;
  logic [1:0] outstanding;

  logic started_q = 1'b0, held_q = 1'b0, reset_q = 1'b1, chosen_q = 1'b0;
  logic [4*hemi_axi_pkg::DacLaneBits-1:0] tdata_q, chosen_word_q, words_q;
  logic [1:0] in_core_q = '0, stored_q = '0, ahead_q = '0;
  logic pop;
  assign pop = tvalid & tready_i;

  always @(posedge clk_i) begin
    started_q <= 1'b1;
    reset_q   <= ~rst_ni;
    held_q    <= rst_ni & tvalid & ~tready_i;
    tdata_q   <= tdata;
    words_q   <= words_i;
    if (!rst_ni) begin
      in_core_q <= '0;
      stored_q  <= '0;
      chosen_q  <= 1'b0;
    end else begin
      in_core_q <= in_core_q + 2'(sample_i) - 2'(push_i);
      stored_q  <= stored_q + 2'(push_i) - 2'(pop);
      if (push_i & choose_i & ~chosen_q) begin
        chosen_q      <= 1'b1;
        chosen_word_q <= words_i;
        ahead_q       <= stored_q - 2'(pop);
      end else if (chosen_q & pop) begin
        if (ahead_q == '0) chosen_q <= 1'b0;
        else ahead_q <= ahead_q - 1'b1;
      end
    end
  end

  always @(posedge clk_i) begin
    if (!started_q) assume (!rst_ni);
    assume (!sample_i | room);
    assume (!push_i | in_core_q != '0);
    assume (push_i | !started_q | words_i == words_q);
    if (started_q & reset_q) begin
      quiet : assert (!tvalid);
    end
    if (started_q & held_q) begin
      words_stand : assert (tvalid & tdata == tdata_q);
    end
    if (started_q) begin
      counted : assert (stored_q == 2'(tvalid) + 2'(second_valid));
      filled_in_order : assert (tvalid | ~second_valid);
      two_at_most : assert (outstanding == in_core_q + stored_q & outstanding != 3 & in_core_q != 3);
      sum_fits : assert (!(in_core_q[1] & stored_q != '0) & !(stored_q[1] & in_core_q != '0));
      in_turn : assert (!chosen_q | ahead_q < stored_q);
      unchanged : assert (!chosen_q | chosen_word_q == (ahead_q == '0 ? tdata : words_q));
    end
  end
endmodule
