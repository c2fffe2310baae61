# SPDX-License-Identifier: Apache-2.0
set terminal svg size 960,900 font "sans-serif,14" background rgb "white" linewidth 1.2
set multiplot layout 3,1 title "MEMS gyro at rest over a chamber cycle, averages over 20 samples"
set lmargin 11
set xrange [0:8400]
set offsets 0, 0, graph 0.35, 0
set arrow 1 from split,graph 0 to split,graph 1 nohead dt 2 lc rgb neutral
set label 1 "fitted" at split,graph 0.06 right offset -1,0 tc rgb neutral
set label 2 "unseen" at split,graph 0.06 left offset 1,0 tc rgb neutral
set key top left Left reverse horizontal
do for [axis in "x y z"] {
  if (axis eq "z") { set xlabel "sample" }
  set ylabel "rate, axis " . axis . " [deg/s]"
  file = results . "/mems." . axis . ".averages.csv"
  plot file using 1:2 with lines lw 2 lc rgb before title "before, less its mean over the fitted part", \
       file using 1:3 with lines lw 2 lc rgb after title "compensated"
}
unset multiplot
