// SPDX-License-Identifier: Apache-2.0

/// Sends bytes, eight bits, no parity, one stop bit; ready again when the stop bit is over.
/// Area on the iCE40 UP5K (docs/fpga.md): 23 LUT4, 18 flip-flops; 73 MHz between registers.
module hemi_uart_tx (
    input  logic       clk_i,    // clock
    input  logic       rst_ni,   // synchronous reset, active low
    input  logic       valid_i,  // a byte is offered
    output logic       ready_o,  // and taken when both are high
    input  logic [7:0] byte_i,
    output logic       tx_o      // line, rests high
);
  localparam int CountBits = $clog2(hemi_board_pkg::BaudClocks);
  localparam logic [CountBits-1:0] LastClock = CountBits'(hemi_board_pkg::BaudClocks - 1);

  logic [CountBits-1:0] clock_q;
  logic [8:0] shift_q;  // what follows the bit on the line
  logic [3:0] left_q;   // bits, the one on the line included

  assign ready_o = left_q == '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      clock_q <= '0;
      shift_q <= '1;
      left_q  <= '0;
      tx_o    <= 1'b1;
    end else if (ready_o) begin
      clock_q <= '0;
      if (valid_i) begin
        tx_o    <= 1'b0;
        shift_q <= {1'b1, byte_i};
        left_q  <= 4'd10;
      end
    end else if (clock_q == LastClock) begin
      clock_q <= '0;
      tx_o    <= shift_q[0];
      shift_q <= {1'b1, shift_q[8:1]};
      left_q  <= left_q - 1'b1;
    end else begin
      clock_q <= clock_q + 1'b1;
    end
  end
endmodule
