// SPDX-License-Identifier: Apache-2.0

/// What an address names, before asking whether the access is allowed: SlaveError where it is no multiple of four,
/// DecodeError where nothing is there. Combinational.
/// Area on the iCE40 UP5K (docs/fpga.md): 31 LUT4; 45 MHz between registers.
module hemi_axi_decode (
    input  logic [hemi_axi_pkg::AddressBits-1:0] address_i,
    output logic [                          1:0] response_o
);
  localparam logic [hemi_axi_pkg::AddressBits-1:0] RegisterEnd =
      hemi_axi_pkg::AddressBits'(8 * hemi_pkg::FirstStateAddress);
  localparam logic [hemi_axi_pkg::AddressBits-1:0] RecordEnd =
      hemi_axi_pkg::RecordBase + hemi_axi_pkg::AddressBits'(8 * hemi_pkg::RecordWords);

  logic aligned, mapped;

  assign aligned = address_i[1:0] == '0;
  assign mapped = address_i < RegisterEnd |
      (address_i >= hemi_axi_pkg::RecordBase & address_i < RecordEnd) |
      (address_i >= hemi_axi_pkg::Identity & address_i <= hemi_axi_pkg::LiveStatus);
  assign response_o = !aligned ? hemi_axi_pkg::SlaveError : mapped ? hemi_axi_pkg::Okay : hemi_axi_pkg::DecodeError;
endmodule
