// A ring about the origin whose impact side is a mesh of its own, in m: outer radius 1, thickness 0.1, the sector
// within 30 degrees of the x axis finer than the rest. The ring meets a wall x = 1 or beyond. Quadrilaterals.
// Groups: rest, sector (cells); for each .outer, .inner, .first (end at -30 degrees), .last (end at 30 degrees).
// The ends of the sector have their own nodes. With joined = 1 they do not: groups ring (cells), sector.outer.
//
// Made with Gmsh 4.15.2 by: gmsh ring.geo -2 -format msh41 -bin -o ring.msh
//   ring.msh          rest 2 x 120, sector 4 x 24 elements (wall, round)
//   ring-single.msh   one mesh as fine as the sector all round, 4 x 144: -setnumber joined 1
DefineConstant[
  across = 2     // elements through the thickness of the rest
  round = 120    // elements of the rest, a multiple of 3
  fine = 24      // elements of the sector, a multiple of 3; twice as many through its thickness as in the rest
  joined = 0     // 1: one mesh, as fine as the sector
];
radius = 1;
thickness = 0.1;
centre = newp;
Point(centre) = {0, 0, 0};

// A cut through the ring at the angle turn, with layers elements: its points inside and outside, its curve.
Macro Cut
  inside = newp;
  Point(inside) = {(radius - thickness) * Cos(turn), (radius - thickness) * Sin(turn), 0};
  outside = newp;
  Point(outside) = {radius * Cos(turn), radius * Sin(turn), 0};
  cut = newc;
  Line(cut) = {inside, outside};
  Transfinite Curve{cut} = layers + 1;
Return

// The part between the last cut and the one at the angle turn, with count elements round. With close = 1
// it ends at the first cut of the ring, ends[].
Macro Part
  from[] = {inside, outside, cut};
  If (close == 0)
    Call Cut;
  Else
    inside = ends[0];
    outside = ends[1];
    cut = ends[2];
  EndIf
  arc = newc;
  Circle(arc) = {from[0], centre, inside};
  Circle(arc + 1) = {from[1], centre, outside};
  Transfinite Curve{arc, arc + 1} = count + 1;
  face = news;
  Curve Loop(face) = {from[2], arc + 1, -cut, -arc};
  Plane Surface(face) = {face};
  Transfinite Surface{face};
  Recombine Surface{face};
  cells[] += {face};
  inner[] += {arc};
  outer[] += {arc + 1};
Return

cells[] = {};
inner[] = {};
outer[] = {};
close = 0;
layers = 2 * across;
turn = -Pi / 6;
Call Cut;
ends[] = {inside, outside, cut};
turn = Pi / 6;
count = fine;
Call Part;
Physical Curve("sector.outer") = {outer[]};
If (joined == 0)
  Physical Surface("sector") = {cells[]};
  Physical Curve("sector.inner") = {inner[]};
  Physical Curve("sector.first") = {ends[2]};
  Physical Curve("sector.last") = {cut};
  cells[] = {};
  inner[] = {};
  outer[] = {};
  count = round / 3;
  layers = across;
  Call Cut;
  Physical Curve("rest.last") = {cut};
Else
  count = 5 * fine / 3;
EndIf
For i In {1 : 3}
  turn = Pi / 6 + i * 5 * Pi / 9;
  close = joined * (i == 3);
  Call Part;
EndFor
If (joined == 0)
  Physical Surface("rest") = {cells[]};
  Physical Curve("rest.outer") = {outer[]};
  Physical Curve("rest.inner") = {inner[]};
  Physical Curve("rest.first") = {cut};
Else
  Physical Surface("ring") = {cells[]};
EndIf
