// A free bar in the plane, in m: 1 x 0.1 about the origin, along x. Quadrilaterals.
// Groups: bar (cells), bar.left, bar.right (ends).
//
// Made with Gmsh 4.15.2 by: gmsh bar-plane.geo -2 -format msh41 -bin -o bar-plane.msh
//   bar-plane.msh   20 x 2 elements
DefineConstant[
  along = 20     // elements along the bar
  across = 2     // elements over its height
];
length = 1;
height = 0.1;
Point(1) = {-length / 2, -height / 2, 0};
side[] = Extrude {length, 0, 0} { Point{1}; Layers{along}; };
bar[] = Extrude {0, height, 0} { Curve{side[1]}; Layers{across}; Recombine; };
Physical Surface("bar") = {bar[1]};
Physical Curve("bar.right") = {bar[2]};
Physical Curve("bar.left") = {bar[3]};
