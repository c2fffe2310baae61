// SPDX-License-Identifier: Apache-2.0

/// Holds one word of a record until it is taken; the background waits for it at its next word.
/// Area on the iCE40 UP5K (docs/fpga.md): 11 LUT4, 60 flip-flops; 93 MHz between registers.
module hemi_record_port (
    input  logic                clk_i,    // clock
    input  logic                rst_ni,   // synchronous reset, active low
    input  logic                start_i,  // an instruction that makes a word begins
    input  logic                emit_i,   // its word is there
    input  logic [hemi_pkg::WordBits-1:0] word_i,
    output logic                free_o,   // the next word may begin
    output logic                valid_o,  // a word is offered
    input  logic                ready_i,  // and taken when both are high
    output logic [hemi_pkg::WordBits-1:0] word_o,
    output logic [         3:0] index_o,  // its place in the record
    output logic                last_o    // it is the record's last
);
  logic busy_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      busy_q  <= 1'b0;
      valid_o <= 1'b0;
      word_o  <= '0;
      index_o <= '0;
    end else begin
      if (start_i) busy_q <= 1'b1;
      if (emit_i) begin
        valid_o <= 1'b1;
        word_o  <= word_i;
      end
      if (valid_o & ready_i) begin
        valid_o <= 1'b0;
        busy_q  <= 1'b0;
        index_o <= last_o ? '0 : index_o + 1'b1;
      end
    end
  end

  assign free_o = ~busy_q;
  assign last_o = index_o == 4'(hemi_pkg::RecordWords - 1);
endmodule
