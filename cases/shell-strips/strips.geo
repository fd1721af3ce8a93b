// Two strips, in mm: 500 x 20, quadrilaterals of 20 mm. Groups: layered, tapered (cells), layered.left, layered.right, tapered.left, tapered.right
// (lines at x = 0 and x = 500).
// Made with Gmsh 4.15.2 by: gmsh strips.geo -2 -format msh41 -bin -o strips.msh
Point(1) = {0, 0, 0};
line[] = Extrude {0, 20, 0} { Point{1}; Layers{1}; };
layered[] = Extrude {500, 0, 0} { Line{line[1]}; Layers{25}; Recombine; };
Point(11) = {0, 50, 0};
other[] = Extrude {0, 20, 0} { Point{11}; Layers{1}; };
tapered[] = Extrude {500, 0, 0} { Line{other[1]}; Layers{25}; Recombine; };
Reverse Surface {layered[1], tapered[1]};
Physical Surface("layered") = {layered[1]};
Physical Surface("tapered") = {tapered[1]};
Physical Curve("layered.left") = {line[1]};
Physical Curve("layered.right") = {layered[0]};
Physical Curve("tapered.left") = {other[1]};
Physical Curve("tapered.right") = {tapered[0]};
