// A room with two bodies: a fan-like bar that turns about its axis, and a torus-shaped duct that moves.
// gmsh -3 room.geo -o room.msh
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 4, 3, 2.5};
Box(2) = {0.7, 1.35, 1.1, 1.6, 0.3, 0.3};
Torus(3) = {3.2, 1.5, 1.2, 0.4, 0.15};
BooleanDifference(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };

eps = 1e-3;
bar() = Surface In BoundingBox{0.7 - eps, 1.35 - eps, 1.1 - eps, 2.3 + eps, 1.65 + eps, 1.4 + eps};
duct() = Surface In BoundingBox{2.6 - eps, 0.9 - eps, 1.0 - eps, 3.8 + eps, 2.1 + eps, 1.4 + eps};
all() = Boundary{ Volume{4}; };
walls() = all();
walls() -= bar();
walls() -= duct();
Physical Volume("air", 10) = {4};
Physical Surface("bar", 1) = {bar()};
Physical Surface("duct", 2) = {duct()};
Physical Surface("walls", 3) = {walls()};

Mesh.CharacteristicLengthMax = 0.5;
Mesh.CharacteristicLengthFromCurvature = 1;
Mesh.MinimumElementsPerTwoPi = 12;
Field[1] = Distance;
Field[1].FacesList = {bar()};
Field[2] = Threshold;
Field[2].IField = 1;
Field[2].LcMin = 0.15;
Field[2].LcMax = 0.5;
Field[2].DistMin = 0.1;
Field[2].DistMax = 1.0;
Background Field = 2;
