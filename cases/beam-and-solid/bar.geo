// A bar of 20 mm x 20 mm along x, from the plane x = 0, about the x axis. Hexahedra of 20 nodes.
// Groups: solid (cells), solid.end (x = length), struck (the middle of the upper edge of the end x = 0).
//
// Made with Gmsh 4.15.2 by: gmsh bar.geo -3 -order 2 -setnumber Mesh.SecondOrderIncomplete 1 -format msh41 -bin -o <name>.msh
//   tip.msh    100 mm, 10 x 2 x 2 elements
//   bar.msh    2 m, 200 x 2 x 2 elements: -setnumber n 200
DefineConstant[
  n = 10    // elements of 10 mm along x
];
side = 0.02;
Point(1) = {0, 0.5 * side, 0};
Point(2) = {0, 0.5 * side, 0.5 * side};
Point(3) = {0, -0.5 * side, 0.5 * side};
Point(4) = {0, -0.5 * side, 0};
Point(5) = {0, -0.5 * side, -0.5 * side};
Point(6) = {0, 0.5 * side, -0.5 * side};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {4, 5};
Line(6) = {5, 6};
Line(7) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {-4, 5, 6, 7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve {1, 3, 5, 7} = 2;
Transfinite Curve {2, 4, 6} = 3;
Transfinite Surface {1};
Transfinite Surface {2};
Recombine Surface {1, 2};
one[] = Extrude {0.01 * n, 0, 0} { Surface{1}; Layers{n}; Recombine; };
two[] = Extrude {0.01 * n, 0, 0} { Surface{2}; Layers{n}; Recombine; };
Physical Volume("solid") = {one[1], two[1]};
Physical Surface("solid.end") = {one[0], two[0]};
Physical Point("struck") = {1};
