// The section of a tube above the wall y = 0, in m: outer radius 1, thickness 0.1, 0.05 above the wall.
// Quadrilaterals along the radius and round, the same on the left and on the right.
// Groups: tube (cells), tube.outer, tube.inner, tube.surface (both).
//
// Made with Gmsh 4.15.2 by: gmsh tube.geo -2 -format msh41 -bin -o tube.msh
//   tube.msh          2 x 96 elements
//   tube-coarse.msh   2 x 48, with -setnumber round 48
DefineConstant[
  across = 2    // elements through the thickness
  round = 96    // elements round the tube, a multiple of 4
];
radius = 1;
thickness = 0.1;
above = 0.05;

Point(1) = {0, above + thickness, 0};
wall[] = Extrude {0, -thickness, 0} { Point{1}; Layers{across}; };
end = wall[1];
cells[] = {};
outer[] = {};
inner[] = {};
For i In {1 : 4}
  quarter[] = Extrude { {0, 0, 1}, {0, radius + above, 0}, Pi / 2 } { Curve{end}; Layers{round / 4}; Recombine; };
  end = quarter[0];
  cells[] += {quarter[1]};
  outer[] += {quarter[2]};
  inner[] += {quarter[3]};
EndFor
Physical Surface("tube") = {cells[]};
Physical Curve("tube.outer") = {outer[]};
Physical Curve("tube.inner") = {inner[]};
Physical Curve("tube.surface") = {outer[], inner[]};
