// Taylor's bar, axisymmetric (x radius, y axis), in mm: a cylinder of radius 3.2 and length 32.4 whose foot is y = 0.
// Quadrilaterals, smaller towards the foot.
// Groups: bar (cells), bar.foot, bar.top, bar.axis, bar.side.
//
// Made with Gmsh 4.15.2 by: gmsh bar-plane.geo -2 -format msh41 -bin -o bar-plane.msh
//   bar-plane.msh          12 x 50 elements, 0.27 mm x 0.32 mm at the foot, 1.3 mm high at the top
//   bar-plane-coarse.msh    6 x 25, with -setnumber across 6 -setnumber along 25
DefineConstant[
  across = 12   // elements along the radius
  along = 50    // elements along the axis
];
radius = 3.2;
length = 32.4;
ratio = 4;      // height of the last element over that of the first
growth = ratio^(1 / (along - 1));

// Heights of the layers' upper ends, as parts of the length.
part = (growth - 1) / (growth^along - 1);
height = 0;
For i In {0 : along - 1}
  height += part * growth^i;
  ends[i] = height;
  ones[i] = 1;
EndFor
ends[along - 1] = 1;

Point(1) = {0, 0, 0};
foot[] = Extrude {radius, 0, 0} { Point{1}; Layers{across}; };
bar[] = Extrude {0, length, 0} { Curve{foot[1]}; Layers{ones[], ends[]}; Recombine; };
Physical Surface("bar") = {bar[1]};
Physical Curve("bar.foot") = {foot[1]};
Physical Curve("bar.top") = {bar[0]};
Physical Curve("bar.side") = {bar[2]};
Physical Curve("bar.axis") = {bar[3]};
