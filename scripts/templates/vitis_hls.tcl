# SPDX-License-Identifier: Apache-2.0
# One top of hls/tops/ through AMD Vitis HLS: native run, synthesis, cosimulation. NOT RUN HERE: no Vitis was at hand;
# a project to start from. The kernels take AMD's ap_fixed by HEMI_FIXED_BACKEND=1 (hls/fixed_ap.hpp).
#   scripts/build release hls_vectors && build/hls_vectors build/hls/vectors
#   HEMI_TOP=hemi_nco HEMI_SOURCE=front_end vitis_hls -f scripts/templates/vitis_hls.tcl
# HEMI_SOURCE is the file that has the top: front_end, loops, back_end or core. Without both: the reference core.
set top hemi_core_reference
set source core
if {[info exists env(HEMI_TOP)]} { set top $env(HEMI_TOP) }
if {[info exists env(HEMI_SOURCE)]} { set source $env(HEMI_SOURCE) }

set root [pwd]
set flags "-std=c++14 -I$root -DHEMI_FIXED_BACKEND=1"
set vectors $root/build/hls/vectors/$top.vectors
set result $root/build/vitis_hls/$top
file mkdir $root/build/vitis_hls

open_project -reset build/vitis_hls/$top.project
set_top $top
add_files hls/tops/$source.cpp -cflags $flags
add_files -tb tests/hls/tops/bench.cpp -cflags "$flags -DHEMI_TOP=$top"
open_solution -reset solution
set_part xc7a35tcsg324-1
create_clock -period 10

csim_design -argv "$vectors $result.native"
csynth_design
# The simulated Verilog counts as right when its outputs hash to what the native run's do.
cosim_design -rtl verilog -argv "$vectors $result.verilog"
foreach kind {native verilog} {
  set file [open $result.$kind]
  set $kind [read $file]
  close $file
}
if {$native ne $verilog} { error "$top: the outputs differ from the native run's: $result.native, $result.verilog" }
puts "$top: equal to the native run\n$native"
exit
