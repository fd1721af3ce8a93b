// A fuel rod in eight grids, in mm: 3850 high, along z; at the fourth grid, z = 1626, a tube of solid cells with the spring and the dimples of the
// grid, solids too. Groups: rod (lines), glue (lines, the overlaps), foot, tip, g1-low, g1-mid, g1-up, ... (nodes, not of grid 4); tube, x-spring.leaf,
// x-low.leaf, ... (cells), tube.outer, grid.feet, x-spring, x-low, x-up, y-spring, y-low, y-up (faces; the last six of the pads).
//
// Made with Gmsh 4.15.2 by: gmsh rod.geo -3 -order 2 -setnumber Mesh.SecondOrderIncomplete 1 -format msh41 -bin -o <name>.msh
//   rod.msh   as it stands;  a1.msh: -setnumber a 1;  a2.msh: -setnumber a 2;  a8.msh: -setnumber a 8;  fine.msh: -setnumber f 2
SetFactory("OpenCASCADE");
DefineConstant[
  n = 8   // elements of the rod between two grids
  f = 1,  // refinement of the solids
  a = 4   // elements along an arm of a leaf, in pairs
];
outer = 4.572;  inner = 4.0005;  middle = 1626;
half = 40;      // of the tube along z
overlap = 18;   // of the tube and the rod
gap = 0.05;

// the rod: heights of its points, and lines between them; each has three nodes and is two elements
zs[] = {0};  parts[] = {};
For k In {0 : 7}
  at = 60 + 522*k;
  long = (k == 0) ? 1 : n/2;
  If (k == 3)
    zs[] += {at - half, at - half + overlap, at + half - overlap, at + half};
    parts[] += {long, 2*f, 2, 2*f};
  Else
    zs[] += {at - 8, at, at + 8};
    parts[] += {long, 1, 1};
  EndIf
EndFor
zs[] += {3850};
parts[] += {1};
last = #zs[] - 1;
For k In {0 : last}
  Point(1 + k) = {0, 0, zs[k]};
EndFor
For k In {1 : last}
  Line(k) = {k, k + 1};
  Transfinite Curve {k} = parts[k - 1] + 1;
EndFor
Physical Curve("rod") = {1 : last};
Physical Curve("glue") = {11, 13};
Physical Point("foot") = {1};
Physical Point("tip") = {1 + last};
For k In {0 : 7}
  If (k != 3)
    first = 2 + 3*k + ((k > 3) ? 1 : 0);
    Physical Point(Sprintf("g%g-low", k + 1)) = {first};
    Physical Point(Sprintf("g%g-mid", k + 1)) = {first + 1};
    Physical Point(Sprintf("g%g-up", k + 1)) = {first + 2};
  EndIf
EndFor

// the tube: four quarters of a ring, in three parts along z
low[] = {middle - half, middle - half + overlap, middle + half - overlap};
long[] = {overlap, 2*half - 2*overlap, overlap};
pieces[] = {};
For i In {0 : 2}
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

// leaves that are clamped at both ends, each with a pad in its middle that faces the tube: springs of 150 kN/m, and on the other side two dimples
// of 500 kN/m each
pad = 2;  high = 0.4;  width = 4;
turns[] = {0, Pi/2, Pi, -Pi/2, Pi, -Pi/2};
longs[] = {20, 20, 12, 12, 12, 12};
thicks[] = {0.454, 0.454, 0.407, 0.407, 0.407, 0.407};
ats[] = {0, 0, -8, -8, 8, 8};
x = outer + gap;
For i In {0 : 5}
  at = middle + ats[i];
  arm = (longs[i] - pad)/2;
  v = newv;
  Box(v) = {x + high, -width/2, at - arm - pad/2, thicks[i], width, arm};
  Box(v + 1) = {x + high, -width/2, at - pad/2, thicks[i], width, pad};
  Box(v + 2) = {x + high, -width/2, at + pad/2, thicks[i], width, arm};
  Box(v + 3) = {x, -width/2, at - pad/2, high, width, pad};
  Rotate {{0, 0, 1}, {0, 0, 0}, turns[i]} { Volume{v : v + 3}; }
  own[] = BooleanFragments { Volume{v : v + 3}; Delete; }{};
  If (i == 0)
    Physical Volume("x-spring.leaf") = {own[]};
  ElseIf (i == 1)
    Physical Volume("y-spring.leaf") = {own[]};
  ElseIf (i == 2)
    Physical Volume("x-low.leaf") = {own[]};
  ElseIf (i == 3)
    Physical Volume("y-low.leaf") = {own[]};
  ElseIf (i == 4)
    Physical Volume("x-up.leaf") = {own[]};
  Else
    Physical Volume("y-up.leaf") = {own[]};
  EndIf
EndFor

// elements along a line follow from its length
all[] = Abs(Boundary{ Surface{:}; });
For k In {0 : #all[] - 1}
  size = Mass Curve{all[k]};
  count = 3*f;                 // quarters of circles
  If (size < 1)
    count = 1;
  ElseIf (size < 3)
    count = f;
  ElseIf (size > 40)
    count = 8*f;
  ElseIf (size > 17)
    count = 3*f;
  ElseIf (Fabs(size - 4) < 0.01)
    count = 2*f;
  ElseIf (Fabs(size - 5) < 0.01 || Fabs(size - 9) < 0.01)
    count = 2*a;
  EndIf
  Transfinite Curve {all[k]} = count + 1;
EndFor
Transfinite Surface {:};
Recombine Surface {:};
Transfinite Volume {:};

// of the faces in the middle of the tube the outer ones have 316 mm²
e = 1e-3;  far = 20;
near[] = Surface In BoundingBox {-outer - e, -outer - e, low[1] - e, outer + e, outer + e, low[2] + e};
skin[] = {};
For k In {0 : #near[] - 1}
  size = Mass Surface{near[k]};
  If (size > 300)
    skin[] += {near[k]};
  EndIf
EndFor
Physical Surface("tube.outer") = {skin[]};
w = width/2 + e;  h = pad/2 + e;
xs[] = Surface In BoundingBox {x - e, -w, middle - h, x + e, w, middle + h};
ys[] = Surface In BoundingBox {-w, x - e, middle - h, w, x + e, middle + h};
xl[] = Surface In BoundingBox {-x - e, -w, middle - 8 - h, -x + e, w, middle - 8 + h};
yl[] = Surface In BoundingBox {-w, -x - e, middle - 8 - h, w, -x + e, middle - 8 + h};
xu[] = Surface In BoundingBox {-x - e, -w, middle + 8 - h, -x + e, w, middle + 8 + h};
yu[] = Surface In BoundingBox {-w, -x - e, middle + 8 - h, w, -x + e, middle + 8 + h};
Physical Surface("x-spring") = {xs[]};
Physical Surface("y-spring") = {ys[]};
Physical Surface("x-low") = {xl[]};
Physical Surface("y-low") = {yl[]};
Physical Surface("x-up") = {xu[]};
Physical Surface("y-up") = {yu[]};
feet[] = {};
ends[] = {-14, -10, -2, 2, 10, 14};
For k In {0 : 5}
  feet[] += Surface In BoundingBox {-far, -far, middle + ends[k] - e, far, far, middle + ends[k] + e};
EndFor
Physical Surface("grid.feet") = {feet[]};
