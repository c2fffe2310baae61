# SPDX-License-Identifier: Apache-2.0
# The look of every plot: set before each script; `output` and `results` come from the command line.
set terminal svg size 960,640 font "sans-serif,14" background rgb "white" linewidth 1.2
set output output
set datafile separator ","
set datafile missing "nan"
set border 3 lw 0.8 lc rgb "#555555"
set tics nomirror out scale 0.6
set grid lc rgb "#dddddd" lt 1 lw 0.6
set key noautotitle top right samplen 2 noopaque
before = "#c44e52"
after = "#2a6fb0"
pale = "#a9c6e3"
neutral = "#555555"
