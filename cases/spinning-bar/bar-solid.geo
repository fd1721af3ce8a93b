// A free bar in space, in m: 1 x 0.1 x 0.1 about the origin, along x. Hexahedra.
// Groups: bar (cells), bar.left, bar.right (ends).
//
// Made with Gmsh 4.15.2 by: gmsh bar-solid.geo -3 -format msh41 -bin -o bar-solid.msh
//   bar-solid.msh   10 x 2 x 2 elements
DefineConstant[
  along = 10     // elements along the bar
  across = 2     // elements over each side of its section
];
length = 1;
side = 0.1;
Point(1) = {-length / 2, -side / 2, -side / 2};
edge[] = Extrude {0, side, 0} { Point{1}; Layers{across}; };
face[] = Extrude {0, 0, side} { Curve{edge[1]}; Layers{across}; Recombine; };
bar[] = Extrude {length, 0, 0} { Surface{face[1]}; Layers{along}; Recombine; };
Physical Volume("bar") = {bar[1]};
Physical Surface("bar.left") = {face[1]};
Physical Surface("bar.right") = {bar[0]};
