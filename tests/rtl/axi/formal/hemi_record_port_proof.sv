// SPDX-License-Identifier: Apache-2.0

/// hemi_record_port as the source of an AXI4-Stream: what it offers stands until it is taken, tlast is at every
/// RecordWords-th beat. Assumed: a word begins only where the port is free, and comes once.
module hemi_record_port_proof (
    input logic                          clk_i,
    input logic                          rst_ni,
    input logic                          start_i,
    input logic                          emit_i,
    input logic [hemi_pkg::WordBits-1:0] word_i,
    input logic                          ready_i
);
  logic free, valid, last;
  logic [hemi_pkg::WordBits-1:0] word;
  logic [3:0] index;

  hemi_record_port i_port (
      .clk_i,
      .rst_ni,
      .start_i,
      .emit_i,
      .word_i,
      .free_o (free),
      .valid_o(valid),
      .ready_i,
      .word_o (word),
      .index_o(index),
      .last_o (last)
  );

  logic started_q = 1'b0, held_q = 1'b0, reset_q = 1'b1, coming_q = 1'b0, last_q;
  logic [hemi_pkg::WordBits-1:0] word_q;
  logic [3:0] index_q, beats_q = '0;

  always @(posedge clk_i) begin
    started_q <= 1'b1;
    reset_q   <= ~rst_ni;
    held_q    <= rst_ni & valid & ~ready_i;
    word_q    <= word;
    index_q   <= index;
    last_q    <= last;
    coming_q  <= rst_ni & (start_i | (coming_q & ~emit_i));
    if (!rst_ni) beats_q <= '0;
    else if (valid & ready_i) beats_q <= beats_q == hemi_pkg::RecordWords - 1 ? '0 : beats_q + 1'b1;
  end

  always @(posedge clk_i) begin
    if (!started_q) assume (!rst_ni);
    assume (!start_i | free);
    assume (!emit_i | coming_q);
    if (started_q & reset_q) begin
      quiet : assert (!valid);
    end
    if (started_q & held_q) begin
      word_stands : assert (valid & word == word_q & index == index_q & last == last_q);
    end
    if (started_q) begin
      in_order : assert (index == beats_q & index < hemi_pkg::RecordWords);
      last_is_last : assert (last == (beats_q == hemi_pkg::RecordWords - 1));
      one_word : assert (free == !(coming_q | valid) & !(coming_q & valid));
    end
  end
endmodule
