// A cylinder of radius 0.5 and height 1 between its head (below) and a piston.
// gmsh -3 piston.geo -o piston.msh
SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 0, 0, 0, 1, 0.5};

eps = 1e-3;
head() = Surface In BoundingBox{-0.5 - eps, -0.5 - eps, -eps, 0.5 + eps, 0.5 + eps, eps};
piston() = Surface In BoundingBox{-0.5 - eps, -0.5 - eps, 1 - eps, 0.5 + eps, 0.5 + eps, 1 + eps};
wall() = Boundary{ Volume{1}; };
wall() -= head();
wall() -= piston();
Physical Volume("gas", 10) = {1};
Physical Surface("head", 1) = {head()};
Physical Surface("piston", 2) = {piston()};
Physical Surface("wall", 3) = {wall()};

Mesh.CharacteristicLengthMax = 0.16;
