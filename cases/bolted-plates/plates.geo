// Two plates of 60 mm by 12 mm, one on the other, and the axis of a bolt through both. Quadrilaterals.
// Groups: lower, upper (cells), shank (elements of the axis); lower.bottom, lower.top, upper.bottom, upper.top; shank.left, shank.right (its foot
// and head). The plates share no nodes with each other nor with the bolt.
//
// Made with Gmsh 4.15.2 by: gmsh plates.geo -2 -format msh41 -bin -o plates.msh
DefineConstant[
  nx = 10,  // elements along the plates
  ny = 2,   // through each
  ns = 4    // along the bolt
];
length = 60;
height = 12;
For k In {0:1}
  p = 10 * k;
  Point(p + 1) = {-length / 2, k * height, 0};
  Point(p + 2) = {length / 2, k * height, 0};
  Point(p + 3) = {length / 2, (k + 1) * height, 0};
  Point(p + 4) = {-length / 2, (k + 1) * height, 0};
  Line(p + 1) = {p + 1, p + 2};
  Line(p + 2) = {p + 2, p + 3};
  Line(p + 3) = {p + 3, p + 4};
  Line(p + 4) = {p + 4, p + 1};
  Transfinite Curve {p + 1, p + 3} = nx + 1;
  Transfinite Curve {p + 2, p + 4} = ny + 1;
  Curve Loop(p + 1) = {p + 1, p + 2, p + 3, p + 4};
  Plane Surface(p + 1) = {p + 1};
  Transfinite Surface {p + 1};
  Recombine Surface {p + 1};
EndFor
Point(21) = {0, 0, 0};
Point(22) = {0, 2 * height, 0};
Line(21) = {21, 22};
Transfinite Curve {21} = ns + 1;
Physical Surface("lower") = {1};
Physical Surface("upper") = {11};
Physical Curve("lower.bottom") = {1};
Physical Curve("lower.top") = {3};
Physical Curve("upper.bottom") = {11};
Physical Curve("upper.top") = {13};
Physical Curve("shank") = {21};
Physical Point("shank.left") = {21};
Physical Point("shank.right") = {22};
