# SPDX-License-Identifier: Apache-2.0
# hemi_axi on a Xilinx 7-series part, out of context. NOT RUN HERE: no Vivado was at hand; a template to start from.
#   scripts/build release && vivado -mode batch -source scripts/templates/vivado.tcl
set part xc7a35tcsg324-1
set generated build/rtl/reference
set output build/vivado
file mkdir $output

# Packages go first: the others name their constants.
read_verilog -sv $generated/hemi_pkg.sv
read_verilog -sv rtl/axi/hemi_axi_pkg.sv
foreach pattern [list $generated/*.sv rtl/axi/*.sv rtl/*.sv] {
  foreach source [glob $pattern] {
    if {![string match *_pkg.sv $source]} { read_verilog -sv $source }
  }
}
read_xdc scripts/templates/hemi_axi.xdc

synth_design -top hemi_axi -part $part -mode out_of_context
opt_design
place_design
route_design
report_utilization -hierarchical -file $output/utilization.txt
report_timing_summary -file $output/timing.txt
write_checkpoint -force $output/hemi_axi.dcp
