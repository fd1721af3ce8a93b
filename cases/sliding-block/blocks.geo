// Two blocks on each other: 1 m x 0.2 m with 10 x 2 quadrilaterals, 0.4 m x 0.1 m with 6 x 2.
// gmsh -2 blocks.geo -o blocks.msh

Point(1) = {0, -0.2, 0}; Point(2) = {1, -0.2, 0}; Point(3) = {1, 0, 0}; Point(4) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 11;
Transfinite Curve {2, 4} = 3;
Transfinite Surface {1};
Recombine Surface {1};

Point(5) = {0.31, 0, 0}; Point(6) = {0.71, 0, 0}; Point(7) = {0.71, 0.1, 0}; Point(8) = {0.31, 0.1, 0};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(2) = {2};
Transfinite Curve {5, 7} = 7;
Transfinite Curve {6, 8} = 3;
Transfinite Surface {2};
Recombine Surface {2};

Physical Surface("below") = {1};
Physical Surface("above") = {2};
Physical Curve("below.bottom") = {1};
Physical Curve("below.top") = {3};
Physical Curve("above.bottom") = {5};
Physical Curve("above.right") = {6};
