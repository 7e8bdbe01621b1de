# The learning curve: data, picture, object and seeds come from the command line.
set terminal svg size 900,540 font "Helvetica,Arial,sans-serif,15" background "#ffffff" enhanced
set output picture
set encoding utf8
set border 3 lc rgb "#555555"
set tics nomirror out tc rgb "#333333"
set grid y lc rgb "#e6e6e6" lt 1
interval = seeds > 1 ? " with 95% confidence" : ""
set title "Finding the structure of ".object."\nlines: mean of five trials".interval. \
    "; dots: of one trial; ".seeds.(seeds > 1 ? " seeds" : " seed") noenhanced tc rgb "#222222"
set xlabel "trial" tc rgb "#222222"
set ylabel "pushes until the structure is known" tc rgb "#222222"
set key outside bottom center horizontal samplen 2 width 2 tc rgb "#222222"
set yrange [0:*]
set style fill transparent solid 0.18 noborder
plot data using 1:8:9 with filledcurves lc rgb "#d1661b" notitle, \
     data using 1:12:13 with filledcurves lc rgb "#8c8c8c" notitle, \
     data using 1:4:5 with filledcurves lc rgb "#1666a8" notitle, \
     data using 1:6 with points pt 7 ps 0.45 lc rgb "#d1661b" notitle, \
     data using 1:10 with points pt 7 ps 0.45 lc rgb "#8c8c8c" notitle, \
     data using 1:2 with points pt 7 ps 0.45 lc rgb "#1666a8" notitle, \
     data using 1:7 with lines lw 2.5 lc rgb "#d1661b" title "random", \
     data using 1:11 with lines lw 2.5 lc rgb "#8c8c8c" title "learned as in the paper", \
     data using 1:3 with lines lw 2.5 lc rgb "#1666a8" title "learned"
