// SPDX-License-Identifier: Apache-2.0

/// DAC words as a stream without loss: at most two samples are on their way through the core or waiting, and only a
/// beat that was taken makes room for another. One beat waits here, the second on the core's ports, which hold their
/// words until the next push. A sink that is always ready never stops a sample.
/// Area on the iCE40 UP5K (docs/fpga.md): 8 LUT4, 68 flip-flops; 92 MHz between registers.
module hemi_axi_dac (
    input  logic                                    clk_i,     // clock
    input  logic                                    rst_ni,    // synchronous reset, active low
    input  logic                                    sample_i,  // the core takes an ADC sample
    output logic                                    room_o,    // it may take one
    input  logic                                    push_i,    // the words of one sample are complete
    input  logic [4*hemi_axi_pkg::DacLaneBits-1:0] words_i,
    output logic                                    tvalid_o,  // AXI4-Stream
    input  logic                                    tready_i,
    output logic [4*hemi_axi_pkg::DacLaneBits-1:0] tdata_o
);
  logic [1:0] outstanding_q;
  logic second_valid_q, pop;

  assign pop    = tvalid_o & tready_i;
  assign room_o = ~outstanding_q[1];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      outstanding_q  <= '0;
      tvalid_o       <= 1'b0;
      second_valid_q <= 1'b0;
      tdata_o        <= '0;
    end else begin
      outstanding_q <= outstanding_q + 2'(sample_i) - 2'(pop);
      if (~tvalid_o | pop) begin
        tvalid_o       <= second_valid_q | push_i;
        tdata_o        <= words_i;
        second_valid_q <= 1'b0;  // two are the most there are: no push meets a second word
      end else if (push_i) begin
        second_valid_q <= 1'b1;
      end
    end
  end
endmodule
