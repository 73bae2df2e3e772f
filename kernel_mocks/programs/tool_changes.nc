%
(Tool changes: a plate with a milled edge, two drilled holes and a tapped look at the spindle's other direction.)
(Tools 2, 12 and 3: from pocket 2 to 12 the shortest way goes backwards, from 12 to 3 forwards past pocket 1.)
N10 G21 G90 G17 G94 G40 G49 G80
N20 T2 M6 (end mill)
N30 S1200 M3
N40 G0 X20 Y10 Z-30 M8
N50 G1 X45 F1500
N60 G3 X55 Y20 R10
N70 G1 Y30 M9
N80 G0 Z0 M19
N90 T12 M6 (drill)
N100 S2000 M3
N110 G0 X30 Y20 M7
N120 G0 Z-25
N130 G1 Z-32 F900
N140 G0 Z-25
N150 G4 P0.3
N160 G0 Z0 M9
N170 M5
N180 T3 M6 (left-hand countersink)
N190 S800 M4
N200 G0 X40 Z-28 M8
N210 G1 Z-30 F600
N220 G0 Z0 M9
N230 M5
N240 M30
%
