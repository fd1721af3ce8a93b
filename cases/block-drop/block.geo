// A cube of 1 m on the plane z = 0. Hexahedra.
// Groups: block (cells), block.bottom (z = 0).
//
// Made with Gmsh 4.15.2 by: gmsh block.geo -3 -format msh41 -bin -o block.msh
//   block.msh   8 x 8 x 8 elements; the size of the benchmark: -setnumber n 32
DefineConstant[
  n = 8    // elements along each side
];
side = 1;
Point(1) = {0, 0, 0};
row[] = Extrude {side, 0, 0} { Point{1}; Layers{n}; };
face[] = Extrude {0, side, 0} { Curve{row[1]}; Layers{n}; Recombine; };
cube[] = Extrude {0, 0, side} { Surface{face[1]}; Layers{n}; Recombine; };
Physical Volume("block") = {cube[1]};
Physical Surface("block.bottom") = {face[1]};
