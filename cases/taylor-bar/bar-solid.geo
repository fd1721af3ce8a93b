// Taylor's bar in space, a quarter of it, in mm: a cylinder of radius 3.2 about z, its foot in z = 0, length 32.4.
// Hexahedra: a square core inside a ring that becomes round, smaller towards the foot.
// Groups: bar (cells), bar.foot, bar.top, bar.side, bar.mirror-x (in x = 0), bar.mirror-y (in y = 0).
//
// Made with Gmsh 4.15.2 by: gmsh bar-solid.geo -3 -format msh41 -bin -o bar-solid.msh
//   bar-solid.msh          48 x 40 elements
//   bar-solid-coarse.msh   12 x 20, with -setnumber core 2 -setnumber ring 2 -setnumber along 20
DefineConstant[
  core = 4      // elements along each side of the core
  ring = 4      // elements from the core to the side
  along = 40    // elements along the axis
];
radius = 3.2;
length = 32.4;
ratio = 4;      // height of the last element over that of the first
growth = ratio^(1 / (along - 1));

// Heights of the layers' upper ends, as parts of the length.
part = (growth - 1) / (growth^along - 1);
height = 0;
For i In {0 : along - 1}
  height += part * growth^i;
  ends[i] = height;
  ones[i] = 1;
EndFor
ends[along - 1] = 1;

edge = 0.5 * radius;
corner = 0.42 * radius;
round = radius / Sqrt(2);
Point(1) = {0, 0, 0};
Point(2) = {edge, 0, 0};
Point(3) = {corner, corner, 0};
Point(4) = {0, edge, 0};
Point(5) = {radius, 0, 0};
Point(6) = {round, round, 0};
Point(7) = {0, radius, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {4, 3};
Line(4) = {1, 4};
Circle(5) = {5, 1, 6};
Circle(6) = {7, 1, 6};
Transfinite Curve{1 : 6} = core + 1;
Line(7) = {2, 5};
Line(8) = {3, 6};
Line(9) = {4, 7};
Transfinite Curve{7 : 9} = ring + 1;
Curve Loop(1) = {1, 2, -3, -4};  Plane Surface(1) = {1};
Curve Loop(2) = {7, 5, -8, -2};  Plane Surface(2) = {2};
Curve Loop(3) = {3, 8, -6, -9};  Plane Surface(3) = {3};
Transfinite Surface{1 : 3};
Recombine Surface{1 : 3};

inside[] = Extrude {0, 0, length} { Surface{1}; Layers{ones[], ends[]}; Recombine; };
right[] = Extrude {0, 0, length} { Surface{2}; Layers{ones[], ends[]}; Recombine; };
left[] = Extrude {0, 0, length} { Surface{3}; Layers{ones[], ends[]}; Recombine; };
// An extrusion returns its far end, its volume, then the sides in the order of the loop.
Physical Volume("bar") = {inside[1], right[1], left[1]};
Physical Surface("bar.foot") = {1, 2, 3};
Physical Surface("bar.top") = {inside[0], right[0], left[0]};
Physical Surface("bar.side") = {right[3], left[4]};
Physical Surface("bar.mirror-x") = {inside[5], left[5]};
Physical Surface("bar.mirror-y") = {inside[2], right[2]};
