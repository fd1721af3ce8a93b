// Two square beams of 1 m, 0.02 m x 0.02 m, 400 hexahedra along each, 1e-5 m apart, with separate nodes.
// Written with Gmsh 4.15.2: gmsh two-beams.geo -3 -format msh41 -bin -o two-beams.msh
// The coarse mesh, 40 along each: the same with -setnumber n 40 -o two-beams-coarse.msh
// Extrusions, not transfinite curves: those place nodes with errors of 1e-12.
DefineConstant[ n = 400 ];
length = 1;
side = 0.02;
gap = 1e-5;

// Each beam grows along x from its contact face, which is at exactly -gap and 0.
Point(1) = {-gap, 0, 0};
edge[] = Extrude {0, side, 0} { Point{1}; Layers{1}; };
face[] = Extrude {0, 0, side} { Curve{edge[1]}; Layers{1}; Recombine; };
beam[] = Extrude {-length, 0, 0} { Surface{face[1]}; Layers{n}; Recombine; };
Physical Volume("striker") = {beam[1]};
Physical Surface("striker.contact") = {face[1]};
Physical Surface("striker.far") = {beam[0]};

corner = newp;
Point(corner) = {0, 0, 0};
edge[] = Extrude {0, side, 0} { Point{corner}; Layers{1}; };
face[] = Extrude {0, 0, side} { Curve{edge[1]}; Layers{1}; Recombine; };
beam[] = Extrude {length, 0, 0} { Surface{face[1]}; Layers{n}; Recombine; };
Physical Volume("target") = {beam[1]};
Physical Surface("target.contact") = {face[1]};
Physical Surface("target.clamped") = {beam[0]};
