# SPDX-License-Identifier: Apache-2.0
# hemi_pins (the bare core behind five pins) on the iCE40 UP5K. NOT RUN HERE: no Radiant was at hand; a template.
#   scripts/build release && radiantc scripts/templates/radiant.tcl
set root [pwd]
set generated $root/build/rtl/reference
file mkdir build/radiant
prj_create -name hemi -dir $root/build/radiant -impl up5k -dev iCE40UP5K-SG48I -performance "High-Performance_1.2V" -synthesis "lse"

# The package goes first: the others name its constants.
prj_add_source $generated/hemi_pkg.sv
foreach pattern [list $generated/*.sv $root/rtl/*.sv $root/scripts/templates/hemi_pins.sv] {
  foreach source [glob $pattern] {
    if {![string match *_pkg.sv $source]} { prj_add_source $source }
  }
}
prj_add_source $root/scripts/templates/hemi_pins.sdc
prj_set_impl_opt -impl up5k top hemi_pins
prj_save
prj_run Synthesis -impl up5k
prj_run Map -impl up5k
prj_run PAR -impl up5k
prj_close
