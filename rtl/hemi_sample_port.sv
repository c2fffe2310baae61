// SPDX-License-Identifier: Apache-2.0

/// Holds one sample from its arrival until the program has read it.
/// Area on the iCE40 UP5K (docs/fpga.md): 26 LUT4, 35 flip-flops; 72 MHz between registers.
module hemi_sample_port (
    input  logic               clk_i,        // clock
    input  logic               rst_ni,       // synchronous reset, active low
    input  logic               valid_i,      // a sample is offered
    output logic               ready_o,      // and taken when both are high
    input  logic [hemi_pkg::AdcBits-1:0] x_i,          // primary pickoff, signed
    input  logic [hemi_pkg::AdcBits-1:0] y_i,          // secondary pickoff, signed
    input  logic               gap_i,        // samples were lost before this one; telemetry: invalid
    input  logic               telemetry_i,  // a telemetry sample: its words are in the registers
    input  logic               take_i,       // the program has read it
    output logic               waiting_o,    // a sample is held
    output logic [hemi_pkg::AdcBits-1:0] x_o,          // it
    output logic [hemi_pkg::AdcBits-1:0] y_o,
    output logic               gap_o,
    output logic               telemetry_o,
    output logic               overload_o    // x or y stands at a rail
);
  localparam logic [hemi_pkg::AdcBits-1:0] Top = {1'b0, {(hemi_pkg::AdcBits - 1) {1'b1}}};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      waiting_o   <= 1'b0;
      x_o         <= '0;
      y_o         <= '0;
      gap_o       <= 1'b0;
      telemetry_o <= 1'b0;
    end else if (valid_i & ready_o) begin
      waiting_o   <= 1'b1;
      x_o         <= x_i;
      y_o         <= y_i;
      gap_o       <= gap_i;
      telemetry_o <= telemetry_i;
    end else if (take_i) begin
      waiting_o <= 1'b0;
    end
  end

  assign ready_o    = ~waiting_o;
  assign overload_o = x_o == Top | x_o == ~Top | y_o == Top | y_o == ~Top;
endmodule
