// SPDX-License-Identifier: Apache-2.0

/// hemi_axi behind five pins, for place and route alone; see hemi_pins.
module hemi_axi_pins (
    input  logic clk_i,     // clock
    input  logic rst_ni,    // reset, active low, taken at the clock
    input  logic serial_i,  // inputs, bit by bit
    input  logic load_i,    // take over the outputs
    output logic serial_o   // bit by bit
);
  localparam int SampleBits = hemi_pkg::AdcBits > 16 ? 64 : 32;
  localparam int DacBits = 4 * hemi_axi_pkg::DacLaneBits;
  localparam int InputBits = SampleBits + 2 * hemi_axi_pkg::AddressBits + 46;
  localparam int OutputBits = DacBits + 114;

  logic reset_nq;
  logic [InputBits-1:0] input_q;
  logic [OutputBits-1:0] outputs, output_q;

  logic sample_valid, dac_ready, record_ready, awvalid, wvalid, bready, arvalid, rready;
  logic [SampleBits-1:0] sample_data;
  logic [1:0] sample_user;
  logic [hemi_axi_pkg::AddressBits-1:0] awaddr, araddr;
  logic [31:0] wdata;
  logic [3:0] wstrb;
  assign {
    sample_valid, dac_ready, record_ready, awvalid, wvalid, bready, arvalid, rready,
    sample_data, sample_user, awaddr, araddr, wdata, wstrb
  } = input_q;

  logic sample_ready, dac_valid, record_valid, record_last, awready, wready, bvalid, arready, rvalid, irq;
  logic [DacBits-1:0] dac_data;
  logic [63:0] record_data;
  logic [3:0] record_user;
  logic [1:0] bresp, rresp;
  logic [31:0] rdata;
  assign outputs = {
    sample_ready, dac_valid, record_valid, record_last, awready, wready, bvalid, arready, rvalid, irq,
    dac_data, record_data, record_user, bresp, rresp, rdata
  };

  always_ff @(posedge clk_i) begin
    reset_nq <= rst_ni;
    input_q  <= {input_q[InputBits-2:0], serial_i};
    output_q <= load_i ? outputs : {output_q[OutputBits-2:0], 1'b0};
  end
  assign serial_o = output_q[OutputBits-1];

  hemi_axi i_axi (
      .aclk                (clk_i),
      .aresetn             (reset_nq),
      .s_axis_sample_tvalid(sample_valid),
      .s_axis_sample_tready(sample_ready),
      .s_axis_sample_tdata (sample_data),
      .s_axis_sample_tuser (sample_user),
      .m_axis_dac_tvalid   (dac_valid),
      .m_axis_dac_tready   (dac_ready),
      .m_axis_dac_tdata    (dac_data),
      .m_axis_record_tvalid(record_valid),
      .m_axis_record_tready(record_ready),
      .m_axis_record_tdata (record_data),
      .m_axis_record_tuser (record_user),
      .m_axis_record_tlast (record_last),
      .s_axil_awvalid      (awvalid),
      .s_axil_awready      (awready),
      .s_axil_awaddr       (awaddr),
      .s_axil_wvalid       (wvalid),
      .s_axil_wready       (wready),
      .s_axil_wdata        (wdata),
      .s_axil_wstrb        (wstrb),
      .s_axil_bvalid       (bvalid),
      .s_axil_bready       (bready),
      .s_axil_bresp        (bresp),
      .s_axil_arvalid      (arvalid),
      .s_axil_arready      (arready),
      .s_axil_araddr       (araddr),
      .s_axil_rvalid       (rvalid),
      .s_axil_rready       (rready),
      .s_axil_rdata        (rdata),
      .s_axil_rresp        (rresp),
      .irq_o               (irq)
  );
endmodule
