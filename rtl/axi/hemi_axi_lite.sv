// SPDX-License-Identifier: Apache-2.0

/// AXI4-Lite slave: the core's registers, the last record, interrupts. One access of each kind at a time; reading and
/// writing go on side by side.
///
/// A register has 64 bits, sign-extended, in two halves. Writing the low half keeps it here; writing the high half of
/// the same register commits both to the core in one clock. A high half without its low half before it is an error and
/// writes nothing. Write strobes other than 1111 are errors, too. Errors change nothing.
/// Area on the iCE40 UP5K (docs/fpga.md): 265 LUT4, 221 flip-flops; 30 MHz between registers.
module hemi_axi_lite (
    input  logic                                 clk_i,              // clock
    input  logic                                 rst_ni,             // synchronous reset, active low
    input  logic                                 clearing_i,         // the store cannot be read yet
    input  logic                                 awvalid_i,          // AXI4-Lite
    output logic                                 awready_o,
    input  logic [hemi_axi_pkg::AddressBits-1:0] awaddr_i,
    input  logic                                 wvalid_i,
    output logic                                 wready_o,
    input  logic [                         31:0] wdata_i,
    input  logic [                          3:0] wstrb_i,
    output logic                                 bvalid_o,
    input  logic                                 bready_i,
    output logic [                          1:0] bresp_o,
    input  logic                                 arvalid_i,
    output logic                                 arready_o,
    input  logic [hemi_axi_pkg::AddressBits-1:0] araddr_i,
    output logic                                 rvalid_o,
    input  logic                                 rready_i,
    output logic [                         31:0] rdata_o,
    output logic [                          1:0] rresp_o,
    output logic                                 register_valid_o,   // the core's register port
    input  logic                                 register_ready_i,
    output logic [    hemi_pkg::AddressBits-1:0] register_address_o,
    output logic [       hemi_pkg::WordBits-1:0] register_data_o,
    output logic [  hemi_axi_pkg::StoreBits-1:0] read_address_o,     // the store's read port
    input  logic [       hemi_pkg::WordBits-1:0] read_data_i,
    input  logic                                 bank_i,             // of the store, holds the last whole record
    input  logic                                 record_i,           // a record is complete
    input  logic [     hemi_pkg::StatusBits-1:0] live_i,             // with these live status bits
    output logic                                 irq_o               // level
);
  localparam int HighBits = hemi_pkg::WordBits - 32;
  localparam logic [hemi_axi_pkg::AddressBits-1:0] RegisterEnd =
      hemi_axi_pkg::AddressBits'(8 * hemi_pkg::FirstStateAddress);
  localparam logic [31:0] ShapeWord = {
    8'(hemi_pkg::AdcBits), 8'(hemi_pkg::Decimation), 8'(hemi_pkg::RecordWords), 8'(hemi_pkg::FirstStateAddress)
  };

  // Writing: address and data come in any order; with both here and room for the response, the access is done.
  logic aw_held_q, w_held_q, low_held_q, write_now, write_done, commit;
  logic [hemi_axi_pkg::AddressBits-1:0] awaddr_q;
  logic [31:0] wdata_q, low_q;
  logic [3:0] wstrb_q;
  logic [hemi_axi_pkg::AddressBits-4:0] low_index_q;
  logic [1:0] decoded_write, write_response;
  logic write_register, write_control, write_high, low_matches, write_allowed;

  assign awready_o      = ~aw_held_q & ~clearing_i;
  assign wready_o       = ~w_held_q & ~clearing_i;
  assign write_now      = aw_held_q & w_held_q & (~bvalid_o | bready_i);
  assign write_register = awaddr_q < RegisterEnd;
  assign write_high     = awaddr_q[2];
  assign low_matches    = low_held_q & low_index_q == awaddr_q[hemi_axi_pkg::AddressBits-1:3];
  assign write_control  = awaddr_q == hemi_axi_pkg::InterruptEnable | awaddr_q == hemi_axi_pkg::InterruptPending | awaddr_q == hemi_axi_pkg::FaultMask;

  hemi_axi_decode i_write_decode (
      .address_i (awaddr_q),
      .response_o(decoded_write)
  );
  assign write_allowed  = (write_control | (write_register & (~write_high | low_matches))) & wstrb_q == '1;
  assign write_response = decoded_write == hemi_axi_pkg::Okay & ~write_allowed ? hemi_axi_pkg::SlaveError : decoded_write;

  assign commit             = write_register & write_high & write_response == hemi_axi_pkg::Okay;
  assign register_valid_o   = write_now & commit;
  assign register_address_o = awaddr_q[3+:hemi_pkg::AddressBits];
  assign register_data_o    = {wdata_q[HighBits-1:0], low_q};
  assign write_done         = write_now & (~commit | register_ready_i);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      aw_held_q   <= 1'b0;
      w_held_q    <= 1'b0;
      awaddr_q    <= '0;
      wdata_q     <= '0;
      wstrb_q     <= '0;
      bvalid_o    <= 1'b0;
      bresp_o     <= hemi_axi_pkg::Okay;
      low_held_q  <= 1'b0;
      low_index_q <= '0;
      low_q       <= '0;
    end else begin
      if (awvalid_i & awready_o) begin
        aw_held_q <= 1'b1;
        awaddr_q  <= awaddr_i;
      end
      if (wvalid_i & wready_o) begin
        w_held_q <= 1'b1;
        wdata_q  <= wdata_i;
        wstrb_q  <= wstrb_i;
      end
      if (bready_i) bvalid_o <= 1'b0;
      if (write_done) begin
        aw_held_q <= 1'b0;
        w_held_q  <= 1'b0;
        bvalid_o  <= 1'b1;
        bresp_o   <= write_response;
        if (write_register & write_response == hemi_axi_pkg::Okay) begin
          low_held_q <= ~write_high;
          if (!write_high) begin
            low_index_q <= awaddr_q[hemi_axi_pkg::AddressBits-1:3];
            low_q       <= wdata_q;
          end
        end
      end
    end
  end

  // Interrupts: a record is complete; it is complete and has a live status bit that the mask names.
  logic [1:0] enable_q, pending_q;
  logic [hemi_pkg::StatusBits-1:0] fault_mask_q, live_q;
  logic [31:0] record_count_q;
  logic write_applies;

  assign write_applies = write_done & write_response == hemi_axi_pkg::Okay;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      enable_q       <= '0;
      pending_q      <= '0;
      fault_mask_q   <= '0;
      live_q         <= '0;
      record_count_q <= '0;
    end else begin
      if (write_applies & awaddr_q == hemi_axi_pkg::InterruptEnable) enable_q <= wdata_q[1:0];
      if (write_applies & awaddr_q == hemi_axi_pkg::FaultMask) fault_mask_q <= wdata_q[hemi_pkg::StatusBits-1:0];
      pending_q <= (pending_q & ~(write_applies & awaddr_q == hemi_axi_pkg::InterruptPending ? wdata_q[1:0] : 2'b00)) |
                   {record_i & |(live_i & fault_mask_q), record_i};
      if (record_i) begin
        live_q         <= live_i;
        record_count_q <= record_count_q + 1'b1;
      end
    end
  end
  assign irq_o = |(pending_q & enable_q);

  // Reading: a clock to fetch, a clock to answer.
  logic fetch_q;
  logic [hemi_axi_pkg::AddressBits-1:0] araddr_q;
  logic [31:0] stored_half, read_word;
  logic [1:0] decoded_read;

  assign arready_o      = ~fetch_q & ~rvalid_o & ~clearing_i;
  assign read_address_o = araddr_i < RegisterEnd ? {1'b0, araddr_i[8:3]} : {2'b10, bank_i, araddr_i[6:3]};

  assign stored_half    = araddr_q[2] ? 32'($signed(read_data_i[hemi_pkg::WordBits-1:32])) : read_data_i[31:0];

  always_comb begin
    unique case (araddr_q)
      hemi_axi_pkg::Identity: read_word = hemi_axi_pkg::IdentityWord;
      hemi_axi_pkg::Shape: read_word = ShapeWord;
      hemi_axi_pkg::InterruptEnable: read_word = 32'(enable_q);
      hemi_axi_pkg::InterruptPending: read_word = 32'(pending_q);
      hemi_axi_pkg::FaultMask: read_word = 32'(fault_mask_q);
      hemi_axi_pkg::RecordCount: read_word = record_count_q;
      hemi_axi_pkg::LiveStatus: read_word = 32'(live_q);
      default: read_word = stored_half;
    endcase
  end

  hemi_axi_decode i_read_decode (
      .address_i (araddr_q),
      .response_o(decoded_read)
  );

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      fetch_q  <= 1'b0;
      araddr_q <= '0;
      rvalid_o <= 1'b0;
      rdata_o  <= '0;
      rresp_o  <= hemi_axi_pkg::Okay;
    end else begin
      fetch_q <= arvalid_i & arready_o;
      if (arvalid_i & arready_o) araddr_q <= araddr_i;
      if (fetch_q) begin
        rvalid_o <= 1'b1;
        rresp_o  <= decoded_read;
        rdata_o  <= decoded_read == hemi_axi_pkg::Okay ? read_word : '0;
      end else if (rready_i) begin
        rvalid_o <= 1'b0;
      end
    end
  end
endmodule
