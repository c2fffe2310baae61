// SPDX-License-Identifier: Apache-2.0

/// The reference design on an iCE40 UP5K with a 12 MHz crystal (icebreaker.pcf): 24 MHz from the PLL, a reset that ends
/// when the PLL is locked and the button is up, hemi_board, two lamps.
/// The whole, core included (docs/board.md): 2542 logic cells, 29 block RAMs, 5 multipliers; 27.8 MHz in the worst of five seeds.
/// Area on the iCE40 UP5K (docs/fpga.md): 3 LUT4, 2 flip-flops.
module hemi_board_up5k (
    input  logic crystal_i,         // 12 MHz
    input  logic button_ni,         // reset while it is down
    output logic adc_cnv_o,         // hemi_board
    output logic adc_sck_o,
    input  logic adc_sdo_x_i,
    input  logic adc_sdo_y_i,
    output logic dac_ldac_no,
    output logic dac_cs_no,
    output logic dac_sck_o,
    output logic dac_drive_o,
    output logic dac_rebalance_o,
    output logic dac_quadrature_o,
    input  logic rx_i,
    output logic tx_o,
    output logic active_no,         // green lamp: sampling
    output logic fault_no           // red lamp
);
  logic clk, locked, active, fault;
  logic [1:0] reset_nq;

  // 12 MHz * 64 / 2^5
  SB_PLL40_PAD #(
      .FEEDBACK_PATH("SIMPLE"),
      .DIVR         (4'd0),
      .DIVF         (7'd63),
      .DIVQ         (3'd5),
      .FILTER_RANGE (3'd1)
  ) i_pll (
      .PACKAGEPIN   (crystal_i),
      .PLLOUTGLOBAL (clk),
      .LOCK         (locked),
      .RESETB       (1'b1),
      .BYPASS       (1'b0)
  );

  always_ff @(posedge clk) reset_nq <= {reset_nq[0], locked & button_ni};

  hemi_board i_board (
      .clk_i   (clk),
      .rst_ni  (reset_nq[1]),
      .adc_cnv_o,
      .adc_sck_o,
      .adc_sdo_x_i,
      .adc_sdo_y_i,
      .dac_ldac_no,
      .dac_cs_no,
      .dac_sck_o,
      .dac_drive_o,
      .dac_rebalance_o,
      .dac_quadrature_o,
      .rx_i,
      .tx_o,
      .active_o(active),
      .fault_o (fault)
  );

  assign active_no = ~active;
  assign fault_no  = ~fault;
endmodule
