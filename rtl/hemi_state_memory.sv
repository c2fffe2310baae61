// SPDX-License-Identifier: Apache-2.0

/// 256 words of 54 bits, two read ports and one write port: two copies of block RAM on most devices. The
/// schedule never reads a word in the clock of its write, so no order of the two has to be kept.
/// Area on the iCE40 UP5K (docs/fpga.md): 1 LUT4, 8 block RAMs; 122 MHz between registers.
module hemi_state_memory (
    input  logic                   clk_i,        // clock
    input  logic [hemi_pkg::AddressBits-1:0] a_address_i,  // first operand
    input  logic [hemi_pkg::AddressBits-1:0] b_address_i,  // second operand
    output logic [   hemi_pkg::WordBits-1:0] a_o,          // a clock later
    output logic [   hemi_pkg::WordBits-1:0] b_o,          // a clock later
    input  logic                   write_i,      // write at this edge
    input  logic [hemi_pkg::AddressBits-1:0] address_i,    // of the word to be written
    input  logic [   hemi_pkg::WordBits-1:0] data_i        // the word
);
  (* no_rw_check *)
  logic [hemi_pkg::WordBits-1:0] memory_q[hemi_pkg::StateWords];

  always_ff @(posedge clk_i) begin
    a_o <= memory_q[a_address_i];
    b_o <= memory_q[b_address_i];
    if (write_i) memory_q[address_i] <= data_i;
  end
endmodule
