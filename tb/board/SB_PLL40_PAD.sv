// SPDX-License-Identifier: Apache-2.0

/// The iCE40's PLL as a bench sees it: the bench clocks PACKAGEPIN at the PLL's output frequency; locked after 16 clocks.
module SB_PLL40_PAD #(
    parameter FEEDBACK_PATH = "SIMPLE",
    parameter logic [3:0] DIVR = 0,
    parameter logic [6:0] DIVF = 0,
    parameter logic [2:0] DIVQ = 0,
    parameter logic [2:0] FILTER_RANGE = 0
) (
    input  logic PACKAGEPIN,
    output logic PLLOUTGLOBAL,
    output logic LOCK,
    input  logic RESETB,
    input  logic BYPASS
);
  logic [3:0] count_q = '0;
  logic unused;

  assign unused       = &{1'b0, BYPASS, DIVR, DIVF, DIVQ, FILTER_RANGE, FEEDBACK_PATH == ""};
  assign PLLOUTGLOBAL = PACKAGEPIN;

  always_ff @(posedge PACKAGEPIN) begin
    if (!RESETB) count_q <= '0;
    else if (!LOCK) count_q <= count_q + 1'b1;
  end
  assign LOCK = count_q == '1;
endmodule
