// Two blocks in space whose meshes do not match, in m: 1 x 1 x 1 together, the lower one on z = 0, the common face at
// z = 0.5 in the middle and rising along x and, half as much, along y with the given slope. Hexahedra.
// Groups: lower, upper (cells); lower.contact, upper.contact, lower.bottom, upper.top, and for each block
// .left (x = 0) and .front (y = 0).
//
// Made with Gmsh 4.15.2 by: gmsh blocks-solid.geo -3 -format msh41 -bin -o flat-solid.msh
//   flat-solid.msh       lower 3 x 3 x 2, upper 4 x 5 x 2 elements
//   inclined-solid.msh   the same, with -setnumber slope 0.3
DefineConstant[
  slope = 0    // of the common face along x
];
x[] = {0, 1, 1, 0};
y[] = {0, 0, 1, 1};

// A block between the heights low[] and high[] of its four columns.
Macro OneBlock
  p = newp;
  For i In {0 : 3}
    Point(p + i) = {x[i], y[i], low[i]};
    Point(p + 4 + i) = {x[i], y[i], high[i]};
  EndFor
  c = newc;
  For i In {0 : 3}
    Line(c + i) = {p + i, p + (i + 1) % 4};
    Line(c + 4 + i) = {p + 4 + i, p + 4 + (i + 1) % 4};
    Line(c + 8 + i) = {p + i, p + 4 + i};
  EndFor
  Transfinite Curve{c, c + 2, c + 4, c + 6} = along_x + 1;
  Transfinite Curve{c + 1, c + 3, c + 5, c + 7} = along_y + 1;
  Transfinite Curve{c + 8 : c + 11} = layers + 1;
  // Faces: 0 bottom, 1 top, 2 to 5 the sides y = 0, x = 1, y = 1, x = 0.
  f = news;
  Curve Loop(f) = {c : c + 3};
  Curve Loop(f + 1) = {c + 4 : c + 7};
  For i In {0 : 3}
    Curve Loop(f + 2 + i) = {c + i, c + 8 + (i + 1) % 4, -(c + 4 + i), -(c + 8 + i)};
  EndFor
  For i In {0 : 5}
    Plane Surface(f + i) = {f + i};
  EndFor
  Transfinite Surface{f : f + 5};
  Recombine Surface{f : f + 5};
  v = newv;
  Surface Loop(v) = {f : f + 5};
  Volume(v) = {v};
  Transfinite Volume{v};
Return

For i In {0 : 3}
  low[i] = 0;
  high[i] = 0.5 + slope * (x[i] - 0.5) + slope / 2 * (y[i] - 0.5);
EndFor
along_x = 3;
along_y = 3;
layers = 2;
Call OneBlock;
Physical Volume("lower") = {v};
Physical Surface("lower.bottom") = {f};
Physical Surface("lower.contact") = {f + 1};
Physical Surface("lower.front") = {f + 2};
Physical Surface("lower.left") = {f + 5};

For i In {0 : 3}
  low[i] = high[i];
  high[i] = 1;
EndFor
along_x = 4;
along_y = 5;
layers = 2;
Call OneBlock;
Physical Volume("upper") = {v};
Physical Surface("upper.contact") = {f};
Physical Surface("upper.top") = {f + 1};
Physical Surface("upper.front") = {f + 2};
Physical Surface("upper.left") = {f + 5};
