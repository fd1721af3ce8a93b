// Two elastic rings in the plane, in m: ring1 about the origin, ring2 about (2, 0.5), outer radius 1, thickness 0.1,
// 0.0616 apart. Quadrilaterals along the radius and round; those of ring2 are turned by 5 degrees.
// Groups: ring1, ring2 (cells); for each ring .outer and .inner.
//
// Made with Gmsh 4.15.2 by: gmsh rings.geo -2 -format msh41 -bin -o rings.msh
//   rings.msh          3 x 96 elements in each ring
//   rings-coarse.msh   2 x 32, with -setnumber across 2 -setnumber round 32
DefineConstant[
  across = 3    // elements through the thickness
  round = 96    // elements round the ring, a multiple of 4
];
radius = 1;
thickness = 0.1;

// A ring about (x, y), the first element of which starts at the angle turn.
Macro Ring
  start = newp;
  Point(start) = {x + (radius - thickness) * Cos(turn), y + (radius - thickness) * Sin(turn), 0};
  wall[] = Extrude {thickness * Cos(turn), thickness * Sin(turn), 0} { Point{start}; Layers{across}; };
  end = wall[1];
  cells[] = {};
  outer[] = {};
  inner[] = {};
  For i In {1 : 4}
    quarter[] = Extrude { {0, 0, 1}, {x, y, 0}, Pi / 2 } { Curve{end}; Layers{round / 4}; Recombine; };
    end = quarter[0];
    cells[] += {quarter[1]};
    outer[] += {quarter[2]};
    inner[] += {quarter[3]};
  EndFor
Return

x = 0;
y = 0;
turn = 0;
Call Ring;
Physical Surface("ring1") = {cells[]};
Physical Curve("ring1.outer") = {outer[]};
Physical Curve("ring1.inner") = {inner[]};

x = 2;
y = 0.5;
turn = Pi / 36;
Call Ring;
Physical Surface("ring2") = {cells[]};
Physical Curve("ring2.outer") = {outer[]};
Physical Curve("ring2.inner") = {inner[]};
