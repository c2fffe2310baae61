// SPDX-License-Identifier: Apache-2.0

/// The DAC words of a sample, as the program writes them: quadrature once a tick, drive and, last, rebalance, which
/// completes the sample's words.
/// Area on the iCE40 UP5K (docs/fpga.md): 8 LUT4, 81 flip-flops; 63 MHz between registers.
module hemi_dac_port (
    input  logic                   clk_i,        // clock
    input  logic                   rst_ni,       // synchronous reset, active low
    input  logic                   write_i,      // a result goes to the state memory
    input  logic [hemi_pkg::AddressBits-1:0] address_i,    // where
    input  logic [    hemi_pkg::DacBits-1:0] word_i,       // its low bits
    output logic                   valid_o,      // for one clock: the words below are new
    output logic [    hemi_pkg::DacBits-1:0] drive_o,
    output logic [    hemi_pkg::DacBits-1:0] rebalance_o,
    output logic [    hemi_pkg::DacBits-1:0] quadrature_o
);
  logic [hemi_pkg::DacBits-1:0] drive_q, quadrature_q;
  logic complete;

  assign complete = write_i & (address_i == hemi_pkg::DacRebalancePort);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      valid_o      <= 1'b0;
      drive_o      <= '0;
      rebalance_o  <= '0;
      quadrature_o <= '0;
      quadrature_q <= '0;
    end else begin
      valid_o <= complete;
      if (complete) begin
        drive_o      <= drive_q;
        rebalance_o  <= word_i;
        quadrature_o <= quadrature_q;
      end
      if (write_i & (address_i == hemi_pkg::DacQuadraturePort)) quadrature_q <= word_i;
    end
    if (write_i & (address_i == hemi_pkg::DacDrivePort)) drive_q <= word_i;
  end
endmodule
