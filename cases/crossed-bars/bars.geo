// bars.msh was written by hand; this makes the same mesh but for the order of the nodes: gmsh -3 -format msh2 bars.geo -o bars.msh
// Two square bars of 50 mm and 600 mm, turned by 45° about their axes: `a` along x, `b` along y, 1.7893 mm above it, edge over edge.
h = 0.05 / Sqrt(2);
z = 2 * h + 0.0017893218813452445;

Point(1) = {-0.3, 0, -h};
Point(2) = {-0.3, h, 0};
Point(3) = {-0.3, 0, h};
Point(4) = {-0.3, -h, 0};
Point(5) = {0, -0.3, z - h};
Point(6) = {h, -0.3, z};
Point(7) = {0, -0.3, z + h};
Point(8) = {-h, -0.3, z};
For k In {0:1}
  For i In {0:3}
    Line(4 * k + i + 1) = {4 * k + i + 1, 4 * k + (i + 1) % 4 + 1};
  EndFor
  Curve Loop(k + 1) = {4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4};
  Plane Surface(k + 1) = {k + 1};
EndFor
Transfinite Curve{1:8} = 2;
Transfinite Surface{1:2};
Recombine Surface{1:2};
a[] = Extrude {0.6, 0, 0} { Surface{1}; Layers{3}; Recombine; };
b[] = Extrude {0, 0.6, 0} { Surface{2}; Layers{3}; Recombine; };
Physical Volume("a") = {a[1]};
Physical Volume("b") = {b[1]};
