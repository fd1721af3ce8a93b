// Two equal spheres that touch in one point: half balls cut at their equators, axisymmetric (x radius, y axis), in mm.
// The mesh is uniform over 1.5 contact radii from the pole and from there grows with the distance.
// Groups: lower, upper (cells); for each body .contact (the uniform part of the arc), .equator, .axis.
// The equators are 100 mm apart, the poles both at the origin.
//
// Made with Gmsh 4.15.2 by: gmsh spheres.geo -2 -format msh41 -bin -setnumber n 16 -o spheres.msh
//   n  8  spheres-coarse.msh   5 elements over the contact radius of 1 mm,   832 in all
//   n 16  spheres.msh         11 elements                                   3200
//   n 32  spheres-fine.msh    21 elements                                  12544
//   n 16, a 10  spheres-wide.msh  for a contact radius of 10 mm             1472
// Unequal meshes, whose nodes do not meet: -setnumber m 13 for the lower sphere.
DefineConstant[
  R = 50    // radius of the spheres
  a = 1     // contact radius for which the mesh is made
  n = 16    // elements over 1.5 contact radii, upper sphere
  m = n     // the same, lower sphere
];
width = 1.5 * a;
turn = width / R;

// One half ball: side = 1 above y = 0, -1 below; count elements over the width. Three blocks around one inner point.
Macro HalfBall
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
  Recombine Surface{near, core, rim};
  If (side < 0)
    ReverseMesh Surface{near, core, rim};
  EndIf
Return

side = -1;
count = m;
Call HalfBall;
Physical Surface("lower") = {near, core, rim};
Physical Curve("lower.contact") = {contact};
Physical Curve("lower.equator") = {cut_axis, cut_arc};
Physical Curve("lower.axis") = {low_axis, high_axis};

side = 1;
count = n;
Call HalfBall;
Physical Surface("upper") = {near, core, rim};
Physical Curve("upper.contact") = {contact};
Physical Curve("upper.equator") = {cut_axis, cut_arc};
Physical Curve("upper.axis") = {low_axis, high_axis};
