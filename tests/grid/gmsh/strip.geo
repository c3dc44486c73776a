SetFactory("Built-in");
h = 0.75;
Point(1) = {0, 0, 0, h}; Point(2) = {2, 0, 0, h}; Point(3) = {2, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("base line") = {1}; Physical Curve("right") = {2}; Physical Curve("rest") = {3, 4};
Physical Surface("soil") = {1}; Physical Point("pin") = {1};
