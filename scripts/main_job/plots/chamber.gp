# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1200,640 font "sans-serif,14" background rgb "white" linewidth 1.2
set multiplot layout 2,3 title "Synthetic chamber runs, averages over 100 s"
runs = "cool cycle warm"
titles = "'cool (fitted)' 'cycle (unseen)' 'warm (unseen)'"
file(i) = results . "/chamber." . word(runs, i) . ".averages.csv"
set xlabel "time [h]"
set xrange [0:5]
set xtics 1
set ylabel "housing [degC]"
set yrange [-25:45]
do for [i = 1:3] {
  set title word(titles, i)
  plot file(i) using ($1 / 3600):2 with lines lw 2 lc rgb neutral
}
unset title
set ylabel "rate [deg/h]"
set yrange [-6:14]
do for [i = 1:3] {
  plot file(i) using ($1 / 3600):3 with lines lw 2 lc rgb before title "before", \
       file(i) using ($1 / 3600):4 with lines lw 2 lc rgb after title "compensated"
}
unset multiplot
