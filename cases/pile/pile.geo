// Three blocks of different shapes above a tray, pile.msh: gmsh pile.geo -2 -format msh41 -bin
SetFactory("OpenCASCADE");
Mesh.Algorithm = 6;
Mesh.RecombineAll = 0;

// the tray: a floor with two walls
t = 0.012;
Rectangle(1) = {-0.15, -t, 0, 0.30, t};
Rectangle(2) = {-0.15 - t, -t, 0, t, 0.09 + t};
Rectangle(3) = {0.15, -t, 0, t, 0.09 + t};
tray() = BooleanUnion{ Surface{1}; Delete; }{ Surface{2, 3}; Delete; };

// a brick, a hexagon, a wedge
Rectangle(20) = {-0.09, 0.004, 0, 0.12, 0.05};
Rotate {{0, 0, 1}, {-0.09, 0.004, 0}, Pi/36} { Surface{20}; }
For k In {0:5}
  Point(200 + k) = {-0.02 + 0.036 * Cos(k * Pi/3 + 0.2), 0.108 + 0.036 * Sin(k * Pi/3 + 0.2), 0};
EndFor
For k In {0:5}
  Line(200 + k) = {200 + k, 200 + (k + 1) % 6};
EndFor
Curve Loop(200) = {200:205};
Plane Surface(21) = {200};
Point(300) = {0.065, 0.075, 0};
Point(301) = {0.125, 0.085, 0};
Point(302) = {0.085, 0.135, 0};
Line(300) = {300, 301};
Line(301) = {301, 302};
Line(302) = {302, 300};
Curve Loop(300) = {300, 301, 302};
Plane Surface(22) = {300};

Physical Surface("tray") = {tray(0)};
Physical Surface("brick") = {20};
Physical Surface("hexagon") = {21};
Physical Surface("wedge") = {22};
Physical Curve("tray.all") = Abs(Boundary{ Surface{tray(0)}; });
Physical Curve("brick.all") = Abs(Boundary{ Surface{20}; });
e = 1e-4;
bottom() = Curve In BoundingBox {-0.17, -t - e, -e, 0.17, -t + e, e};
Physical Curve("tray.bottom") = bottom();

MeshSize{ PointsOf{ Surface{tray(0)}; } } = 0.006;
MeshSize{ PointsOf{ Surface{20, 21, 22}; } } = 0.005;
