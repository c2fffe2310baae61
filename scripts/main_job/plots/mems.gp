# SPDX-License-Identifier: Apache-2.0
set terminal svg size 960,900 font "sans-serif,14" background rgb "white" linewidth 1.2
set multiplot layout 3,1 title "MEMS gyro at rest over a chamber cycle, averages over 20 samples"
set xrange [0:8400]
set ylabel "rate [deg/s]"
set arrow 1 from split,graph 0 to split,graph 1 nohead dt 2 lc rgb neutral
set label 1 "fitted " at split,graph 0.93 right tc rgb neutral
set label 2 " unseen" at split,graph 0.93 left tc rgb neutral
set key bottom left
do for [axis in "x y z"] {
  if (axis eq "z") { set xlabel "sample" }
  set title "axis " . axis
  file = results . "/mems." . axis . ".averages.csv"
  plot file using 1:2 with lines lw 2 lc rgb before title "before, less its mean over the fitted part", \
       file using 1:3 with lines lw 2 lc rgb after title "compensated"
}
unset multiplot
