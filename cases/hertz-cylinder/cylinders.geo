// Elastic cylinders across the plane, cut at their equators: a half disc that stands on y = 0, and with pair = 1
// a second one that hangs below it; in mm.
// The mesh is uniform over 1.5 contact half-widths on both sides of the pole and from there grows with the distance.
// Groups: upper, with pair = 1 also lower (cells); for each body .contact (the uniform part of the arc), .equator.
//
// Made with Gmsh 4.15.2 by: gmsh cylinders.geo -2 -format msh41 -bin -setnumber n 16 -o cylinder.msh
//   n  8  cylinder-coarse.msh   5 elements over the half-width of 1 mm,   832 in all
//   n 16  cylinder.msh         11 elements                               3200
//   n 32  cylinder-fine.msh    21 elements                              12544
//   n 16, m 13, pair 1  two-cylinders.msh   nodes do not meet            5358
DefineConstant[
  R = 50     // radius of the cylinders
  a = 1      // half-width of the contact for which the mesh is made
  n = 16     // elements over 1.5 half-widths, upper cylinder
  m = n      // the same, lower cylinder
  pair = 0   // 1: with the lower cylinder
];
width = 1.5 * a;
turn = width / R;

// The half x > 0 (hand = 1) or x < 0 (hand = -1) of a half disc between pole and centre, which are there.
Macro Quarter
  equator = newp; Point(equator) = {hand * R, side * R, 0};
  middle = newp;  Point(middle) = {hand * R / 2, side * R, 0};
  on_arc = newp;  Point(on_arc) = {hand * R * Sin(turn), side * R * (1 - Cos(turn)), 0};
  inner = newp;   Point(inner) = {hand * (R - width) * Sin(turn), side * (R - (R - width) * Cos(turn)), 0};

  touch = newc;    Circle(touch) = {pole, centre, on_arc};
  right = newc;    Line(right) = {on_arc, inner};
  top = newc;      Line(top) = {on_axis, inner};
  cut_axis = newc; Line(cut_axis) = {centre, middle};
  cut_arc = newc;  Line(cut_arc) = {equator, middle};
  Transfinite Curve{touch, right, top, cut_axis, cut_arc} = count + 1;

  arc = newc;   Circle(arc) = {on_arc, centre, equator};
  spoke = newc; Line(spoke) = {inner, middle};
  Transfinite Curve{arc, spoke} = rings + 1 Using Progression growth;

  near = news; Curve Loop(near) = {touch, right, -top, -low_axis};      Plane Surface(near) = {near};
  core = news; Curve Loop(core) = {top, spoke, -cut_axis, -high_axis};  Plane Surface(core) = {core};
  rim = news;  Curve Loop(rim) = {arc, cut_arc, -spoke, -right};        Plane Surface(rim) = {rim};
  Transfinite Surface{near, core, rim};
  Recombine Surface{near, core, rim};
  If (side * hand < 0)
    ReverseMesh Surface{near, core, rim};
  EndIf
  cells[] += {near, core, rim};
  contact[] += {touch};
  cut[] += {cut_axis, cut_arc};
Return

// One half disc: side = 1 above y = 0, -1 below; count elements over the width.
Macro HalfDisc
  rings = Ceil(Log(R / width) / Log(1 + 1.4 / count));
  growth = (R / width)^(1 / rings);
  pole = newp;    Point(pole) = {0, 0, 0};
  centre = newp;  Point(centre) = {0, side * R, 0};
  on_axis = newp; Point(on_axis) = {0, side * width, 0};
  low_axis = newc;  Line(low_axis) = {pole, on_axis};
  high_axis = newc; Line(high_axis) = {on_axis, centre};
  Transfinite Curve{low_axis} = count + 1;
  Transfinite Curve{high_axis} = rings + 1 Using Progression growth;
  cells[] = {};
  contact[] = {};
  cut[] = {};
  hand = 1;
  Call Quarter;
  hand = -1;
  Call Quarter;
Return

side = 1;
count = n;
Call HalfDisc;
Physical Surface("upper") = {cells[]};
Physical Curve("upper.contact") = {contact[]};
Physical Curve("upper.equator") = {cut[]};

If (pair == 1)
  side = -1;
  count = m;
  Call HalfDisc;
  Physical Surface("lower") = {cells[]};
  Physical Curve("lower.contact") = {contact[]};
  Physical Curve("lower.equator") = {cut[]};
EndIf
