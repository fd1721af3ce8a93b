// A bar in the plane, in mm: 100 x 20, turned so that it meets the wall y = 0 with a corner, which is at the origin.
// Quadrilaterals.
// Groups: bar (cells), bar.surface (all four sides), bar.front (the end at the wall), bar.back, bar.lower, bar.upper.
//
// Made with Gmsh 4.15.2 by: gmsh bar.geo -2 -format msh41 -bin -o bar.msh
//   bar.msh          50 x 10 elements
//   bar-coarse.msh   20 x  4, with -setnumber n 2
DefineConstant[
  n = 5         // refinement
  angle = 60    // between the bar and the wall, in degrees
];
length = 100;
height = 20;
turn = angle * Pi / 180;

Point(1) = {0, 0, 0};
side[] = Extrude {length * Cos(turn), length * Sin(turn), 0} { Point{1}; Layers{10 * n}; };
bar[] = Extrude {-height * Sin(turn), height * Cos(turn), 0} { Curve{side[1]}; Layers{2 * n}; Recombine; };
Physical Surface("bar") = {bar[1]};
Physical Curve("bar.surface") = {side[1], bar[0], bar[2], bar[3]};
Physical Curve("bar.lower") = {side[1]};
Physical Curve("bar.upper") = {bar[0]};
Physical Curve("bar.back") = {bar[2]};
Physical Curve("bar.front") = {bar[3]};
