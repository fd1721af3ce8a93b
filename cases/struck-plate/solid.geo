// A quarter of the middle of a plate: 35 mm x 35 mm x 14 mm, upper face z = 0, struck at the origin. Hexahedra of 20 nodes, 13 x 13 x 5, of 0.6 mm at the origin.
// Groups: cells; struck (the upper face within 10 mm), x-cut, y-cut (faces).
//
// Made with Gmsh 4.15.2 by: gmsh solid.geo -3 -order 2 -setnumber Mesh.SecondOrderIncomplete 1 -format msh41 -bin -o solid.msh
inner = 10; half = 35; thick = 14;
near = 8; far = 5; fine = 1.2; coarse = 1.33;   // cells along both parts of a side, and how they grow
at[] = {0, inner, half};
For j In {0:2}
  For i In {0:2}
    Point(1 + i + 3 * j) = {at[i], at[j], -thick};
  EndFor
EndFor
For j In {0:2}
  Line(1 + 2 * j) = {1 + 3 * j, 2 + 3 * j};
  Line(2 + 2 * j) = {2 + 3 * j, 3 + 3 * j};
  Line(7 + 2 * j) = {1 + j, 4 + j};
  Line(8 + 2 * j) = {4 + j, 7 + j};
EndFor
Transfinite Curve {1, 3, 5, 7, 9, 11} = near + 1 Using Progression fine;
Transfinite Curve {2, 4, 6, 8, 10, 12} = far + 1 Using Progression coarse;
Curve Loop(1) = {1, 9, -3, -7};
Curve Loop(2) = {2, 11, -4, -9};
Curve Loop(3) = {3, 10, -5, -8};
Curve Loop(4) = {4, 12, -6, -10};
tops[] = {}; cells[] = {}; all[] = {};
For k In {1:4}
  Plane Surface(k) = {k};
  Transfinite Surface {k};
  Recombine Surface {k};
EndFor
For k In {1:4}
  out[] = Extrude {0, 0, thick} { Surface{k}; Layers{{1, 1, 1, 1, 1}, {0.32, 0.58, 0.79, 0.92, 1}}; Recombine; };
  tops[] += out[0];
  cells[] += out[1];
  all[] += {out[2], out[5]};
EndFor
Physical Volume("cells") = cells[];
Physical Surface("struck") = {tops[0]};
Physical Surface("y-cut") = {all[0], all[2]};
Physical Surface("x-cut") = {all[1], all[5]};
