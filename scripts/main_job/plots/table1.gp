# SPDX-License-Identifier: Apache-2.0
file = results . "/table1.residuals.csv"
set title "Table 1 of the paper less the fitted f(T)"
set xlabel "settled temperature [degC]"
set ylabel "residual [mHz]"
set xrange [-25:45]
set yrange [-35:35]
set object 1 rectangle from graph 0,first -5 to graph 1,first 5 fillcolor rgb "#eeeeee" fillstyle solid noborder behind
set label 1 "rounding of the table, +-5 mHz" at 23,-3.4 tc rgb neutral
plot file using 1:2 with linespoints pt 7 ps 0.8 lc rgb before title "cubic (the paper's Eq. 18)", \
     file using 1:3 with linespoints pt 7 ps 0.8 lc rgb after title chosen . " (chosen)"
