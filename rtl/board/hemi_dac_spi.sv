// SPDX-License-Identifier: Apache-2.0

/// Writes three 16-bit converters (AD5542A and its kind, offset binary, read at rising edges of SCK) side by side on
/// common CS, SCK and LDAC. LDAC falls with the clock after count 0, the clock at which the ADCs sample, and puts in force
/// what was sent in the period before; then the words that stand at the inputs at count 0 are sent, and wait.
/// Area on the iCE40 UP5K (docs/fpga.md): 61 LUT4, 52 flip-flops; 64 MHz between registers.
module hemi_dac_spi (
    input  logic                         clk_i,         // clock
    input  logic                         rst_ni,        // synchronous reset, active low
    input  logic [                  7:0] count_i,       // clocks since the period's start
    input  logic [hemi_pkg::DacBits-1:0] drive_i,       // signed, looked at when count_i is 0
    input  logic [hemi_pkg::DacBits-1:0] rebalance_i,
    input  logic [hemi_pkg::DacBits-1:0] quadrature_i,
    output logic                         ldac_no,       // converters
    output logic                         cs_no,
    output logic                         sck_o,
    output logic                         drive_o,
    output logic                         rebalance_o,
    output logic                         quadrature_o
);
  localparam logic [7:0] Select = 8'd4;  // LDAC is over
  localparam logic [7:0] FirstBit = Select + 8'd2;  // even
  localparam logic [7:0] End = FirstBit + 8'd32;

  logic sending_q;
  logic [15:0] drive_q, rebalance_q, quadrature_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      ldac_no      <= 1'b1;
      cs_no        <= 1'b1;
      sck_o        <= 1'b0;
      sending_q    <= 1'b0;
      drive_q      <= '0;
      rebalance_q  <= '0;
      quadrature_q <= '0;
    end else begin
      ldac_no <= |count_i[7:1];
      if (count_i == Select) cs_no <= 1'b0;
      else if (count_i == End) cs_no <= 1'b1;
      if (count_i == FirstBit - 8'd1) sending_q <= 1'b1;
      else if (count_i == End - 8'd1) sending_q <= 1'b0;
      sck_o <= sending_q & ~count_i[0];
      if (count_i == 8'd0) begin
        drive_q      <= {~drive_i[15], drive_i[14:0]};
        rebalance_q  <= {~rebalance_i[15], rebalance_i[14:0]};
        quadrature_q <= {~quadrature_i[15], quadrature_i[14:0]};
      end else if (sending_q & count_i[0]) begin
        drive_q      <= {drive_q[14:0], 1'b0};
        rebalance_q  <= {rebalance_q[14:0], 1'b0};
        quadrature_q <= {quadrature_q[14:0], 1'b0};
      end
    end
  end

  assign drive_o      = drive_q[15];
  assign rebalance_o  = rebalance_q[15];
  assign quadrature_o = quadrature_q[15];
endmodule
