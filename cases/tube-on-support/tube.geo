// A steam-generator tube, in mm: 1000 long, along z, 19.05 by 1.09; around the support plate in its middle it is solid.
// Groups: line, glue, wetted (lines: the beam, the overlaps, what lies outside of the solid), ends (nodes); tube (cells), land (faces, outside over
// the height of the plate).
//
// Made with Gmsh 4.15.2 by: gmsh tube.geo -3 -order 2 -setnumber Mesh.SecondOrderIncomplete 1 -format msh41 -bin -o <name>.msh
//   tube.msh   as it stands;  fine.msh: -setnumber f 2
SetFactory("OpenCASCADE");
DefineConstant[
  f = 1   // refinement of the solid
];
outer = 9.525;  inner = 8.435;
zs[] = {0, 250, 430, 468, 532, 570, 750, 1000};
parts[] = {6, 5, 2, 2, 2, 5, 6};   // lines of three nodes: two elements of the beam each
For k In {0 : 7}
  Point(1 + k) = {0, 0, zs[k]};
EndFor
For k In {1 : 7}
  Line(k) = {k, k + 1};
  Transfinite Curve {k} = parts[k - 1] + 1;
EndFor
Physical Curve("line") = {1 : 7};
Physical Curve("glue") = {3, 5};
Physical Curve("wetted") = {1, 2, 6, 7};
Physical Point("ends") = {1, 8};

// the tube: four quarters of a ring, in five parts along z
low[] = {430, 468, 485, 515, 532};
long[] = {38, 17, 30, 17, 38};
pieces[] = {};
For i In {0 : 4}
  For k In {0 : 3}
    v = 1 + 3*(4*i + k);
    Cylinder(v) = {0, 0, low[i], 0, 0, long[i], outer, Pi/2};
    Cylinder(v + 1) = {0, 0, low[i], 0, 0, long[i], inner, Pi/2};
    BooleanDifference(v + 2) = { Volume{v}; Delete; }{ Volume{v + 1}; Delete; };
    Rotate {{0, 0, 1}, {0, 0, 0}, k * Pi/2} { Volume{v + 2}; }
    pieces[] += {v + 2};
  EndFor
EndFor
tube[] = BooleanFragments { Volume{pieces[]}; Delete; }{};
Physical Volume("tube") = {tube[]};
all[] = Abs(Boundary{ Surface{:}; });
For k In {0 : #all[] - 1}
  size = Mass Curve{all[k]};
  count = 4*f;                 // quarters of circles
  If (size < 2)
    count = 1;
  ElseIf (size > 35)
    count = 3*f;
  ElseIf (size > 29)
    count = 4*f;
  ElseIf (size > 16.5)
    count = 2*f;
  EndIf
  Transfinite Curve {all[k]} = count + 1;
EndFor
Transfinite Surface {:};
Recombine Surface {:};
Transfinite Volume {:};

// of the faces over the height of the plate the outer ones have 449 mm²
e = 1e-3;
near[] = Surface In BoundingBox {-outer - e, -outer - e, low[2] - e, outer + e, outer + e, low[3] + e};
land[] = {};
For k In {0 : #near[] - 1}
  size = Mass Surface{near[k]};
  If (size > 420)
    land[] += {near[k]};
  EndIf
EndFor
Physical Surface("land") = {land[]};
