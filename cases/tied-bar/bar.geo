// Two halves of a bar, in mm: each 100 x 20 x 20, the first 2 mm from the wall; nodes in the middle do not match. Groups: near, far (cells), near.left,
// near.right, far.left, far.right (sides).
// Made with Gmsh 4.15.2 by: gmsh bar.geo -3 -format msh41 -bin -o bar.msh
Geometry.AutoCoherence = 0;
Point(1) = {2, 0, 0};
a1[] = Extrude {0, 20, 0} { Point{1}; Layers{6}; };
a2[] = Extrude {0, 0, 20} { Curve{a1[1]}; Layers{6}; Recombine; };
a3[] = Extrude {100, 0, 0} { Surface{a2[1]}; Layers{100}; Recombine; };
Point(1001) = {102, 0, 0};
b1[] = Extrude {0, 20, 0} { Point{1001}; Layers{4}; };
b2[] = Extrude {0, 0, 20} { Curve{b1[1]}; Layers{4}; Recombine; };
b3[] = Extrude {100, 0, 0} { Surface{b2[1]}; Layers{80}; Recombine; };
Physical Volume("near") = {a3[1]};
Physical Volume("far") = {b3[1]};
Physical Surface("near.left") = {a2[1]};
Physical Surface("near.right") = {a3[0]};
Physical Surface("far.left") = {b2[1]};
Physical Surface("far.right") = {b3[0]};
