// SPDX-License-Identifier: Apache-2.0

/// hemi_core behind five pins, for place and route alone: every input comes from a shift register, every output goes
/// to one, so each path of the core's ports is a path from register to register. Taps are unconnected.
module hemi_pins (
    input  logic clk_i,     // clock
    input  logic rst_ni,    // reset, active low, taken at the clock
    input  logic serial_i,  // inputs of the core, bit by bit
    input  logic load_i,    // take over the core's outputs
    output logic serial_o   // bit by bit
);
  localparam int InputBits = 2 * hemi_pkg::AdcBits + 5 + hemi_pkg::AddressBits + hemi_pkg::WordBits;
  localparam int OutputBits = 3 * hemi_pkg::DacBits + 10 + hemi_pkg::WordBits;

  logic reset_nq;
  logic [InputBits-1:0] input_q;
  logic [OutputBits-1:0] outputs, output_q;

  logic sample_valid, sample_gap, sample_telemetry, record_ready, register_valid;
  logic [hemi_pkg::AdcBits-1:0] x, y;
  logic [hemi_pkg::AddressBits-1:0] address;
  logic [hemi_pkg::WordBits-1:0] data;
  assign {sample_valid, sample_gap, sample_telemetry, record_ready, register_valid, x, y, address, data} = input_q;

  logic sample_ready, dac_valid, record_valid, record_last, register_ready, busy;
  logic [hemi_pkg::DacBits-1:0] drive, rebalance, quadrature;
  logic [hemi_pkg::WordBits-1:0] word;
  logic [3:0] index;
  logic tap_valid, unused;
  logic [hemi_pkg::TapBits-1:0] tap;
  logic [hemi_pkg::WordBits-1:0] tap_value;
  assign unused = &{1'b0, tap_valid, tap, tap_value};
  assign outputs = {
    sample_ready, dac_valid, record_valid, record_last, register_ready, busy, index, drive, rebalance, quadrature, word
  };

  always_ff @(posedge clk_i) begin
    reset_nq <= rst_ni;
    input_q  <= {input_q[InputBits-2:0], serial_i};
    output_q <= load_i ? outputs : {output_q[OutputBits-2:0], 1'b0};
  end
  assign serial_o = output_q[OutputBits-1];

  hemi_core i_core (
      .clk_i,
      .rst_ni            (reset_nq),
      .sample_valid_i    (sample_valid),
      .sample_ready_o    (sample_ready),
      .sample_x_i        (x),
      .sample_y_i        (y),
      .sample_gap_i      (sample_gap),
      .sample_telemetry_i(sample_telemetry),
      .dac_valid_o       (dac_valid),
      .dac_drive_o       (drive),
      .dac_rebalance_o   (rebalance),
      .dac_quadrature_o  (quadrature),
      .record_valid_o    (record_valid),
      .record_ready_i    (record_ready),
      .record_word_o     (word),
      .record_index_o    (index),
      .record_last_o     (record_last),
      .register_valid_i  (register_valid),
      .register_ready_o  (register_ready),
      .register_address_i(address),
      .register_data_i   (data),
      .tap_valid_o       (tap_valid),
      .tap_o             (tap),
      .tap_value_o       (tap_value),
      .busy_o            (busy)
  );
endmodule
