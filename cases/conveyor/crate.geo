// A crate of 0.4 m by 0.2 m that stands on y = 0, and the upper run of a belt, 4 m long, under it.
// Groups: crate (cells), crate.bottom; belt (lines from right to left: their normals point up).
//
// Made with Gmsh 4.15.2 by: gmsh crate.geo -2 -format msh41 -bin -o crate.msh
DefineConstant[
  n = 1    // refinement
];
width = 0.4;
height = 0.2;
run = 4;

Point(1) = {0, 0, 0};
bottom[] = Extrude {width, 0, 0} { Point{1}; Layers{8 * n}; };
crate[] = Extrude {0, height, 0} { Curve{bottom[1]}; Layers{4 * n}; Recombine; };
Physical Surface("crate") = {crate[1]};
Physical Curve("crate.bottom") = {bottom[1]};

right = newp; Point(right) = {2, 0, 0};
left = newp;  Point(left) = {2 - run, 0, 0};
belt = newc;  Line(belt) = {right, left};
Transfinite Curve{belt} = 33;
Physical Curve("belt") = {belt};
