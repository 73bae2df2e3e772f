%
(Tool changes: a plate with a milled edge and a hole. The first change makes the magazine look for its home.)
(T12 is called while tool 1 still cuts; from pocket 1 to 12 the shortest way is one pocket backwards.)
N10 G21 G90 G17 G94 G40 G49 G80
N20 T1 M6 (end mill)
N30 S1200 M3
N40 G0 X20 Y10 Z-30 M8
N50 G1 X35 F1500
N60 T12 (drill, left-hand)
N70 G3 X45 Y20 R10
N80 G0 Z0 M9
N90 M19
N100 M6
N110 S1500 M4
N120 G0 X30 Y20 Z-25 M7
N130 G1 Z-32 F1200
N140 G4 P0.2
N150 G0 Z0 M9
N160 M5
N170 M30
%
