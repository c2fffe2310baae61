// SPDX-License-Identifier: Apache-2.0

/// Live status bits: raised by instructions and, once a tick, by the samples of that tick; cleared when read.
/// Area on the iCE40 UP5K (docs/fpga.md): 42 LUT4, 23 flip-flops; 100 MHz between registers.
module hemi_status (
    input  logic                  clk_i,       // clock
    input  logic                  rst_ni,      // synchronous reset, active low
    input  logic                  sample_i,    // a sample is taken
    input  logic                  overload_i,  // it stands at a rail
    input  logic                  gap_i,       // it follows a gap
    input  logic                  close_i,     // the tick's samples are complete
    input  logic                  raise_i,     // an instruction raises
    input  logic [hemi_pkg::EventBits-1:0]  event_i,     // this bit
    input  logic                  clear_i,     // live bits are being read
    output logic [hemi_pkg::StatusBits-1:0] live_o       // since the last output
);
  localparam logic [hemi_pkg::StatusBits-1:0] Overload = hemi_pkg::StatusBits'(1) << hemi_pkg::StatusOverload;
  localparam logic [hemi_pkg::StatusBits-1:0] Gap = hemi_pkg::StatusBits'(1) << hemi_pkg::StatusGap;
  localparam logic [hemi_pkg::StatusBits-1:0] One = hemi_pkg::StatusBits'(1);

  logic overload_q, gap_q;
  logic [hemi_pkg::StatusBits-1:0] raised, closed, live_q;

  // An instruction that names the overload, which only samples raise, raises nothing.
  assign raised = raise_i ? (One << event_i) & ~Overload : '0;
  assign closed = close_i ? (overload_q ? Overload : '0) | (gap_q ? Gap : '0) : '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      live_q     <= '0;
      overload_q <= 1'b0;
      gap_q      <= 1'b0;
    end else begin
      live_q     <= (clear_i ? '0 : live_q) | raised | closed;
      overload_q <= (overload_q & ~close_i) | (sample_i & overload_i);
      gap_q      <= (gap_q & ~close_i) | (sample_i & gap_i);
    end
  end

  assign live_o = live_q;
endmodule
