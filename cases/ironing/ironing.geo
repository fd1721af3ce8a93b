// Ironing in the plane, in mm: a block of 20 x 4 that stands on y = 0, and an indenter with a round foot of radius 3
// and width 5.2 that touches it at (5, 4), to be pressed 1 down and moved 10 along x.
// Height of the block, radius and width of the foot are those of the slab and die of Puso and Laursen (2004); the block
// is longer than theirs, so that neither end of the way is near an end of the block.
// Groups: block, indenter (cells), block.contact (top), block.bottom, block.ends, indenter.contact (round foot),
// indenter.top, indenter.sides.
//
// Made with Gmsh 4.15.2 by: gmsh ironing.geo -2 -format msh41 -bin -setnumber n 2 -o ironing.msh
//   n 1  ironing-coarse.msh   block 40 x  8 elements, indenter 14 x  4
//   n 2  ironing.msh                80 x 16                    28 x  8
//   n 4  ironing-fine.msh          160 x 32                    56 x 16
DefineConstant[
  n = 2    // refinement
];
length = 20;
height = 4;
radius = 3;
half = 2.6;
place = 5;
top = 2.5;     // of the indenter, above its lowest point

Point(1) = {0, 0, 0};
bottom[] = Extrude {length, 0, 0} { Point{1}; Layers{40 * n}; };
block[] = Extrude {0, height, 0} { Curve{bottom[1]}; Layers{8 * n}; Recombine; };
Physical Surface("block") = {block[1]};
Physical Curve("block.contact") = {block[0]};
Physical Curve("block.bottom") = {bottom[1]};
Physical Curve("block.ends") = {block[2], block[3]};

// Two halves, so that a node is at the lowest point.
side = radius - Sqrt(radius^2 - half^2);
foot = newp;   Point(foot) = {place, height, 0};
centre = newp; Point(centre) = {place, height + radius, 0};
right = newp;  Point(right) = {place + half, height + side, 0};
left = newp;   Point(left) = {place - half, height + side, 0};
crest[] = {newp, newp + 1, newp + 2};
Point(crest[0]) = {place - half, height + top, 0};
Point(crest[1]) = {place, height + top, 0};
Point(crest[2]) = {place + half, height + top, 0};
c = newc;
Circle(c) = {left, centre, foot};
Circle(c + 1) = {foot, centre, right};
Line(c + 2) = {crest[0], crest[1]};
Line(c + 3) = {crest[1], crest[2]};
Transfinite Curve{c : c + 3} = 7 * n + 1;
Line(c + 4) = {left, crest[0]};
Line(c + 5) = {foot, crest[1]};
Line(c + 6) = {right, crest[2]};
Transfinite Curve{c + 4 : c + 6} = 4 * n + 1;
s = news;
Curve Loop(s) = {c, c + 5, -(c + 2), -(c + 4)};
Curve Loop(s + 1) = {c + 1, c + 6, -(c + 3), -(c + 5)};
Plane Surface(s) = {s};
Plane Surface(s + 1) = {s + 1};
Transfinite Surface{s, s + 1};
Recombine Surface{s, s + 1};
Physical Surface("indenter") = {s, s + 1};
Physical Curve("indenter.contact") = {c, c + 1};
Physical Curve("indenter.top") = {c + 2, c + 3};
Physical Curve("indenter.sides") = {c + 4, c + 6};
