# SPDX-License-Identifier: Apache-2.0
# One top of hls/tops/ through Siemens Catapult: native run with ac_fixed, synthesis. NOT RUN HERE: no Catapult was at hand; a
# project to start from. The kernels take ac_fixed by HEMI_FIXED_BACKEND=2 (hls/fixed_ac.hpp). SCVerify, Catapult's
# cosimulation, wants its own macros around a bench's main and call; tests/hls/tops/bench.cpp has none.
#   scripts/build release hls_vectors && build/hls_vectors build/hls/vectors
#   HEMI_TOP=hemi_nco HEMI_SOURCE=front_end catapult -shell -file scripts/templates/catapult.tcl
# HEMI_SOURCE is the file that has the top: front_end, loops, back_end or core. Without both: the reference core.
set top hemi_core_reference
set source core
if {[info exists env(HEMI_TOP)]} { set top $env(HEMI_TOP) }
if {[info exists env(HEMI_SOURCE)]} { set source $env(HEMI_SOURCE) }

set root [pwd]
set vectors $root/build/hls/vectors/$top.vectors
set result $root/build/catapult/$top
file mkdir $root/build/catapult

# Natively, once with the core's own arithmetic and once with ac_fixed: the hashes over all outputs must be equal.
set compile [list c++ -std=c++14 -O2 -I$root -I$env(MGC_HOME)/shared/include -DHEMI_TOP=$top]
foreach backend {0 2} {
  exec {*}$compile -DHEMI_FIXED_BACKEND=$backend tests/hls/tops/bench.cpp hls/tops/$source.cpp -o $result.bench
  exec $result.bench $vectors $result.$backend
}
exec cmp $result.0 $result.2

project new -dir build/catapult -name $top.project
options set Input/CppStandard c++14
options set Input/SearchPath $root
options set Input/CompilerFlags -DHEMI_FIXED_BACKEND=2
options set Output/OutputVHDL false
solution file add $root/hls/tops/$source.cpp -type C++
go analyze
solution design set $top -top
go compile
solution library add mgc_Xilinx-ARTIX-7-1_beh -- -rtlsyntool Vivado -manufacturer Xilinx -family ARTIX-7 -speed -1 -part xc7a35tcsg324-1
solution library add Xilinx_RAMS
solution library add Xilinx_ROMS
go libraries
directive set -CLOCKS {clk {-CLOCK_PERIOD 10.0}}
go assembly
go extract
project save
