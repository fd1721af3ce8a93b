// The middle surface of the walls of a closed box of 200 x 140 x 80 mm, in m; quadrilaterals of 10 mm with normals outward.
// Group: walls (the cells).
//
// Made with Gmsh 4.15.2 by: gmsh box.geo -2 -format msh41 -bin -o box.msh
SetFactory("OpenCASCADE");
DefineConstant[
  size = 0.01     // length of a cell
];
Box(1) = {0, 0, 0, 0.2, 0.14, 0.08};
lines() = Boundary{ Surface{1:6}; };
For i In {1 : 12}
  bounds() = BoundingBox Curve{i};
  length = (bounds(3) - bounds(0)) + (bounds(4) - bounds(1)) + (bounds(5) - bounds(2));
  Transfinite Curve{i} = Round(length / size) + 1;
EndFor
Transfinite Surface{1:6};
Recombine Surface{1:6};
Physical Surface("walls") = {1:6};
