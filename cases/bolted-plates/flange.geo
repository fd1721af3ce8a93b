// Half the section of a bolt of 12 mm through two plates with a hole of 13 mm, over the radius r and the height z. Quadrilaterals.
// Groups: bolt, section (the cells of the shank from 9 to 15 mm), lower, upper (cells); bolt.nut, bolt.under, bolt.top, lower.bottom, lower.top, upper.bottom,
// upper.top. The bodies share no nodes.
//
// Made with Gmsh 4.15.2 by: gmsh flange.geo -2 -format msh41 -bin -o flange.msh
DefineConstant[
  n = 1  // elements per millimetre
];
radius = 6;
head = 9;
hole = 6.5;
outer = 25;
Function Rectangle_
  Point(p + 1) = {r0, z0, 0};
  Point(p + 2) = {r1, z0, 0};
  Point(p + 3) = {r1, z1, 0};
  Point(p + 4) = {r0, z1, 0};
  Line(p + 1) = {p + 1, p + 2};
  Line(p + 2) = {p + 2, p + 3};
  Line(p + 3) = {p + 3, p + 4};
  Line(p + 4) = {p + 4, p + 1};
  Transfinite Curve {p + 1, p + 3} = Ceil(n * (r1 - r0)) + 1;
  Transfinite Curve {p + 2, p + 4} = Ceil(n * (z1 - z0)) + 1;
  Curve Loop(p + 1) = {p + 1, p + 2, p + 3, p + 4};
  Plane Surface(p + 1) = {p + 1};
  Transfinite Surface {p + 1};
  Recombine Surface {p + 1};
Return
r0 = 0; r1 = radius;
p = 0; z0 = 0; z1 = 9; Call Rectangle_;
p = 10; z0 = 9; z1 = 15; Call Rectangle_;
p = 20; z0 = 15; z1 = 24; Call Rectangle_;
p = 30; z0 = 24; z1 = 32; Call Rectangle_;
r0 = radius; r1 = head;
p = 40; Call Rectangle_;
Coherence;
r0 = hole; r1 = outer;
p = 50; z0 = 0; z1 = 12; Call Rectangle_;
p = 60; z0 = 12; z1 = 24; Call Rectangle_;
Physical Surface("bolt") = {1, 11, 21, 31, 41};
Physical Surface("section") = {11};
Physical Surface("lower") = {51};
Physical Surface("upper") = {61};
Physical Curve("bolt.nut") = {1};
Physical Curve("bolt.under") = {41};
Physical Curve("bolt.top") = {33, 43};
Physical Curve("lower.bottom") = {51};
Physical Curve("lower.top") = {53};
Physical Curve("upper.bottom") = {61};
Physical Curve("upper.top") = {63};
