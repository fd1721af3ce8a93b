// A quarter of a ball of 10 mm that stands on the origin. Tetrahedra of 10 nodes, of 0.6 mm below.
// Groups: cells; below (the sphere within 4 mm of the axis), x-cut, y-cut (faces).
//
// Made with Gmsh 4.15.2 by: gmsh ball.geo -3 -order 2 -format msh41 -bin -o ball.msh
SetFactory("OpenCASCADE");
radius = 10; touched = 4;
level = -Acos(touched / radius);
Sphere(1) = {0, 0, radius, radius, -Pi / 2, level, Pi / 2};
Sphere(2) = {0, 0, radius, radius, level, Pi / 2, Pi / 2};
Coherence;
Field[1] = MathEval; Field[1].F = "0.6 + 0.25 * Sqrt(x*x + y*y + z*z)";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Volume("cells") = {1, 2};
Physical Surface("below") = {1};
Physical Surface("y-cut") = {3, 6};
Physical Surface("x-cut") = {4, 7};
