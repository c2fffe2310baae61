# SPDX-License-Identifier: Apache-2.0
file = results . "/bell.smooth.csv"
set multiplot layout 2,1 title "A ringing resonator through the core: the partial near " . centre_hz . " Hz"
set lmargin 12
set xrange [0:4]
set object 1 rectangle from 0.5,graph 0 to 2.5,graph 1 fillcolor rgb "#f2f5f9" fillstyle solid noborder behind
set label 1 "stretch of the summary" at 0.53,graph 0.06 tc rgb neutral
set ylabel "frequency [Hz]"
set yrange [centre_hz - 4 : centre_hz + 6]
plot file using 1:2 with lines lc rgb pale title "every output", \
     file using 1:3 with lines lw 2 lc rgb after title "averaged over 0.5 s"
set xlabel "time [s]"
set ylabel "amplitude [1 = set point]"
set autoscale y
set logscale y
set format y "10^{%T}"
plot file using 1:4 with lines lc rgb after
unset multiplot
