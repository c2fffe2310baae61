# SPDX-License-Identifier: Apache-2.0
file = results . "/bell.smooth.csv"
set multiplot layout 2,1 title "A struck bell through the core: the partial near " . centre_hz . " Hz"
set xrange [0:4]
set xlabel "time [s]"
set object 1 rectangle from 0.5,graph 0 to 2.5,graph 1 fillcolor rgb "#f2f5f9" fillstyle solid noborder behind
set ylabel "frequency [Hz]"
set yrange [centre_hz - 4 : centre_hz + 4]
plot file using 1:2 with lines lc rgb pale title "200 Hz-type output: beats with its twin partial", \
     file using 1:3 with lines lw 2 lc rgb after title "averaged over 0.5 s"
set ylabel "amplitude [1 = set point]"
set yrange [1e-4:0.1]
set logscale y
set format y "10^{%T}"
plot file using 1:4 with lines lc rgb after
unset multiplot
