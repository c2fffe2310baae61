// SPDX-License-Identifier: Apache-2.0

/// Handshake properties of hemi_axi_lite; every input that has no assumption is free at every clock.
module hemi_axi_lite_proof (
    input logic                                 clk_i,
    input logic                                 rst_ni,
    input logic                                 clearing_i,
    input logic                                 awvalid_i,
    input logic [hemi_axi_pkg::AddressBits-1:0] awaddr_i,
    input logic                                 wvalid_i,
    input logic [                         31:0] wdata_i,
    input logic [                          3:0] wstrb_i,
    input logic                                 bready_i,
    input logic                                 arvalid_i,
    input logic [hemi_axi_pkg::AddressBits-1:0] araddr_i,
    input logic                                 rready_i,
    input logic                                 register_ready_i,
    input logic [       hemi_pkg::WordBits-1:0] read_data_i,
    input logic                                 bank_i,
    input logic                                 record_i,
    input logic [     hemi_pkg::StatusBits-1:0] live_i
);
  logic awready, wready, bvalid, arready, rvalid, register_valid, irq;
  logic [1:0] bresp, rresp;
  logic [31:0] rdata;
  logic [hemi_pkg::AddressBits-1:0] register_address;
  logic [hemi_pkg::WordBits-1:0] register_data;
  logic [hemi_axi_pkg::StoreBits-1:0] read_address;

  hemi_axi_lite i_lite (
      .clk_i,
      .rst_ni,
      .clearing_i,
      .awvalid_i,
      .awready_o         (awready),
      .awaddr_i,
      .wvalid_i,
      .wready_o          (wready),
      .wdata_i,
      .wstrb_i,
      .bvalid_o          (bvalid),
      .bready_i,
      .bresp_o           (bresp),
      .arvalid_i,
      .arready_o         (arready),
      .araddr_i,
      .rvalid_o          (rvalid),
      .rready_i,
      .rdata_o           (rdata),
      .rresp_o           (rresp),
      .register_valid_o  (register_valid),
      .register_ready_i,
      .register_address_o(register_address),
      .register_data_o   (register_data),
      .read_address_o    (read_address),
      .read_data_i,
      .bank_i,
      .record_i,
      .live_i,
      .irq_o             (irq)
  );

  // Registers of the device under test; the script that runs the proof connects them.
  logic aw_held, w_held, fetch;

  // Transfers since reset whose response is still to come.
  logic [1:0] addresses_q = '0, data_q = '0, reads_q = '0;
  logic started_q = 1'b0, held_b_q = 1'b0, held_r_q = 1'b0, held_register_q = 1'b0, reset_q = 1'b1;
  logic [1:0] bresp_q, rresp_q;
  logic [31:0] rdata_q;
  logic [hemi_pkg::AddressBits-1:0] register_address_q;
  logic [hemi_pkg::WordBits-1:0] register_data_q;

  always @(posedge clk_i) begin
    started_q          <= 1'b1;
    reset_q            <= ~rst_ni;
    held_b_q           <= rst_ni & bvalid & ~bready_i;
    held_r_q           <= rst_ni & rvalid & ~rready_i;
    held_register_q    <= rst_ni & register_valid & ~register_ready_i & ~bvalid;
    bresp_q            <= bresp;
    rresp_q            <= rresp;
    rdata_q            <= rdata;
    register_address_q <= register_address;
    register_data_q    <= register_data;
    if (!rst_ni) begin
      addresses_q <= '0;
      data_q      <= '0;
      reads_q     <= '0;
    end else begin
      addresses_q <= addresses_q + 2'(awvalid_i & awready) - 2'(bvalid & bready_i);
      data_q      <= data_q + 2'(wvalid_i & wready) - 2'(bvalid & bready_i);
      reads_q     <= reads_q + 2'(arvalid_i & arready) - 2'(rvalid & rready_i);
    end
  end

  always @(posedge clk_i) begin
    if (!started_q) assume (!rst_ni);
    if (started_q & reset_q) begin
      quiet : assert (!bvalid & !rvalid & !register_valid & !irq);
    end
    if (started_q & held_b_q) begin
      write_response_stands : assert (bvalid & bresp == bresp_q);
    end
    if (started_q & held_r_q) begin
      read_data_stand : assert (rvalid & rdata == rdata_q & rresp == rresp_q);
    end
    if (started_q & held_register_q) begin
      commit_stands : assert (register_valid & register_address == register_address_q & register_data == register_data_q);
    end
    if (started_q) begin
      // A response answers a request, one for one; two writes and one read at most are under way.
      answered_write : assert (!bvalid | (addresses_q != 0 & data_q != 0));
      answered_read : assert (!rvalid | reads_q == 1);
      writes_under_way : assert (addresses_q <= 2 & data_q <= 2);
      reads_under_way : assert (reads_q <= 1);
      commit_has_room : assert (!register_valid | (addresses_q != 0 & data_q != 0));
      commit_is_mapped : assert (!register_valid | register_address < hemi_pkg::FirstStateAddress);
      exclusive_codes : assert (bresp != 2'b01 & rresp != 2'b01);
      // Ties the counters to the state of the device, without which induction starts from nonsense.
      address_count : assert (addresses_q == 2'(aw_held) + 2'(bvalid));
      data_count : assert (data_q == 2'(w_held) + 2'(bvalid));
      read_count : assert (reads_q == 2'(fetch) + 2'(rvalid));
    end
  end
endmodule
