// SPDX-License-Identifier: Apache-2.0

/// Reads two 16-bit converters that convert at the rising edge of CNV (AD7688 and its kind, two's complement, three-wire
/// mode without busy bit) side by side on common CNV and SCK: CNV high for the conversion, then the highest bit stands on
/// SDO and each falling edge of SCK, at half the clock, brings the next. Bits are taken at the clock that lets SCK fall.
///
/// CNV rises with the clock after count 0. A sample is there ConversionClocks + 35 clocks later.
/// Area on the iCE40 UP5K (docs/fpga.md): 15 LUT4, 36 flip-flops; 74 MHz between registers.
module hemi_adc_spi (
    input  logic        clk_i,     // clock
    input  logic        rst_ni,    // synchronous reset, active low
    input  logic        active_i,  // convert in this period
    input  logic [ 7:0] count_i,   // clocks since the period's start
    output logic        cnv_o,     // converters
    output logic        sck_o,
    input  logic        sdo_x_i,
    input  logic        sdo_y_i,
    output logic        valid_o,   // for one clock: the words are there, until the next reading
    output logic [15:0] x_o,       // signed
    output logic [15:0] y_o
);
  localparam logic [7:0] FirstRead = 8'(hemi_board_pkg::ConversionClocks + 2);  // even, as ConversionClocks
  localparam logic [7:0] ReadEnd = FirstRead + 8'd32;

  logic reading_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      cnv_o     <= 1'b0;
      sck_o     <= 1'b0;
      reading_q <= 1'b0;
      valid_o   <= 1'b0;
      x_o       <= '0;
      y_o       <= '0;
    end else begin
      if (count_i == 8'd0) cnv_o <= active_i;
      else if (count_i == 8'(hemi_board_pkg::ConversionClocks)) cnv_o <= 1'b0;
      if (count_i == FirstRead - 8'd1) reading_q <= active_i;
      else if (count_i == ReadEnd - 8'd1) reading_q <= 1'b0;
      sck_o   <= reading_q & ~count_i[0];
      valid_o <= reading_q & count_i == ReadEnd - 8'd1;
      if (reading_q & count_i[0]) begin
        x_o <= {x_o[14:0], sdo_x_i};
        y_o <= {y_o[14:0], sdo_y_i};
      end
    end
  end
endmodule
