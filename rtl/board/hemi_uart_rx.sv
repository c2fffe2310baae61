// SPDX-License-Identifier: Apache-2.0

/// Receives bytes, eight bits, no parity, one stop bit; a bit is read in its middle, after two synchronising flip-flops.
/// A byte whose stop bit is low is dropped.
/// Area on the iCE40 UP5K (docs/fpga.md): 25 LUT4, 20 flip-flops; 74 MHz between registers.
module hemi_uart_rx (
    input  logic       clk_i,    // clock
    input  logic       rst_ni,   // synchronous reset, active low
    input  logic       rx_i,     // line, rests high; any clock
    output logic       valid_o,  // for one clock: a byte
    output logic [7:0] byte_o
);
  localparam int CountBits = $clog2(hemi_board_pkg::BaudClocks);
  localparam logic [CountBits-1:0] LastClock = CountBits'(hemi_board_pkg::BaudClocks - 1);
  // The synchroniser is two clocks late; the start bit's middle counts from there.
  localparam logic [CountBits-1:0] StartClock = CountBits'(hemi_board_pkg::BaudClocks / 2 + 2);

  logic rx_meta_q, rx_q;
  logic [CountBits-1:0] clock_q;
  logic [3:0] left_q;  // bits, start and stop bit included

  always_ff @(posedge clk_i) begin
    rx_meta_q <= rx_i;
    rx_q      <= rx_meta_q;
    if (!rst_ni) begin
      clock_q <= '0;
      left_q  <= '0;
      valid_o <= 1'b0;
      byte_o  <= '0;
    end else begin
      valid_o <= 1'b0;
      if (left_q == '0) begin
        clock_q <= StartClock;
        if (!rx_q) left_q <= 4'd10;
      end else if (clock_q != LastClock) begin
        clock_q <= clock_q + 1'b1;
      end else begin
        clock_q <= '0;
        left_q  <= left_q == 4'd10 & rx_q ? '0 : left_q - 1'b1;  // a spike is no start bit
        if (left_q == 4'd1) valid_o <= rx_q;
        else byte_o <= {rx_q, byte_o[7:1]};
      end
    end
  end
endmodule
