// A fuel rod in eight grids, in mm: 3850 high, along z. Each grid holds it at three heights: lower dimples, springs, upper dimples.
// Groups: rod (lines), foot, tip (its ends), g1-low, g1-mid, g1-up, ... g8-up (nodes), mid-span (a node).
//
// Made with Gmsh 4.15.2 by: gmsh rod.geo -1 -format msh41 -bin -o rod.msh
DefineConstant[
  n = 8   // elements between two grids
];

Point(1) = {0, 0, 0};
For k In {0 : 7}
  z = 60 + 522*k;
  Point(2 + 3*k) = {0, 0, z - 8};
  Point(3 + 3*k) = {0, 0, z};
  Point(4 + 3*k) = {0, 0, z + 8};
EndFor
Point(26) = {0, 0, 3850};
For k In {1 : 25}
  Line(k) = {k, k + 1};
  Transfinite Curve {k} = 2;
EndFor
For k In {1 : 7}
  Transfinite Curve {1 + 3*k} = n + 1;
EndFor

Physical Curve("rod") = {1 : 25};
Physical Point("foot") = {1};
Physical Point("tip") = {26};
For k In {0 : 7}
  Physical Point(Sprintf("g%g-low", k + 1)) = {2 + 3*k};
  Physical Point(Sprintf("g%g-mid", k + 1)) = {3 + 3*k};
  Physical Point(Sprintf("g%g-up", k + 1)) = {4 + 3*k};
EndFor
