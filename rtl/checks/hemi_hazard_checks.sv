// SPDX-License-Identifier: Apache-2.0

/// Simulation only: stops when an instruction reads a word whose new value is still on its way.
module hemi_hazard_checks (
    input logic                              clk_i,          // clock
    input logic                              rst_ni,         // synchronous reset, active low
    input logic                              issue_i,        // the instruction counts
    input logic [hemi_pkg::InstructionBits-1:0] instruction_i   // it
);
  localparam int Stages = 3;

  logic [hemi_pkg::AddressBits-1:0] dst_q[Stages];
  logic [Stages-1:0] pending_q;
  logic [hemi_pkg::AddressBits-1:0] a, dst;
  logic [hemi_pkg::BBits-1:0] b;
  logic [hemi_pkg::OperationBits-1:0] operation;
  logic [hemi_pkg::ConditionBits-1:0] condition;
  logic counts, multiplies, reads_a, reads_b;

  assign a          = instruction_i[hemi_pkg::ALsb+:hemi_pkg::ABits];
  assign b          = instruction_i[hemi_pkg::BLsb+:hemi_pkg::BBits];
  assign dst        = instruction_i[hemi_pkg::DstLsb+:hemi_pkg::DstBits];
  assign operation  = instruction_i[hemi_pkg::OperationLsb+:hemi_pkg::OperationBits];
  assign condition  = instruction_i[hemi_pkg::ConditionLsb+:hemi_pkg::ConditionBits];
  assign counts     = condition != hemi_pkg::CondNever;
  assign multiplies = operation == hemi_pkg::OpMultiply;
  assign reads_a    = issue_i & (counts | multiplies | (operation == hemi_pkg::OpLookUp));
  assign reads_b    = issue_i & (counts | multiplies);

  always_ff @(posedge clk_i) begin
    pending_q <= {pending_q[Stages-2:0], rst_ni & issue_i & counts};
    dst_q[0]  <= dst;
    for (int i = 1; i < Stages; i = i + 1) dst_q[i] <= dst_q[i-1];
    for (int i = 0; i < Stages; i = i + 1) begin
      if (rst_ni & pending_q[i] & ((reads_a & (dst_q[i] == a)) | (reads_b & ({1'b0, dst_q[i]} == b)))) begin
        $display("hazard: word %0d is read %0d clocks behind its instruction", dst_q[i], i + 1);
        $finish;
      end
    end
  end
endmodule
