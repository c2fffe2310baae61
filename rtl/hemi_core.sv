// SPDX-License-Identifier: Apache-2.0

/// The signal core: ADC samples or telemetry in, DAC words and records out, registers on a write port, one clock. One
/// sequenced datapath does all blocks; hemi_pkg and hemi_program make it one of the two instruments.
///
/// Clocks: 48 a sample, some 520 a tick and 300 an output (program.lst, summary.txt); 118 are enough for each sample.
/// Area on the iCE40 UP5K (Yosys 0.23, nextpnr 0.4, reference instrument): 1790 logic cells, 27 block RAMs (25 without
/// taps), 5 multipliers; 28.1 MHz in the worst of five seeds (docs/fpga.md).
module hemi_core (
    input  logic                   clk_i,                 // clock
    input  logic                   rst_ni,                // synchronous reset, active low
    input  logic                   sample_valid_i,        // sample stream
    output logic                   sample_ready_o,
    input  logic [    hemi_pkg::AdcBits-1:0] sample_x_i,            // primary pickoff, signed
    input  logic [    hemi_pkg::AdcBits-1:0] sample_y_i,            // secondary pickoff, signed
    input  logic                   sample_gap_i,          // samples were lost before this; telemetry: invalid
    input  logic                   sample_telemetry_i,    // frequency and rate come from the registers instead
    output logic                   dac_valid_o,           // strobe: the words of one sample, held until the next
    output logic [    hemi_pkg::DacBits-1:0] dac_drive_o,           // signed
    output logic [    hemi_pkg::DacBits-1:0] dac_rebalance_o,
    output logic [    hemi_pkg::DacBits-1:0] dac_quadrature_o,
    output logic                   record_valid_o,        // record stream
    input  logic                   record_ready_i,
    output logic [   hemi_pkg::WordBits-1:0] record_word_o,         // signed, in the word's format
    output logic [            3:0] record_index_o,        // which word
    output logic                   record_last_o,         // last word of a record
    input  logic                   register_valid_i,      // register port
    output logic                   register_ready_o,
    input  logic [hemi_pkg::AddressBits-1:0] register_address_i,    // config::RegisterIndex, then telemetry
    input  logic [   hemi_pkg::WordBits-1:0] register_data_i,       // sign-extended
    output logic                   tap_valid_o,           // a block's output
    output logic [    hemi_pkg::TapBits-1:0] tap_o,                 // which (config::TapIndex)
    output logic [   hemi_pkg::WordBits-1:0] tap_value_o,           // sign-extended
    output logic                   busy_o                 // work is under way or a word waits to be taken
);
  logic [hemi_pkg::InstructionBits-1:0] instruction;
  logic [    hemi_pkg::ProgramBits-1:0] program_address;
  logic [hemi_pkg::TapBits-1:0] tap;
  logic issue, take, close, emit_start, emit_free, negative, running;
  logic waiting, gap, telemetry, overload;
  logic [hemi_pkg::AdcBits-1:0] x, y;
  logic clear_live, raised, emitted, written, in_flight;
  logic [hemi_pkg::StatusBits-1:0] live;
  logic [ hemi_pkg::EventBits-1:0] raised_event;
  logic [hemi_pkg::AddressBits-1:0] result_address, write_address;
  logic [hemi_pkg::WordBits-1:0] a, b, result, write_data;
  logic clearing_q, write, register_taken, register_exists;
  logic [hemi_pkg::AddressBits-1:0] clear_address_q;

  // After reset all words are cleared; registers may be written from then on.
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      clearing_q      <= 1'b1;
      clear_address_q <= '0;
    end else if (clearing_q) begin
      clearing_q      <= clear_address_q != '1;
      clear_address_q <= clear_address_q + 1'b1;
    end
  end

  assign register_ready_o = ~clearing_q & ~written;
  assign register_taken   = register_valid_i & register_ready_o;
  assign register_exists  = register_address_i < hemi_pkg::AddressBits'(hemi_pkg::FirstStateAddress);
  assign write            = clearing_q | written | (register_taken & register_exists);
  assign write_address    = clearing_q ? clear_address_q : written ? result_address : register_address_i;
  assign write_data       = clearing_q ? '0 : written ? result : register_data_i;
  assign busy_o           = clearing_q | running | waiting | in_flight | ~emit_free;

  hemi_sample_port i_sample_port (
      .clk_i,
      .rst_ni,
      .valid_i    (sample_valid_i),
      .ready_o    (sample_ready_o),
      .x_i        (sample_x_i),
      .y_i        (sample_y_i),
      .gap_i      (sample_gap_i),
      .telemetry_i(sample_telemetry_i),
      .take_i     (take),
      .waiting_o  (waiting),
      .x_o        (x),
      .y_o        (y),
      .gap_o      (gap),
      .telemetry_o(telemetry),
      .overload_o (overload)
  );

  hemi_program i_program (
      .clk_i,
      .address_i    (program_address),
      .instruction_o(instruction),
      .tap_o        (tap)
  );

  hemi_sequencer i_sequencer (
      .clk_i,
      .rst_ni,
      .clearing_i   (clearing_q),
      .waiting_i    (waiting),
      .telemetry_i  (telemetry),
      .negative_i   (negative),
      .emit_ready_i (emit_free),
      .control_i    (instruction[hemi_pkg::ControlLsb+:hemi_pkg::ControlBits]),
      .condition_i  (instruction[hemi_pkg::ConditionLsb+:hemi_pkg::ConditionBits]),
      .target_i     (instruction[hemi_pkg::BLsb+:hemi_pkg::ProgramBits]),
      .address_o    (program_address),
      .issue_o      (issue),
      .take_o       (take),
      .close_o      (close),
      .emit_o       (emit_start),
      .busy_o       (running)
  );

  hemi_state_memory i_state_memory (
      .clk_i,
      .a_address_i(instruction[hemi_pkg::ALsb+:hemi_pkg::ABits]),
      .b_address_i(instruction[hemi_pkg::BLsb+:hemi_pkg::AddressBits]),
      .a_o        (a),
      .b_o        (b),
      .write_i    (write),
      .address_i  (write_address),
      .data_i     (write_data)
  );

  hemi_datapath i_datapath (
      .clk_i,
      .rst_ni,
      .issue_i      (issue),
      .instruction_i(instruction),
      .tap_i        (tap),
      .a_i          (a),
      .b_i          (b),
      .sample_x_i   (x),
      .sample_y_i   (y),
      .gap_i        (gap),
      .live_i       (live),
      .clear_live_o (clear_live),
      .negative_o   (negative),
      .write_o      (written),
      .address_o    (result_address),
      .result_o     (result),
      .emit_o       (emitted),
      .raise_o      (raised),
      .event_o      (raised_event),
      .tap_valid_o,
      .tap_o,
      .busy_o       (in_flight)
  );

  hemi_status i_status (
      .clk_i,
      .rst_ni,
      .sample_i  (take & ~telemetry),
      .overload_i(overload),
      .gap_i     (gap),
      .close_i   (close),
      .raise_i   (raised),
      .event_i   (raised_event),
      .clear_i   (clear_live),
      .live_o    (live)
  );

  hemi_dac_port i_dac_port (
      .clk_i,
      .rst_ni,
      .write_i     (written),
      .address_i   (result_address),
      .word_i      (result[hemi_pkg::DacBits-1:0]),
      .valid_o     (dac_valid_o),
      .drive_o     (dac_drive_o),
      .rebalance_o (dac_rebalance_o),
      .quadrature_o(dac_quadrature_o)
  );

  hemi_record_port i_record_port (
      .clk_i,
      .rst_ni,
      .start_i(emit_start),
      .emit_i (emitted),
      .word_i (result),
      .free_o (emit_free),
      .valid_o(record_valid_o),
      .ready_i(record_ready_i),
      .word_o (record_word_o),
      .index_o(record_index_o),
      .last_o (record_last_o)
  );

  assign tap_value_o = result;

`ifdef HEMI_CHECKS
  hemi_hazard_checks i_hazard_checks (
      .clk_i,
      .rst_ni,
      .issue_i      (issue),
      .instruction_i(instruction)
  );
`endif
endmodule
