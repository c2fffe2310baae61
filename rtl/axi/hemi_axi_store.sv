// SPDX-License-Identifier: Apache-2.0

/// Copy of what the core does not give back: the registers as written and the last whole record. One write port, one
/// read port, the word read stands one clock after its address; block RAM. Cleared after reset, a word a clock.
/// Area on the iCE40 UP5K (docs/fpga.md): 80 LUT4, 125 flip-flops, 4 block RAMs; 86 MHz between registers.
module hemi_axi_store #(
    parameter int AddressBits = 7  // of its words
) (
    input  logic                          clk_i,            // clock
    input  logic                          rst_ni,           // synchronous reset, active low
    output logic                          clearing_o,       // no reading, and no writing, yet
    input  logic                          write_i,
    input  logic [       AddressBits-1:0] write_address_i,
    input  logic [hemi_pkg::WordBits-1:0] write_data_i,
    input  logic [       AddressBits-1:0] read_address_i,
    output logic [hemi_pkg::WordBits-1:0] read_data_o
);
  logic [hemi_pkg::WordBits-1:0] words[2**AddressBits];
  logic clearing_q;
  logic [AddressBits-1:0] clear_address_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      clearing_q      <= 1'b1;
      clear_address_q <= '0;
    end else if (clearing_q) begin
      clearing_q      <= clear_address_q != '1;
      clear_address_q <= clear_address_q + 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (clearing_q | write_i)
      words[clearing_q ? clear_address_q : write_address_i] <= clearing_q ? '0 : write_data_i;
    read_data_o <= words[read_address_i];
  end

  assign clearing_o = clearing_q;
endmodule
