// Two hollow tori, no unit: centre line 76, tube 24 (outer radius), wall 4.5. The first lies in the plane z = 0 about
// the origin; the second is turned by 45 degrees about y and stands about (180, 10, 74), where it leaves a gap of 6.4
// and is met by the rim of the first when this moves along (30, 0, 23), after 0.17 at that velocity. The place of the
// second torus in the literature was not at hand: this one is ours. Hexahedra.
// Groups: torus1, torus2 (cells); for each torus .outer and .inner.
//
// Made with Gmsh 4.15.2 by: gmsh tori.geo -3 -format msh41 -bin -o tori.msh
//   tori-coarse.msh   1 x 8 x 24 elements in each torus (wall, tube, ring): -setnumber tube 8 -setnumber ring 24
//   tori.msh          1 x 16 x 48
//   tori-fine.msh     2 x 16 x 64: -setnumber wall 2 -setnumber ring 64
DefineConstant[
  wall = 1     // elements through the wall
  tube = 16    // elements round the tube, a multiple of 4
  ring = 48    // elements round the ring, a multiple of 4
];
centre_line = 76;
radius = 24;
thickness = 4.5;

// A torus about (x, y, z), turned by the angle turn about the direction y.
Macro HollowTorus
  // e points from the centre to the first section; the axis of the ring is at right angles to e and y.
  ex = Cos(turn);
  ez = Sin(turn);
  start = newp;
  near = centre_line + radius - thickness;
  Point(start) = {x + near * ex, y, z + near * ez};
  across[] = Extrude {thickness * ex, 0, thickness * ez} { Point{start}; Layers{wall}; };
  end = across[1];
  section[] = {};
  For i In {1 : 4}
    quarter[] = Extrude { {0, 1, 0}, {x + centre_line * ex, y, z + centre_line * ez}, -Pi / 2 }
      { Curve{end}; Layers{tube / 4}; Recombine; };
    end = quarter[0];
    section[] += {quarter[1]};
  EndFor
  cells[] = {};
  outer[] = {};
  inner[] = {};
  For i In {1 : 4}
    For j In {0 : 3}
      part[] = Extrude { {-ez, 0, ex}, {x, y, z}, Pi / 2 } { Surface{section[j]}; Layers{ring / 4}; Recombine; };
      section[j] = part[0];
      cells[] += {part[1]};
      outer[] += {part[3]};
      inner[] += {part[5]};
    EndFor
  EndFor
Return

x = 0;
y = 0;
z = 0;
turn = 0;
Call HollowTorus;
Physical Volume("torus1") = {cells[]};
Physical Surface("torus1.outer") = {outer[]};
Physical Surface("torus1.inner") = {inner[]};

x = 180;
y = 10;
z = 74;
turn = Pi / 4;
Call HollowTorus;
Physical Volume("torus2") = {cells[]};
Physical Surface("torus2.outer") = {outer[]};
Physical Surface("torus2.inner") = {inner[]};
