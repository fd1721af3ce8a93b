// A row of fuel assemblies between two baffles, in mm: 4060 high, along y, 215.5 apart along x. Eight grids, 523 apart.
// Groups: a0 ... a16 (lines; the first and the last are the baffles), a0-foot, a0-head (ends), a0-g1 ... a16-g8 (nodes at the grids).
//
// Made with Gmsh 4.15.2 by: gmsh row.geo -1 -format msh41 -bin -o row-15.msh
//                           gmsh row.geo -setnumber assemblies 5 -1 -format msh41 -bin -o row-5.msh
DefineConstant[
  assemblies = 15
  n = 5   // elements between two grids
];
all = assemblies + 2;

For a In {0 : all - 1}
  x = 215.5*a;
  Point(10*a + 1) = {x, 0, 0};
  For k In {1 : 8}
    Point(10*a + 1 + k) = {x, 200 + 523*(k - 1), 0};
  EndFor
  Point(10*a + 10) = {x, 4060, 0};
  For k In {1 : 9}
    Line(10*a + k) = {10*a + k, 10*a + k + 1};
    Transfinite Curve {10*a + k} = n + 1;
  EndFor
  Transfinite Curve {10*a + 1, 10*a + 9} = 3;
EndFor

For a In {0 : all - 1}
  Physical Curve(Sprintf("a%g", a)) = {10*a + 1 : 10*a + 9};
  Physical Point(Sprintf("a%g-foot", a)) = {10*a + 1};
  Physical Point(Sprintf("a%g-head", a)) = {10*a + 10};
  For k In {1 : 8}
    Physical Point(Sprintf("a%g-g%g", a, k)) = {10*a + 1 + k};
  EndFor
EndFor
