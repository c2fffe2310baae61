// SPDX-License-Identifier: Apache-2.0

/// Reads registers.mem and prints its words, and those of the exported package, in hex.
module register_image_bench;
  localparam int Registers = hemi_register_image_pkg::Registers;
  localparam int WordBits = hemi_register_image_pkg::WordBits;

  logic [WordBits-1:0] words[0:Registers-1];

  initial begin
    $readmemh("registers.mem", words);
    for (int i = 0; i < Registers; i = i + 1)
      $display("%h %h", words[i], hemi_register_image_pkg::Image[WordBits*i+:WordBits]);
  end
endmodule
