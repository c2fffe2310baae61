// SPDX-License-Identifier: Apache-2.0

/// Frames to the serial line: records, which go first, and responses. Header, a byte (sequence number or response code),
/// address of the first word, words of seven bytes (low first, sign-extended), CRC. A word is asked for by its address and
/// is to stand at the input from the second clock on until its seven bytes are sent.
/// Area on the iCE40 UP5K (docs/fpga.md): 170 LUT4, 44 flip-flops; 45 MHz between registers.
module hemi_link_sender (
    input  logic                          clk_i,              // clock
    input  logic                          rst_ni,             // synchronous reset, active low
    input  logic                          clear_i,            // forget records; a frame under way stays unfinished
    input  logic                          record_i,           // for one clock: a record is complete
    input  logic [                   7:0] record_number_i,    // its number
    input  logic                          response_i,         // a response is to be sent; until taken
    output logic                          response_taken_o,   // for one clock: it has been
    input  logic [                   7:0] response_code_i,
    input  logic [                   7:0] response_address_i,
    output logic                          fetch_record_o,     // the word below is one of the record
    output logic [                   3:0] fetch_index_o,      // which
    input  logic [hemi_pkg::WordBits-1:0] record_word_i,
    input  logic [hemi_pkg::WordBits-1:0] response_word_i,
    output logic                          tx_o                // line
);
  localparam logic [2:0] Idle = 3'd0;
  localparam logic [2:0] Header = 3'd1;
  localparam logic [2:0] Code = 3'd2;
  localparam logic [2:0] Address = 3'd3;
  localparam logic [2:0] Data = 3'd4;
  localparam logic [2:0] CrcLow = 3'd5;
  localparam logic [2:0] CrcHigh = 3'd6;

  localparam logic [3:0] LastWord = 4'(hemi_pkg::RecordWords - 1);
  localparam logic [2:0] LastByte = 3'(hemi_board_pkg::WordBytes - 1);
  localparam int Extension = 8 * hemi_board_pkg::WordBytes - hemi_pkg::WordBits;

  logic [2:0] state_q;
  logic pending_q, record_q, taken, ready, last_word;
  logic [3:0] word_q;
  logic [2:0] byte_q;
  logic [7:0] byte_here, data_byte, crc_low, crc_high, number_q, sent_number_q;
  logic [15:0] crc_q, crc;
  logic [hemi_pkg::WordBits-1:0] word;
  logic [8*hemi_board_pkg::WordBytes-1:0] extended;

  assign fetch_record_o   = record_q;
  assign fetch_index_o    = word_q;
  assign word             = record_q ? record_word_i : response_word_i;
  assign extended         = {{Extension{word[hemi_pkg::WordBits-1]}}, word};
  assign last_word        = ~record_q | word_q == LastWord;
  assign data_byte        = extended[8*byte_q+:8];
  assign crc_low          = ~crc_q[7:0];
  assign crc_high         = ~crc_q[15:8];
  assign taken            = state_q != Idle & ready;
  assign response_taken_o = taken & state_q == CrcHigh & ~record_q;

  always_comb begin
    unique case (state_q)
      Header:  byte_here = record_q ? hemi_board_pkg::RecordHeader : hemi_board_pkg::ResponseHeader;
      Code:    byte_here = record_q ? sent_number_q : response_code_i;
      Address: byte_here = record_q ? hemi_board_pkg::RecordBase : response_address_i;
      CrcLow:  byte_here = crc_low;
      CrcHigh: byte_here = crc_high;
      default: byte_here = data_byte;
    endcase
  end

  hemi_crc16 i_crc16 (
      .crc_i (crc_q),
      .byte_i(byte_here),
      .crc_o (crc)
  );

  hemi_uart_tx i_uart_tx (
      .clk_i,
      .rst_ni,
      .valid_i(state_q != Idle),
      .ready_o(ready),
      .byte_i (byte_here),
      .tx_o
  );

  always_ff @(posedge clk_i) begin
    if (!rst_ni | clear_i) begin
      state_q       <= Idle;
      pending_q     <= 1'b0;
      record_q      <= 1'b0;
      word_q        <= '0;
      byte_q        <= '0;
      number_q      <= '0;
      sent_number_q <= '0;
      crc_q         <= '0;
    end else begin
      if (record_i) begin
        pending_q <= 1'b1;
        number_q  <= record_number_i;
      end
      unique case (state_q)
        Idle: begin
          record_q      <= pending_q;
          sent_number_q <= number_q;
          word_q        <= '0;
          byte_q        <= '0;
          crc_q         <= '1;
          if (pending_q | response_i) state_q <= Header;
          if (pending_q & ~record_i) pending_q <= 1'b0;
        end
        Data:
        if (taken) begin
          byte_q <= byte_q == LastByte ? '0 : byte_q + 1'b1;
          if (byte_q == LastByte) begin
            word_q <= word_q + 1'b1;
            if (last_word) state_q <= CrcLow;
          end
        end
        CrcHigh: if (taken) state_q <= Idle;
        default: if (taken) state_q <= state_q + 1'b1;
      endcase
      if (taken & state_q != CrcLow & state_q != CrcHigh) crc_q <= crc;
    end
  end
endmodule
