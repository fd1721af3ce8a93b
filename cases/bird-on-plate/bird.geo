// A quarter of a bird, 30 x 30 x 120 mm, 0.5 mm above a quarter of a plate, 150 x 150 x 6 mm, whose upper side is z = 0. In mm. Hexahedra.
// Groups: bird, plate (cells); bird.bottom, plate.top; left (x = 0) and front (y = 0) of both, the planes of symmetry; right and
// back of the plate, its rim. `refine` in the case file makes more cells.
//
// Made with Gmsh 4.15.2 by: gmsh bird.geo -3 -format msh41 -bin -o bird.msh
Point(1) = {0, 0, 0.5};
line[] = Extrude {30, 0, 0} { Point{1}; Layers{3}; };
low[] = Extrude {0, 30, 0} { Curve{line[1]}; Layers{3}; Recombine; };
bird[] = Extrude {0, 0, 120} { Surface{low[1]}; Layers{12}; Recombine; };
Point(101) = {0, 0, -6};
edge[] = Extrude {150, 0, 0} { Point{101}; Layers{10}; };
under[] = Extrude {0, 150, 0} { Curve{edge[1]}; Layers{10}; Recombine; };
plate[] = Extrude {0, 0, 6} { Surface{under[1]}; Layers{1}; Recombine; };

e = 0.001;
left[] = Surface In BoundingBox{-e, -e, 0.5 - e, e, 30 + e, 120.5 + e};
front[] = Surface In BoundingBox{-e, -e, 0.5 - e, 30 + e, e, 120.5 + e};
Physical Volume("bird") = {bird[1]};
Physical Surface("bird.bottom") = {low[1]};
Physical Surface("bird.left") = {left[]};
Physical Surface("bird.front") = {front[]};

left[] = Surface In BoundingBox{-e, -e, -6 - e, e, 150 + e, e};
front[] = Surface In BoundingBox{-e, -e, -6 - e, 150 + e, e, e};
right[] = Surface In BoundingBox{150 - e, -e, -6 - e, 150 + e, 150 + e, e};
back[] = Surface In BoundingBox{-e, 150 - e, -6 - e, 150 + e, 150 + e, e};
Physical Volume("plate") = {plate[1]};
Physical Surface("plate.top") = {plate[0]};
Physical Surface("plate.left") = {left[]};
Physical Surface("plate.front") = {front[]};
Physical Surface("plate.right") = {right[]};
Physical Surface("plate.back") = {back[]};
