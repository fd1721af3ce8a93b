// A closed box of 100 x 70 x 40 mm with walls of 2 mm, and an inner floor of 2 mm at 3 mm above the bottom wall, fixed to the side
// walls, with a solid block of 48 x 30 x 10 mm on it. In mm. Hexahedra, one through each wall: `refine` in the case file makes more.
// Groups: walls (the walls and the inner floor), corners (the walls within 10 mm of the eight corners), block (cells); outer (the
// outside), surface (all free sides).
//
// Made with Gmsh 4.15.2 by: gmsh box.geo -3 -format msh41 -bin -o box.msh
DefineConstant[
  size = 6     // largest length of a cell along the walls
];

// planes between the blocks along the three axes
x[] = {0, 2, 10, 26, 74, 90, 98, 100};
y[] = {0, 2, 10, 20, 50, 60, 68, 70};
z[] = {0, 2, 5, 7, 10, 17, 30, 38, 40};
nx = #x[] - 1;
ny = #y[] - 1;
nz = #z[] - 1;

// all blocks, and which of them are filled
Point(1) = {x[0], y[0], z[0]};
first = 1;
walls[] = {};
corners[] = {};
block[] = {};
points[] = {1};
For i In {0 : nx - 1}
  row[] = Extrude {x[i + 1] - x[i], 0, 0} { Point{points[i]}; Layers{Ceil((x[i + 1] - x[i]) / size)}; };
  points[] += {row[0]};
  lines[i] = row[1];
EndFor
For j In {0 : ny - 1}
  For i In {0 : nx - 1}
    strip[] = Extrude {0, y[j + 1] - y[j], 0} { Curve{lines[i]}; Layers{Ceil((y[j + 1] - y[j]) / size)}; Recombine; };
    lines[i] = strip[0];
    sides[i + nx * j] = strip[1];
  EndFor
EndFor
For k In {0 : nz - 1}
  For j In {0 : ny - 1}
    For i In {0 : nx - 1}
      at = i + nx * j;
      box[] = Extrude {0, 0, z[k + 1] - z[k]} { Surface{sides[at]}; Layers{Ceil((z[k + 1] - z[k]) / size)}; Recombine; };
      sides[at] = box[0];
      wall = i == 0 || i == nx - 1 || j == 0 || j == ny - 1 || k == 0 || k == nz - 1;
      corner = wall && (i < 2 || i > nx - 3) && (j < 2 || j > ny - 3) && (k < 4 || k > nz - 3);
      floor = k == 2;
      solid = (k == 3 || k == 4) && i == 3 && j == 3;
      If (corner)
        corners[] += {box[1]};
      ElseIf (wall || floor)
        walls[] += {box[1]};
      ElseIf (solid)
        block[] += {box[1]};
      EndIf
    EndFor
  EndFor
EndFor

Physical Volume("walls") = {walls[]};
Physical Volume("corners") = {corners[]};
Physical Volume("block") = {block[]};
Physical Surface("surface") = CombinedBoundary { Volume{walls[], corners[], block[]}; };
outer[] = {};
outer[] += Surface In BoundingBox {-1, -1, -1, 0.1, 71, 41};
outer[] += Surface In BoundingBox {99.9, -1, -1, 101, 71, 41};
outer[] += Surface In BoundingBox {-1, -1, -1, 101, 0.1, 41};
outer[] += Surface In BoundingBox {-1, 69.9, -1, 101, 71, 41};
outer[] += Surface In BoundingBox {-1, -1, -1, 101, 71, 0.1};
outer[] += Surface In BoundingBox {-1, -1, 39.9, 101, 71, 41};
Physical Surface("outer") = {outer[]};
