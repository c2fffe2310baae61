// SPDX-License-Identifier: Apache-2.0

/// Requests from the serial line: header, command, address, seven data bytes (low first), CRC. What does not begin with
/// the header is passed over; a frame that pauses for 65536 clocks is forgotten. While busy_i the request stands and
/// bytes are lost.
/// Area on the iCE40 UP5K (docs/fpga.md): 66 LUT4, 111 flip-flops; 58 MHz between registers.
module hemi_link_receiver (
    input  logic        clk_i,      // clock
    input  logic        rst_ni,     // synchronous reset, active low
    input  logic        rx_i,       // line
    input  logic        busy_i,     // the last request is not answered yet
    output logic        valid_o,    // for one clock: a whole request with a good CRC
    output logic        bad_o,      // for one clock: its CRC was wrong
    output logic        lost_o,     // for one clock: a byte came while busy
    output logic [ 7:0] command_o,  // the request
    output logic [ 7:0] address_o,
    output logic [55:0] data_o
);
  localparam int Bytes = hemi_board_pkg::WordBytes + 5;
  localparam logic [3:0] LastByte = 4'(Bytes - 1);
  localparam logic [15:0] GoodCrc = 16'hf0b8;

  logic byte_valid, here;
  logic [7:0] byte_here;
  logic [3:0] index_q;
  logic [15:0] pause_q, crc_q, crc;
  logic [71:0] bytes_q;  // the newest above: {data, address, command}
  logic last;

  hemi_uart_rx i_uart_rx (
      .clk_i,
      .rst_ni,
      .rx_i,
      .valid_o(byte_valid),
      .byte_o (byte_here)
  );

  hemi_crc16 i_crc16 (
      .crc_i (index_q == '0 ? 16'hffff : crc_q),
      .byte_i(byte_here),
      .crc_o (crc)
  );

  assign here = byte_valid & ~busy_i;
  assign last = here & index_q == LastByte;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      index_q <= '0;
      pause_q <= '0;
      crc_q   <= '0;
      bytes_q <= '0;
      valid_o <= 1'b0;
      bad_o   <= 1'b0;
      lost_o  <= 1'b0;
    end else begin
      lost_o  <= byte_valid & busy_i;
      valid_o <= last & crc == GoodCrc;
      bad_o   <= last & crc != GoodCrc;
      pause_q <= byte_valid ? '0 : pause_q + 1'b1;
      if (here) begin
        crc_q <= crc;
        if (index_q != '0 & index_q < LastByte - 4'd1) bytes_q <= {byte_here, bytes_q[71:8]};
        if (index_q != '0 | byte_here == hemi_board_pkg::RequestHeader) index_q <= last ? '0 : index_q + 1'b1;
      end else if (pause_q == '1) begin
        index_q <= '0;
      end
    end
  end

  assign {data_o, address_o, command_o} = bytes_q;
endmodule
