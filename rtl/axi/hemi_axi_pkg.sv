// SPDX-License-Identifier: Apache-2.0

/// Layout of hemi_axi's streams and of its address space, in bytes. docs/fpga.md is the table of it.
package hemi_axi_pkg;
  localparam int DacLaneBits = 16;  // four lanes a beat

  localparam int AddressBits = 12;  // registers from 0 on
  localparam logic [AddressBits-1:0] RecordBase = 12'h200;
  localparam logic [AddressBits-1:0] Identity = 12'h300;
  localparam logic [AddressBits-1:0] Shape = 12'h304;
  localparam logic [AddressBits-1:0] InterruptEnable = 12'h308;
  localparam logic [AddressBits-1:0] InterruptPending = 12'h30c;
  localparam logic [AddressBits-1:0] FaultMask = 12'h310;
  localparam logic [AddressBits-1:0] RecordCount = 12'h314;
  localparam logic [AddressBits-1:0] LiveStatus = 12'h318;

  localparam logic [31:0] IdentityWord = 32'h48454d49;  // "HEMI"

  // What can be read back: 64 registers, then two banks of 16 record words.
  localparam int StoreBits = 7;

  localparam logic [1:0] Okay = 2'b00;
  localparam logic [1:0] SlaveError = 2'b10;
  localparam logic [1:0] DecodeError = 2'b11;
endpackage
