// Two equal spheres that touch in one point: half balls cut at their equators, or whole ones, axisymmetric (x radius,
// y axis), in mm.
// The mesh is uniform over 1.5 contact radii from the pole and from there grows with the distance.
// Groups: lower, upper (cells); for each body .contact (the uniform part of the arc), .axis, and
// .equator of half balls, .surface of whole ones (the rest of the arc).
// The equators are 100 mm apart, the poles both at the origin.
//
// Made with Gmsh 4.15.2 by: gmsh spheres.geo -2 -format msh41 -bin -setnumber n 16 -o spheres.msh
//   n  8  spheres-coarse.msh   5 elements over the contact radius of 1 mm,   832 in all
//   n 16  spheres.msh         11 elements                                   3200
//   n 32  spheres-fine.msh    21 elements                                  12544
//   n 12, a 2, whole 1  spheres-whole.msh   for impact, 8 elements          2400
//   n 16, a 10  spheres-wide.msh  for a contact radius of 10 mm             1472
// Unequal meshes, whose nodes do not meet: -setnumber m 13 for the lower sphere.
DefineConstant[
  R = 50    // radius of the spheres
  a = 1     // contact radius for which the mesh is made
  n = 16    // elements over 1.5 contact radii, upper sphere
  m = n     // the same, lower sphere
  whole = 0 // 1: whole spheres
];
width = 1.5 * a;
turn = width / R;

// One ball: side = 1 above y = 0, -1 below; count elements over the width. Three blocks around one inner
// point make the half at the contact, three more the other half.
Macro Ball
  pole = newp;    Point(pole) = {0, 0, 0};
  centre = newp;  Point(centre) = {0, side * R, 0};
  equator = newp; Point(equator) = {R, side * R, 0};
  middle = newp;  Point(middle) = {R / 2, side * R, 0};
  on_axis = newp; Point(on_axis) = {0, side * width, 0};
  on_arc = newp;  Point(on_arc) = {R * Sin(turn), side * R * (1 - Cos(turn)), 0};
  inner = newp;   Point(inner) = {(R - width) * Sin(turn), side * (R - (R - width) * Cos(turn)), 0};

  contact = newc;  Circle(contact) = {pole, centre, on_arc};
  right = newc;    Line(right) = {on_arc, inner};
  top = newc;      Line(top) = {on_axis, inner};
  low_axis = newc; Line(low_axis) = {pole, on_axis};
  cut_axis = newc; Line(cut_axis) = {centre, middle};
  cut_arc = newc;  Line(cut_arc) = {equator, middle};
  Transfinite Curve{contact, right, top, low_axis, cut_axis, cut_arc} = count + 1;

  arc = newc;       Circle(arc) = {on_arc, centre, equator};
  high_axis = newc; Line(high_axis) = {on_axis, centre};
  spoke = newc;     Line(spoke) = {inner, middle};
  rings = Ceil(Log(R / width) / Log(1 + 1.4 / count));
  Transfinite Curve{arc, high_axis, spoke} = rings + 1 Using Progression (R / width)^(1 / rings);

  near = news; Curve Loop(near) = {contact, right, -top, -low_axis};    Plane Surface(near) = {near};
  core = news; Curve Loop(core) = {top, spoke, -cut_axis, -high_axis};  Plane Surface(core) = {core};
  rim = news;  Curve Loop(rim) = {arc, cut_arc, -spoke, -right};        Plane Surface(rim) = {rim};
  Transfinite Surface{near, core, rim};
  cells[] = {near, core, rim};
  axis[] = {low_axis, high_axis};
  surface[] = {arc};
  If (whole == 1)
    Call FarHalf;
  EndIf
  Recombine Surface{cells[]};
  If (side < 0)
    ReverseMesh Surface{cells[]};
  EndIf
Return

// The half beyond the equator, of the same count everywhere.
Macro FarHalf
  far_pole = newp; Point(far_pole) = {0, side * 2 * R, 0};
  far_axis = newp; Point(far_axis) = {0, side * 1.5 * R, 0};
  far_arc = newp;  Point(far_arc) = {R / Sqrt(2), side * (R + R / Sqrt(2)), 0};
  knot = newp;     Point(knot) = {0.43 * R, side * 1.43 * R, 0};
  c = newc;
  Line(c) = {centre, far_axis};
  Line(c + 1) = {far_axis, far_pole};
  Line(c + 2) = {middle, knot};
  Line(c + 3) = {far_axis, knot};
  Line(c + 4) = {knot, far_arc};
  Circle(c + 5) = {equator, centre, far_arc};
  Circle(c + 6) = {far_pole, centre, far_arc};
  Transfinite Curve{c : c + 6} = count + 1;
  f = news;
  Curve Loop(f) = {cut_axis, c + 2, -(c + 3), -c};
  Curve Loop(f + 1) = {-cut_arc, c + 5, -(c + 4), -(c + 2)};
  Curve Loop(f + 2) = {c + 3, c + 4, -(c + 6), -(c + 1)};
  For i In {0 : 2}
    Plane Surface(f + i) = {f + i};
    Transfinite Surface{f + i};
  EndFor
  cells[] += {f : f + 2};
  axis[] += {c, c + 1};
  surface[] += {c + 5, c + 6};
Return

side = -1;
count = m;
Call Ball;
Physical Surface("lower") = {cells[]};
Physical Curve("lower.contact") = {contact};
Physical Curve("lower.axis") = {axis[]};
If (whole == 1)
  Physical Curve("lower.surface") = {surface[]};
Else
  Physical Curve("lower.equator") = {cut_axis, cut_arc};
EndIf

side = 1;
count = n;
Call Ball;
Physical Surface("upper") = {cells[]};
Physical Curve("upper.contact") = {contact};
Physical Curve("upper.axis") = {axis[]};
If (whole == 1)
  Physical Curve("upper.surface") = {surface[]};
Else
  Physical Curve("upper.equator") = {cut_axis, cut_arc};
EndIf
