// A quarter of a plate without its middle: the middle surface z = -7 mm from 21 mm to 154 mm, quadrilaterals of 7 mm.
// Groups: plate (cells); x-cut, y-cut (lines).
//
// Made with Gmsh 4.15.2 by: gmsh shell.geo -2 -format msh41 -bin -o shell.msh
inner = 21; outer = 154; size = 7; z = -7;
Point(1) = {inner, 0, z};
Point(2) = {outer, 0, z};
Point(3) = {outer, inner, z};
Point(4) = {inner, inner, z};
Point(5) = {outer, outer, z};
Point(6) = {inner, outer, z};
Point(7) = {0, outer, z};
Point(8) = {0, inner, z};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {4, 3}; Line(4) = {1, 4};
Line(5) = {3, 5}; Line(6) = {6, 5}; Line(7) = {4, 6};
Line(8) = {7, 6}; Line(9) = {8, 7}; Line(10) = {8, 4};
Curve Loop(1) = {1, 2, -3, -4};
Curve Loop(2) = {3, 5, -6, -7};
Curve Loop(3) = {10, 7, -8, -9};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
Transfinite Curve {1, 3, 5, 6, 7, 9} = (outer - inner) / size + 1;
Transfinite Curve {2, 4, 8, 10} = inner / size + 1;
Transfinite Surface {1, 2, 3};
Recombine Surface {1, 2, 3};
Physical Surface("plate") = {1, 2, 3};
Physical Curve("y-cut") = {1};
Physical Curve("x-cut") = {9};
