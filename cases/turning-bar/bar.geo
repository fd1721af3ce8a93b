// A free bar in the plane, in m, along x: the part that is a solid, 0.6 x 0.1, quadrilaterals, and the axis of the part that is a beam, from 0.4 to 1.
// Groups: solid (cells), solid.left (its free end), beam (lines), beam.right (its free end).
//
// Made with Gmsh 4.15.2 by: gmsh bar.geo -2 -format msh41 -bin -o bar.msh
//   bar.msh   12 x 2 elements and 6 lines
DefineConstant[
  along = 12     // elements along the solid
  across = 2     // elements over its height
  lines = 6      // elements of the beam
];
height = 0.1;
Point(1) = {0, -height / 2, 0};
side[] = Extrude {0.6, 0, 0} { Point{1}; Layers{along}; };
solid[] = Extrude {0, height, 0} { Curve{side[1]}; Layers{across}; Recombine; };
Point(11) = {0.4, 0, 0};
axis[] = Extrude {0.6, 0, 0} { Point{11}; Layers{lines}; };
Physical Surface("solid") = {solid[1]};
Physical Curve("solid.left") = {solid[3]};
Physical Curve("beam") = {axis[1]};
Physical Point("beam.right") = {axis[0]};
