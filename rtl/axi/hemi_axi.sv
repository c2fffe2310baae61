// SPDX-License-Identifier: Apache-2.0

/// hemi_core with AXI: samples in and records and DAC words out as AXI4-Stream, registers as AXI4-Lite, one interrupt.
/// Nothing is lost at any back-pressure: DAC words or records that nobody takes stop the samples in the end. Tie tready
/// of a stream that is not used to 1. Area on the iCE40 UP5K, core included (docs/fpga.md): 2598 logic cells, 29 block
/// RAMs, 5 multipliers; 26 MHz.
module hemi_axi (
    input  logic                                    aclk,                  // clock
    input  logic                                    aresetn,               // synchronous reset, active low
    input  logic                                    s_axis_sample_tvalid,  // a pair of ADC words a beat
    output logic                                    s_axis_sample_tready,
    input  logic [   hemi_pkg::AdcBits > 16 ? 63 : 31:0] s_axis_sample_tdata,   // lanes {secondary, primary}, signed, low bits
    input  logic [                             1:0] s_axis_sample_tuser,   // {telemetry, gap}, as hemi_core has them
    output logic                                    m_axis_dac_tvalid,     // the DAC words of a sample a beat
    input  logic                                    m_axis_dac_tready,
    output logic [4*hemi_axi_pkg::DacLaneBits-1:0] m_axis_dac_tdata,      // {0, quadrature, rebalance, drive}, signed
    output logic                                    m_axis_record_tvalid,  // a record a packet, a word a beat
    input  logic                                    m_axis_record_tready,
    output logic [                            63:0] m_axis_record_tdata,   // sign-extended
    output logic [                             3:0] m_axis_record_tuser,   // which word
    output logic                                    m_axis_record_tlast,
    input  logic                                    s_axil_awvalid,        // registers: hemi_axi_lite
    output logic                                    s_axil_awready,
    input  logic [   hemi_axi_pkg::AddressBits-1:0] s_axil_awaddr,
    input  logic                                    s_axil_wvalid,
    output logic                                    s_axil_wready,
    input  logic [                            31:0] s_axil_wdata,
    input  logic [                             3:0] s_axil_wstrb,
    output logic                                    s_axil_bvalid,
    input  logic                                    s_axil_bready,
    output logic [                             1:0] s_axil_bresp,
    input  logic                                    s_axil_arvalid,
    output logic                                    s_axil_arready,
    input  logic [   hemi_axi_pkg::AddressBits-1:0] s_axil_araddr,
    output logic                                    s_axil_rvalid,
    input  logic                                    s_axil_rready,
    output logic [                            31:0] s_axil_rdata,
    output logic [                             1:0] s_axil_rresp,
    output logic                                    irq_o                  // high while an enabled one is pending
);
  localparam int LaneBits = hemi_pkg::AdcBits > 16 ? 32 : 16;

  logic sample_ready, room, sample_taken;
  logic dac_valid;
  logic [hemi_pkg::DacBits-1:0] drive, rebalance, quadrature;
  logic [hemi_pkg::WordBits-1:0] record_word;
  logic record_taken, record_done, bank_q;
  logic register_request, register_valid, register_ready, register_taken;
  logic [hemi_pkg::AddressBits-1:0] register_address;
  logic [hemi_pkg::WordBits-1:0] register_data, read_data;
  logic [hemi_axi_pkg::StoreBits-1:0] read_address;
  logic clearing;
  logic tap_valid, busy, unused;
  logic [hemi_pkg::TapBits-1:0] tap;
  logic [hemi_pkg::WordBits-1:0] tap_value;

  // Taps are for benches; the bits of a lane above the ADC word are not looked at.
  assign unused = &{1'b0, tap_valid, tap, tap_value, busy, s_axis_sample_tdata};

  assign s_axis_sample_tready = sample_ready & room;
  assign sample_taken         = s_axis_sample_tvalid & s_axis_sample_tready;
  assign record_taken         = m_axis_record_tvalid & m_axis_record_tready;
  assign record_done          = record_taken & m_axis_record_tlast;
  assign m_axis_record_tdata  = {{(64 - hemi_pkg::WordBits) {record_word[hemi_pkg::WordBits-1]}}, record_word};
  // The store has one write port and records do not wait.
  assign register_valid       = register_request & ~record_taken;
  assign register_taken       = register_valid & register_ready;

  // A record goes into one bank while the other can be read.
  always_ff @(posedge aclk) begin
    if (!aresetn) bank_q <= 1'b0;
    else if (record_done) bank_q <= ~bank_q;
  end

  hemi_core i_core (
      .clk_i             (aclk),
      .rst_ni            (aresetn),
      .sample_valid_i    (s_axis_sample_tvalid & room),
      .sample_ready_o    (sample_ready),
      .sample_x_i        (s_axis_sample_tdata[0+:hemi_pkg::AdcBits]),
      .sample_y_i        (s_axis_sample_tdata[LaneBits+:hemi_pkg::AdcBits]),
      .sample_gap_i      (s_axis_sample_tuser[0]),
      .sample_telemetry_i(s_axis_sample_tuser[1]),
      .dac_valid_o       (dac_valid),
      .dac_drive_o       (drive),
      .dac_rebalance_o   (rebalance),
      .dac_quadrature_o  (quadrature),
      .record_valid_o    (m_axis_record_tvalid),
      .record_ready_i    (m_axis_record_tready),
      .record_word_o     (record_word),
      .record_index_o    (m_axis_record_tuser),
      .record_last_o     (m_axis_record_tlast),
      .register_valid_i  (register_valid),
      .register_ready_o  (register_ready),
      .register_address_i(register_address),
      .register_data_i   (register_data),
      .tap_valid_o       (tap_valid),
      .tap_o             (tap),
      .tap_value_o       (tap_value),
      .busy_o            (busy)
  );

  hemi_axi_dac i_dac (
      .clk_i   (aclk),
      .rst_ni  (aresetn),
      .sample_i(sample_taken & ~s_axis_sample_tuser[1]),
      .room_o  (room),
      .push_i  (dac_valid),
      .words_i ({16'b0, quadrature, rebalance, drive}),
      .tvalid_o(m_axis_dac_tvalid),
      .tready_i(m_axis_dac_tready),
      .tdata_o (m_axis_dac_tdata)
  );

  hemi_axi_store #(
      .AddressBits(hemi_axi_pkg::StoreBits)
  ) i_store (
      .clk_i          (aclk),
      .rst_ni         (aresetn),
      .clearing_o     (clearing),
      .write_i        (record_taken | register_taken),
      .write_address_i(record_taken ? {2'b10, bank_q, m_axis_record_tuser} : {1'b0, register_address[5:0]}),
      .write_data_i   (record_taken ? record_word : register_data),
      .read_address_i (read_address),
      .read_data_o    (read_data)
  );

  hemi_axi_lite i_lite (
      .clk_i             (aclk),
      .rst_ni            (aresetn),
      .clearing_i        (clearing),
      .awvalid_i         (s_axil_awvalid),
      .awready_o         (s_axil_awready),
      .awaddr_i          (s_axil_awaddr),
      .wvalid_i          (s_axil_wvalid),
      .wready_o          (s_axil_wready),
      .wdata_i           (s_axil_wdata),
      .wstrb_i           (s_axil_wstrb),
      .bvalid_o          (s_axil_bvalid),
      .bready_i          (s_axil_bready),
      .bresp_o           (s_axil_bresp),
      .arvalid_i         (s_axil_arvalid),
      .arready_o         (s_axil_arready),
      .araddr_i          (s_axil_araddr),
      .rvalid_o          (s_axil_rvalid),
      .rready_i          (s_axil_rready),
      .rdata_o           (s_axil_rdata),
      .rresp_o           (s_axil_rresp),
      .register_valid_o  (register_request),
      .register_ready_i  (register_ready & ~record_taken),
      .register_address_o(register_address),
      .register_data_o   (register_data),
      .read_address_o    (read_address),
      .read_data_i       (read_data),
      .bank_i            (~bank_q),
      .record_i          (record_done),
      .live_i            (record_word[hemi_pkg::StatusBits-1:0]),
      .irq_o
  );
endmodule
