// Two blocks in the plane whose meshes do not match, in m: 1 x 1 together, the lower one on y = 0, the common side at
// y = 0.5 in the middle and rising along x with the given slope. Quadrilaterals.
// Groups: lower, upper (cells); lower.contact, upper.contact, lower.bottom, upper.top, lower.left, upper.left.
//
// Made with Gmsh 4.15.2 by: gmsh blocks-plane.geo -2 -format msh41 -bin -o flat-plane.msh
//   flat-plane.msh       lower 5 x 3, upper 7 x 4 elements
//   inclined-plane.msh   the same, with -setnumber slope 0.3
DefineConstant[
  slope = 0    // of the common side
];

// A block between the heights at x = 0 and x = 1, with count by layers elements.
Macro OneBlock
  p = newp;
  Point(p) = {0, low_left, 0};
  Point(p + 1) = {1, low_right, 0};
  Point(p + 2) = {1, high_right, 0};
  Point(p + 3) = {0, high_left, 0};
  c = newc;
  Line(c) = {p, p + 1};
  Line(c + 1) = {p + 1, p + 2};
  Line(c + 2) = {p + 2, p + 3};
  Line(c + 3) = {p + 3, p};
  Transfinite Curve{c, c + 2} = count + 1;
  Transfinite Curve{c + 1, c + 3} = layers + 1;
  s = news;
  Curve Loop(s) = {c : c + 3};
  Plane Surface(s) = {s};
  Transfinite Surface{s};
  Recombine Surface{s};
Return

low_left = 0;
low_right = 0;
high_left = 0.5 - slope / 2;
high_right = 0.5 + slope / 2;
count = 5;
layers = 3;
Call OneBlock;
Physical Surface("lower") = {s};
Physical Curve("lower.bottom") = {c};
Physical Curve("lower.contact") = {c + 2};
Physical Curve("lower.left") = {c + 3};

low_left = high_left;
low_right = high_right;
high_left = 1;
high_right = 1;
count = 7;
layers = 4;
Call OneBlock;
Physical Surface("upper") = {s};
Physical Curve("upper.contact") = {c};
Physical Curve("upper.top") = {c + 2};
Physical Curve("upper.left") = {c + 3};
