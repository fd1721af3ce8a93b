// A sheet, in mm: 200 x 40 about the origin, quadrilaterals of 5 mm. Group: sheet.
// Made with Gmsh 4.15.2 by: gmsh sheet.geo -2 -format msh41 -bin -o sheet.msh
Point(1) = {-100, -20, 0};
line[] = Extrude {200, 0, 0} { Point{1}; Layers{40}; };
sheet[] = Extrude {0, 40, 0} { Line{line[1]}; Layers{8}; Recombine; };
Physical Surface("sheet") = {sheet[1]};
