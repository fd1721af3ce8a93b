// A cube of 1 m on the plane z = 0, and a finer zone under the middle of it with nodes of its own, as wide as 4 of the
// cube's elements and as high as 2, which its shell, one element of the cube thick, surrounds but for z = 0. Hexahedra.
// Groups: rest, tip, shell (cells; the shell is a part of the tip); rest.bottom (z = 0); core.bottom, the face z = 0 that the
// shell surrounds.
//
// Made with Gmsh 4.15.2 by: gmsh block.geo -3 -format msh41 -bin -o block.msh
//   block.msh   rest 10 x 10 x 10, tip 16 x 16 x 8 elements
//   cube.msh    the rest alone: -setnumber zone 0
DefineConstant[
  n = 10       // elements of the rest along each side, an even number
  finer = 4    // elements of the tip to one of the rest along each direction
  zone = 1     // 0: without the tip
];
side = 1;
h = side / n;

Point(1) = {0, 0, 0};
row[] = Extrude {side, 0, 0} { Point{1}; Layers{n}; };
face[] = Extrude {0, side, 0} { Curve{row[1]}; Layers{n}; Recombine; };
cube[] = Extrude {0, 0, side} { Surface{face[1]}; Layers{n}; Recombine; };
Physical Volume("rest") = {cube[1]};
Physical Surface("rest.bottom") = {face[1]};

// The tip, in 3 x 3 x 2 boxes of which the core is the one in the middle below.
If (zone == 1)
  low = side / 2 - 2 * h;
  cells[] = {1, 2, 1};    // of the rest, along a side
  start = newp;
  Point(start) = {low, low, 0};
  For i In {0 : 2}
    row[] = Extrude {cells[i] * h, 0, 0} { Point{start}; Layers{cells[i] * finer}; };
    start = row[0];
    bottom[i] = row[1];
  EndFor
  core[] = {};
  shell[] = {};
  For j In {0 : 2}
    For i In {0 : 2}
      face[] = Extrude {0, cells[j] * h, 0} { Curve{bottom[i]}; Layers{cells[j] * finer}; Recombine; };
      bottom[i] = face[0];
      below[] = Extrude {0, 0, h} { Surface{face[1]}; Layers{finer}; Recombine; };
      above[] = Extrude {0, 0, h} { Surface{below[0]}; Layers{finer}; Recombine; };
      shell[] += {above[1]};
      If (i == 1 && j == 1)
        core[] = {below[1]};
        Physical Surface("core.bottom") = {face[1]};
      Else
        shell[] += {below[1]};
      EndIf
    EndFor
  EndFor
  Physical Volume("tip") = {core[], shell[]};
  Physical Volume("shell") = {shell[]};
EndIf
