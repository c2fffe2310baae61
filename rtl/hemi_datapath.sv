// SPDX-License-Identifier: Apache-2.0

/// Operand, shift, sum, quantise: four clocks from an instruction to its word, one instruction a clock, nothing
/// waits. dst = quantise(a +- (b >>> shift, floor or half up)); b from the state memory or from a port.
/// Area on the iCE40 UP5K (docs/fpga.md): 649 LUT4, 304 flip-flops; 32 MHz between registers.
module hemi_datapath (
    input  logic                       clk_i,          // clock
    input  logic                       rst_ni,         // synchronous reset, active low
    input  logic                       issue_i,        // the instruction counts
    input  logic [hemi_pkg::InstructionBits-1:0] instruction_i,  // see hemi_pkg
    input  logic [        hemi_pkg::TapBits-1:0] tap_i,          // tap of its result
    input  logic [       hemi_pkg::WordBits-1:0] a_i,            // operands from the state memory, a clock later
    input  logic [       hemi_pkg::WordBits-1:0] b_i,
    input  logic [        hemi_pkg::AdcBits-1:0] sample_x_i,     // ports
    input  logic [        hemi_pkg::AdcBits-1:0] sample_y_i,
    input  logic                       gap_i,
    input  logic [     hemi_pkg::StatusBits-1:0] live_i,
    output logic                       clear_live_o,   // live_i is being read
    output logic                       negative_o,     // sign of the last sum that was told to set it
    output logic                       write_o,        // result goes to the state memory
    output logic [    hemi_pkg::AddressBits-1:0] address_o,
    output logic [       hemi_pkg::WordBits-1:0] result_o,
    output logic                       emit_o,         // result is a record word
    output logic                       raise_o,        // a status bit is raised
    output logic [      hemi_pkg::EventBits-1:0] event_o,        // which
    output logic                       tap_valid_o,    // result is a block's output
    output logic [        hemi_pkg::TapBits-1:0] tap_o,          // which
    output logic                       busy_o          // an instruction is under way
);
  // Operand stage, beside the state memory's read.
  logic                     issue_q, emit_2_q, load_q, round_q, sets_2_q;
  logic [      hemi_pkg::TapBits-1:0] tap_2_q;
  logic [  hemi_pkg::AddressBits-1:0] dst_2_q;
  logic [    hemi_pkg::ShiftBits-1:0] distance_q;
  logic [     hemi_pkg::ModeBits-1:0] mode_2_q;
  logic [hemi_pkg::OperationBits-1:0] operation_q;
  logic [hemi_pkg::ConditionBits-1:0] condition_q;
  logic [    hemi_pkg::EventBits-1:0] event_2_q;
  logic                     from_product_q, from_port_q, mirror_q;
  logic [             31:0] x, y, gap, live, looked_up, fixed, port_d, port_q;
  logic [             18:0] magnitude;
  logic                     mirror;
  logic [        hemi_pkg::BBits-1:0] b_address;
  logic [  hemi_pkg::ControlBits-1:0] control;

  assign b_address    = instruction_i[hemi_pkg::BLsb+:hemi_pkg::BBits];
  assign control      = instruction_i[hemi_pkg::ControlLsb+:hemi_pkg::ControlBits];
  assign clear_live_o = issue_i & (b_address == hemi_pkg::LivePort);

  assign x         = {{(32 - hemi_pkg::AdcBits) {sample_x_i[hemi_pkg::AdcBits-1]}}, sample_x_i};
  assign y         = {{(32 - hemi_pkg::AdcBits) {sample_y_i[hemi_pkg::AdcBits-1]}}, sample_y_i};
  assign gap       = {32{gap_i}};
  assign live      = {{(32 - hemi_pkg::StatusBits) {1'b0}}, live_i};
  assign looked_up = {13'b0, magnitude};

  hemi_constants i_constants (
      .address_i (b_address[7:0]),
      .constant_o(fixed)
  );

  always_comb begin
    unique case (b_address)
      hemi_pkg::SampleXPort: port_d = x;
      hemi_pkg::SampleYPort: port_d = y;
      hemi_pkg::GapPort:     port_d = gap;
      hemi_pkg::LivePort:    port_d = live;
      hemi_pkg::LookupPort:  port_d = looked_up;
      default:               port_d = fixed;
    endcase
  end

  always_ff @(posedge clk_i) begin
    issue_q        <= rst_ni & issue_i;
    emit_2_q       <= control == hemi_pkg::ControlEmit;
    load_q         <= control == hemi_pkg::ControlLoadShift;
    tap_2_q        <= tap_i;
    dst_2_q        <= instruction_i[hemi_pkg::DstLsb+:hemi_pkg::DstBits];
    distance_q     <= instruction_i[hemi_pkg::ShiftLsb+:hemi_pkg::ShiftBits];
    round_q        <= instruction_i[hemi_pkg::RoundLsb];
    mode_2_q       <= instruction_i[hemi_pkg::ModeLsb+:hemi_pkg::ModeBits];
    operation_q    <= instruction_i[hemi_pkg::OperationLsb+:hemi_pkg::OperationBits];
    condition_q    <= instruction_i[hemi_pkg::ConditionLsb+:hemi_pkg::ConditionBits];
    sets_2_q       <= instruction_i[hemi_pkg::SetsNegativeLsb];
    event_2_q      <= instruction_i[hemi_pkg::EventLsb+:hemi_pkg::EventBits];
    from_product_q <= b_address == hemi_pkg::ProductPort;
    from_port_q    <= b_address[hemi_pkg::BBits-1] & (b_address != hemi_pkg::ProductPort);
    port_q         <= port_d;
    mirror_q       <= mirror;
  end

  // Shift stage.
  logic                 negative_q, negate, execute;
  logic [hemi_pkg::ShiftBits-1:0] variable_q, distance;
  logic [         55:0] product, b_port, b_word, b_here, b;
  logic signed [  56:0] unshifted, shifted;
  logic [ hemi_pkg::WordBits-1:0] a_3_q;
  logic [         55:0] b_3_q;
  logic carry_q, exclusive_q, execute_3_q, emit_3_q, sets_3_q;
  logic [    hemi_pkg::TapBits-1:0] tap_3_q;
  logic [hemi_pkg::AddressBits-1:0] dst_3_q;
  logic [   hemi_pkg::ModeBits-1:0] mode_3_q;
  logic [  hemi_pkg::EventBits-1:0] event_3_q;

  hemi_multiplier i_multiplier (
      .clk_i,
      .a_i      (a_i[31:0]),
      .b_i      (b_here[23:0]),
      .product_o(product)
  );

  hemi_nco_table i_nco_table (
      .clk_i,
      .angle_i    (a_i[hemi_pkg::PhaseFraction-1-:24]),
      .cosine_i   (distance_q[0]),
      .magnitude_o(magnitude),
      .negative_o (mirror)
  );

  assign b_port = {{24{port_q[31]}}, port_q};
  assign b_word = {{2{b_i[hemi_pkg::WordBits-1]}}, b_i};
  assign b_here = from_port_q ? b_port : b_word;
  assign b      = from_product_q ? product : b_here;
  assign distance = distance_q == hemi_pkg::VariableShift ? variable_q : distance_q;
  assign unshifted = {b, 1'b0};
  assign shifted = unshifted >>> distance;

  always_comb begin
    unique case (operation_q)
      hemi_pkg::OpSubtract:           negate = 1'b1;
      hemi_pkg::OpAddIfNegative:      negate = ~negative_q;
      hemi_pkg::OpSubtractIfNegative: negate = negative_q;
      hemi_pkg::OpMirror:             negate = mirror_q;
      default:              negate = 1'b0;
    endcase
    unique case (condition_q)
      hemi_pkg::CondAlways:      execute = issue_q;
      hemi_pkg::CondNegative:    execute = issue_q & negative_q;
      hemi_pkg::CondNotNegative: execute = issue_q & ~negative_q;
      default:         execute = 1'b0;
    endcase
  end

  always_ff @(posedge clk_i) begin
    a_3_q       <= a_i;
    b_3_q       <= shifted[56:1] ^ {56{negate}};
    carry_q     <= (shifted[0] & round_q) ^ negate;
    exclusive_q <= operation_q == hemi_pkg::OpExclusiveOr;
    execute_3_q <= rst_ni & execute;
    emit_3_q    <= emit_2_q;
    sets_3_q    <= sets_2_q;
    tap_3_q     <= tap_2_q;
    dst_3_q     <= dst_2_q;
    mode_3_q    <= mode_2_q;
    event_3_q   <= event_2_q;
    if (!rst_ni) variable_q <= '0;
    else if (issue_q & load_q) variable_q <= b_i[hemi_pkg::ShiftBits-1:0];
  end

  // Sum stage. The lowest bits of the two terms carry into the sum.
  logic [           56:0] sum;
  logic                   unused_carry_in;
  logic [           56:0] sum_q;
  logic                   execute_4_q, emit_4_q;
  logic [hemi_pkg::AddressBits-1:0] dst_4_q;
  logic [   hemi_pkg::ModeBits-1:0] mode_4_q;
  logic [  hemi_pkg::EventBits-1:0] event_4_q;
  logic [    hemi_pkg::TapBits-1:0] tap_4_q;

  assign {sum, unused_carry_in} = {{3{a_3_q[hemi_pkg::WordBits-1]}}, a_3_q, 1'b1} + {b_3_q[55], b_3_q, carry_q};

  always_ff @(posedge clk_i) begin
    sum_q       <= exclusive_q ? {{3{a_3_q[hemi_pkg::WordBits-1]}}, a_3_q} ^ {b_3_q[55], b_3_q} : sum;
    execute_4_q <= rst_ni & execute_3_q;
    emit_4_q    <= emit_3_q;
    dst_4_q     <= dst_3_q;
    mode_4_q    <= mode_3_q;
    event_4_q   <= event_3_q;
    tap_4_q     <= tap_3_q;
    if (!rst_ni) negative_q <= 1'b0;
    else if (execute_3_q & sets_3_q) negative_q <= sum[56];
  end

  // Quantise stage.
  logic saturate, clipped;

  hemi_quantiser i_quantiser (
      .clk_i,
      .sum_i     (sum_q),
      .mode_i    (mode_4_q),
      .word_o    (result_o),
      .saturate_o(saturate),
      .clipped_o (clipped)
  );

  assign negative_o  = negative_q;
  assign write_o     = execute_4_q;
  assign address_o   = dst_4_q;
  assign emit_o      = execute_4_q & emit_4_q;
  assign raise_o     = execute_4_q & (saturate ? clipped : sum_q[56]);
  assign event_o     = event_4_q;
  assign tap_valid_o = execute_4_q & (tap_4_q != '1);
  assign tap_o       = tap_4_q;
  assign busy_o      = issue_q | execute_3_q | execute_4_q;
endmodule
