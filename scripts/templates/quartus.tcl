# SPDX-License-Identifier: Apache-2.0
# hemi_axi on an Intel Cyclone 10 LP. NOT RUN HERE: no Quartus was at hand; a template to start from.
#   scripts/build release && quartus_sh -t scripts/templates/quartus.tcl
load_package flow
set generated build/rtl/reference
project_new -overwrite hemi_axi
set_global_assignment -name FAMILY "Cyclone 10 LP"
set_global_assignment -name DEVICE 10CL025YU256C8G
set_global_assignment -name TOP_LEVEL_ENTITY hemi_axi
set_global_assignment -name PROJECT_OUTPUT_DIRECTORY build/quartus
set_global_assignment -name SDC_FILE scripts/templates/hemi_axi.sdc

# Packages go first: the others name their constants.
set_global_assignment -name SYSTEMVERILOG_FILE $generated/hemi_pkg.sv
set_global_assignment -name SYSTEMVERILOG_FILE rtl/axi/hemi_axi_pkg.sv
foreach pattern [list $generated/*.sv rtl/axi/*.sv rtl/*.sv] {
  foreach source [glob $pattern] {
    if {![string match *_pkg.sv $source]} { set_global_assignment -name SYSTEMVERILOG_FILE $source }
  }
}
# The core is one block of a larger design: all ports but the clock are virtual.
set_instance_assignment -name VIRTUAL_PIN ON -to *
set_instance_assignment -name VIRTUAL_PIN OFF -to aclk
execute_flow -compile
project_close
