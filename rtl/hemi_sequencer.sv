// SPDX-License-Identifier: Apache-2.0

/// Which instruction is next. A waiting sample goes first where the background yields; its work gives the machine
/// back. The last sample of a tick and telemetry wait until the background has finished.
/// Area on the iCE40 UP5K (docs/fpga.md): 116 LUT4, 29 flip-flops; 41 MHz between registers.
module hemi_sequencer (
    input  logic                       clk_i,          // clock
    input  logic                       rst_ni,         // synchronous reset, active low
    input  logic                       clearing_i,     // the state memory is being cleared
    input  logic                       waiting_i,      // a sample waits
    input  logic                       telemetry_i,    // it is a telemetry sample
    input  logic                       negative_i,     // sign of the last sum that was told to set it
    input  logic                       emit_ready_i,   // a record word can go out
    input  logic [ hemi_pkg::ControlBits-1:0] control_i,  // of the current instruction
    input  logic [ hemi_pkg::ConditionBits-1:0] condition_i,  // of it
    input  logic [ hemi_pkg::ProgramBits-1:0] target_i,  // of it, when it is a jump
    output logic [    hemi_pkg::ProgramBits-1:0] address_o,      // of the next one
    output logic                       issue_o,        // the current instruction counts
    output logic                       take_o,         // the sample has been read
    output logic                       close_o,        // that was the last sample of a tick
    output logic                       emit_o,         // the current instruction makes a record word
    output logic                       busy_o          // work is under way
);
  localparam int CountBits = 6;
  localparam logic [CountBits-1:0] LastSample = CountBits'(hemi_pkg::Decimation - 1);

  logic [hemi_pkg::ProgramBits-1:0] pc_q, back_q, back_d, entry;
  logic [  CountBits-1:0] sample_q, sample_d;
  logic run_q, run_d, background_q, background_d, started_q, started_d;
  logic last, may_enter, enter, jump;

  assign last      = sample_q == LastSample;
  assign may_enter = waiting_i & ~clearing_i & ~(background_q & (telemetry_i | last));
  assign entry     = telemetry_i ? hemi_pkg::EntryTelemetry : started_q ? hemi_pkg::EntrySample : hemi_pkg::EntryStart;
  assign jump      = condition_i == hemi_pkg::CondAlways | (condition_i == hemi_pkg::CondNegative & negative_i);
  assign busy_o    = run_q;

  always_comb begin
    address_o    = pc_q + 1'b1;
    issue_o      = run_q;
    take_o       = 1'b0;
    close_o      = 1'b0;
    emit_o       = 1'b0;
    enter        = 1'b0;
    run_d        = run_q;
    background_d = background_q;
    back_d       = back_q;
    sample_d     = sample_q;
    started_d    = started_q;
    if (!run_q) begin
      enter = may_enter;
    end else begin
      unique case (control_i)
        hemi_pkg::ControlYield: begin
          enter = may_enter;
          if (may_enter) back_d = pc_q + 1'b1;
        end
        hemi_pkg::ControlJump: begin
          issue_o = 1'b0;
          if (jump) address_o = target_i;
        end
        hemi_pkg::ControlEmit: begin
          emit_o  = emit_ready_i;
          issue_o = emit_ready_i;
          if (!emit_ready_i) begin
            enter     = may_enter;
            back_d    = pc_q;
            address_o = pc_q;
          end
        end
        hemi_pkg::ControlGiveBack: begin
          close_o  = last;
          sample_d = last ? '0 : sample_q + 1'b1;
          if (last) begin
            address_o    = hemi_pkg::EntryTick;
            background_d = 1'b1;
          end else if (background_q) begin
            address_o = back_q;
          end else begin
            run_d = 1'b0;
            enter = may_enter;
          end
        end
        hemi_pkg::ControlEnd: begin
          background_d = 1'b0;
          run_d        = 1'b0;
          enter        = may_enter;
        end
        hemi_pkg::ControlTake: take_o = 1'b1;
        default: ;
      endcase
    end
    if (enter) begin
      address_o = entry;
      run_d     = 1'b1;
      if (telemetry_i) background_d = 1'b1;
      else started_d = 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      pc_q         <= '0;
      back_q       <= '0;
      sample_q     <= '0;
      run_q        <= 1'b0;
      background_q <= 1'b0;
      started_q    <= 1'b0;
    end else begin
      pc_q         <= address_o;
      back_q       <= back_d;
      sample_q     <= sample_d;
      run_q        <= run_d;
      background_q <= background_d;
      started_q    <= started_d;
    end
  end
endmodule
