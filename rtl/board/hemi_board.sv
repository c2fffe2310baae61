// SPDX-License-Identifier: Apache-2.0

/// hemi_core with its converters and a serial link, one clock of 24 MHz (hemi_board_pkg): 240 clocks a sample.
///
/// Time, in clocks after instant n, at which both ADCs sample and LDAC falls: sample n is there at 79 and its words, by
/// the core's 118 clocks a sample, at 197 or before; they are sent from instant n + 1 on and act from instant n + 2 to
/// n + 3. Words that are not there at instant n + 1 raise a fault, as does a sample that the core has not taken when the
/// next is there. Where nothing is sampled, the DACs get zero.
///
/// Requests on the link (docs/board.md): registers of the core, with a copy to read back, the last record, control and
/// faults. One request at a time; each is answered.
/// Area on the iCE40 UP5K (docs/fpga.md): 253 LUT4, 31 flip-flops.
module hemi_board (
    input  logic clk_i,             // clock
    input  logic rst_ni,            // synchronous reset, active low
    output logic adc_cnv_o,         // ADCs, see hemi_adc_spi
    output logic adc_sck_o,
    input  logic adc_sdo_x_i,       // primary pickoff
    input  logic adc_sdo_y_i,       // secondary
    output logic dac_ldac_no,       // DACs, see hemi_dac_spi
    output logic dac_cs_no,
    output logic dac_sck_o,
    output logic dac_drive_o,
    output logic dac_rebalance_o,
    output logic dac_quadrature_o,
    input  logic rx_i,              // serial link
    output logic tx_o,
    output logic active_o,          // sampling
    output logic fault_o            // a fault since it was cleared
);
  localparam int StoreBits = 7;  // 64 registers, two banks of 16 record words
  localparam logic [31:0] ShapeWord = {
    8'(hemi_pkg::AdcBits), 8'(hemi_pkg::Decimation), 8'(hemi_pkg::RecordWords), 8'(hemi_pkg::FirstStateAddress)
  };
  localparam logic [7:0] LastClock = 8'(hemi_board_pkg::SampleClocks - 1);

  // Period of the samples.
  logic [7:0] count_q;
  logic instant, run_q, active_q;

  assign instant = count_q == '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      count_q  <= '0;
      active_q <= 1'b0;
    end else begin
      count_q <= count_q == LastClock ? '0 : count_q + 1'b1;
      if (count_q == LastClock) active_q <= run_q;
    end
  end
  assign active_o = active_q;

  // Samples. A stop leaves a gap.
  logic sample_done, sample_valid_q, sample_ready, gap_q, sampled_q, fresh_q, core_rst_nq;
  logic [15:0] x, y;
  logic sample_lost, words_late, dac_valid;
  logic [hemi_pkg::DacBits-1:0] drive, rebalance, quadrature;

  hemi_adc_spi i_adc_spi (
      .clk_i,
      .rst_ni,
      .active_i(active_q),
      .count_i (count_q),
      .cnv_o   (adc_cnv_o),
      .sck_o   (adc_sck_o),
      .sdo_x_i (adc_sdo_x_i),
      .sdo_y_i (adc_sdo_y_i),
      .valid_o (sample_done),
      .x_o     (x),
      .y_o     (y)
  );

  assign sample_lost = sample_done & sample_valid_q & ~sample_ready;
  assign words_late  = instant & sampled_q & ~fresh_q;

  always_ff @(posedge clk_i) begin
    if (!core_rst_nq) begin
      sample_valid_q <= 1'b0;
      gap_q          <= 1'b0;
      sampled_q      <= 1'b0;
      fresh_q        <= 1'b0;
    end else begin
      if (sample_done) sample_valid_q <= 1'b1;
      else if (sample_ready) sample_valid_q <= 1'b0;
      if (sample_lost | (instant & sampled_q & ~active_q)) gap_q <= 1'b1;
      else if (sample_valid_q & sample_ready) gap_q <= 1'b0;
      if (instant) sampled_q <= active_q;
      if (dac_valid) fresh_q <= 1'b1;
      else if (instant) fresh_q <= 1'b0;
    end
  end

  hemi_dac_spi i_dac_spi (
      .clk_i,
      .rst_ni,
      .count_i     (count_q),
      .drive_i     (active_q ? drive : '0),
      .rebalance_i (active_q ? rebalance : '0),
      .quadrature_i(active_q ? quadrature : '0),
      .ldac_no     (dac_ldac_no),
      .cs_no       (dac_cs_no),
      .sck_o       (dac_sck_o),
      .drive_o     (dac_drive_o),
      .rebalance_o (dac_rebalance_o),
      .quadrature_o(dac_quadrature_o)
  );

  // Core.
  logic record_valid, record_last, record_done, bank_q;
  logic [hemi_pkg::WordBits-1:0] record_word, tap_value;
  logic [3:0] record_index;
  logic register_valid, register_ready, register_write;
  logic tap_valid, busy, unused;
  logic [hemi_pkg::TapBits-1:0] tap;

  hemi_core i_core (
      .clk_i,
      .rst_ni            (core_rst_nq),
      .sample_valid_i    (sample_valid_q),
      .sample_ready_o    (sample_ready),
      .sample_x_i        (x),
      .sample_y_i        (y),
      .sample_gap_i      (gap_q),
      .sample_telemetry_i(1'b0),
      .dac_valid_o       (dac_valid),
      .dac_drive_o       (drive),
      .dac_rebalance_o   (rebalance),
      .dac_quadrature_o  (quadrature),
      .record_valid_o    (record_valid),
      .record_ready_i    (1'b1),
      .record_word_o     (record_word),
      .record_index_o    (record_index),
      .record_last_o     (record_last),
      .register_valid_i  (register_valid),
      .register_ready_o  (register_ready),
      .register_address_i(hemi_pkg::AddressBits'(address)),
      .register_data_i   (data[hemi_pkg::WordBits-1:0]),
      .tap_valid_o       (tap_valid),
      .tap_o             (tap),
      .tap_value_o       (tap_value),
      .busy_o            (busy)
  );

  // Taps are for benches; a word on the link is longer than the core's.
  assign unused = &{1'b0, tap_valid, tap, tap_value, busy, clearing, data};

  // Requests.
  logic request, request_bad, request_lost, waiting_q, response_q, response_taken, refused_q;
  logic [7:0] command, address;
  logic [55:0] data;
  logic write, is_register, is_record, is_board, take, control_write, reset_request, mapped;

  hemi_link_receiver i_link_receiver (
      .clk_i,
      .rst_ni,
      .rx_i,
      .busy_i   (waiting_q | response_q),
      .valid_o  (request),
      .bad_o    (request_bad),
      .lost_o   (request_lost),
      .command_o(command),
      .address_o(address),
      .data_o   (data)
  );

  assign write          = command == hemi_board_pkg::WriteCommand;
  assign is_register    = address < 8'(hemi_pkg::FirstStateAddress);
  assign is_record      = address[7:4] == hemi_board_pkg::RecordBase[7:4] & address[3:0] < 4'(hemi_pkg::RecordWords);
  assign is_board       = address[7:2] == hemi_board_pkg::Identity[7:2];
  assign mapped         = write ? is_register | (is_board & address[1]) :
                          command == hemi_board_pkg::ReadCommand & (is_register | is_record | is_board);
  assign register_write = waiting_q & write & is_register;
  assign register_valid = register_write & ~record_valid;  // the store has one write port and records do not wait
  assign take           = waiting_q & (~register_write | (register_valid & register_ready));
  assign control_write  = take & write & address == hemi_board_pkg::Control;
  assign reset_request  = control_write & data[1];

  // Faults, from bit 0 on: a sample was lost; words came late; a request had a wrong CRC; one came before the answer.
  logic [3:0] faults_q;

  assign fault_o = |faults_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      waiting_q   <= 1'b0;
      response_q  <= 1'b0;
      refused_q   <= 1'b0;
      run_q       <= 1'b0;
      core_rst_nq <= 1'b0;
      faults_q    <= '0;
    end else begin
      if (request) waiting_q <= 1'b1;
      else if (take) waiting_q <= 1'b0;
      if (take) begin
        response_q <= 1'b1;
        refused_q  <= ~mapped;
      end else if (response_taken) begin
        response_q <= 1'b0;
      end
      if (control_write) run_q <= data[0] & ~data[1];
      core_rst_nq <= ~reset_request;
      faults_q <= (faults_q & ~(take & write & address == hemi_board_pkg::Faults ? data[3:0] : 4'b0)) |
                  {request_lost, request_bad, words_late, sample_lost};
    end
  end

  // What the core does not give back: registers as written, records in two banks, one to read while the other fills.
  logic [7:0] record_number_q;
  logic [hemi_pkg::WordBits-1:0] stored, response_word;
  logic [31:0] board_word;
  logic fetch_record, clearing;
  logic [3:0] fetch_index;

  assign record_done = record_valid & record_last;

  always_ff @(posedge clk_i) begin
    if (!core_rst_nq) begin
      bank_q          <= 1'b0;
      record_number_q <= '0;
    end else if (record_done) begin
      bank_q          <= ~bank_q;
      record_number_q <= record_number_q + 1'b1;
    end
  end

  hemi_axi_store #(
      .AddressBits(StoreBits)
  ) i_store (
      .clk_i,
      .rst_ni         (core_rst_nq),
      .clearing_o     (clearing),
      .write_i        (record_valid | (register_valid & register_ready)),
      .write_address_i(record_valid ? {2'b10, bank_q, record_index} : {1'b0, address[5:0]}),
      .write_data_i   (record_valid ? record_word : data[hemi_pkg::WordBits-1:0]),
      .read_address_i (fetch_record ? {2'b10, ~bank_q, fetch_index} :
                       is_register ? {1'b0, address[5:0]} : {2'b10, ~bank_q, address[3:0]}),
      .read_data_o    (stored)
  );

  always_comb begin
    unique case (address)
      hemi_board_pkg::Identity: board_word = hemi_board_pkg::IdentityWord;
      hemi_board_pkg::Shape:    board_word = ShapeWord;
      hemi_board_pkg::Control:  board_word = {31'b0, run_q};
      default:                  board_word = {28'b0, faults_q};
    endcase
  end
  assign response_word = refused_q ? '0 : is_board ? hemi_pkg::WordBits'(board_word) : stored;

  hemi_link_sender i_link_sender (
      .clk_i,
      .rst_ni,
      .clear_i           (~core_rst_nq),
      .record_i          (record_done),
      .record_number_i   (record_number_q),
      .response_i        (response_q),
      .response_taken_o  (response_taken),
      .response_code_i   (refused_q ? hemi_board_pkg::Refused : hemi_board_pkg::Done),
      .response_address_i(address),
      .fetch_record_o    (fetch_record),
      .fetch_index_o     (fetch_index),
      .record_word_i     (stored),
      .response_word_i   (response_word),
      .tx_o
  );
endmodule
