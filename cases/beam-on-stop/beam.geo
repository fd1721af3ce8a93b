// A mast in the plane, in mm: 1000 high, along y.
// Groups: beam (lines), clamp, tip (its ends).
//
// Made with Gmsh 4.15.2 by: gmsh beam.geo -1 -format msh41 -bin -o beam.msh
DefineConstant[
  n = 40   // elements
];

Point(1) = {0, 0, 0};
Point(2) = {0, 1000, 0};
Line(1) = {1, 2};
Transfinite Curve {1} = n + 1;

Physical Curve("beam") = {1};
Physical Point("clamp") = {1};
Physical Point("tip") = {2};
