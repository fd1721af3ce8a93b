// A bar of 0.25 m by 20 mm, and a hammer of 50 mm by 60 mm beside its left end with nodes of its own. Quadrilaterals.
// Groups: bar, hammer (cells); bar.left, bar.right, hammer.right (edges).
//
// Made with Gmsh 4.15.2 by: gmsh hammer-and-bar.geo -2 -format msh41 -o hammer-and-bar.msh
DefineConstant[ n = 100 ]; // elements along the bar
e = 1e-6;

Point(1) = {0, 0, 0};
low[] = Extrude {0.25, 0, 0} { Point{1}; Layers{n}; };
bar[] = Extrude {0, 0.02, 0} { Curve{low[1]}; Layers{1}; Recombine; };
Physical Surface("bar") = {bar[1]};
Physical Curve("bar.left") = Curve In BoundingBox {-e, -e, -e, e, 0.02 + e, e};
Physical Curve("bar.right") = Curve In BoundingBox {0.25 - e, -e, -e, 0.25 + e, 0.02 + e, e};

Point(100) = {-0.05, -0.02, 0};
foot[] = Extrude {0.05, 0, 0} { Point{100}; Layers{1}; };
hammer[] = Extrude {0, 0.06, 0} { Curve{foot[1]}; Layers{1}; Recombine; };
Physical Surface("hammer") = {hammer[1]};
// the edge of the bar lies within that of the hammer
all[] = Curve In BoundingBox {-e, -0.02 - e, -e, e, 0.04 + e, e};
all[] -= Curve In BoundingBox {-e, -e, -e, e, 0.02 + e, e};
Physical Curve("hammer.right") = all[];
