# SPDX-License-Identifier: BSD-3-Clause
"""Writes small CAD models whose closest points have formulas, with Gmsh's OpenCASCADE: cad_samples.py DIRECTORY."""
import sys
from pathlib import Path

try:
    import gmsh
except ImportError:
    print("python3-gmsh is not installed: no CAD samples")
    raise SystemExit(77)

MILLIMETRE = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) )"
METRE = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.) )"
INCH = "( CONVERSION_BASED_UNIT('INCH',#9001) LENGTH_UNIT() NAMED_UNIT(#9002) )"
INCH_IN_MILLIMETRES = f"""#9001 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9003);
#9002 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);
#9003 = {MILLIMETRE};
ENDSEC;
END-ISO"""


def sphere(occ):
    occ.addSphere(0.1, 0.2, 0.3, 1)


def cylinder(occ):
    occ.addCylinder(0, 0, -1, 0, 0, 2, 0.5)


def torus(occ):
    occ.addTorus(0, 0, 0, 1, 0.25)


def rounded_box(occ):
    box = occ.addBox(-1.5, -1, -0.5, 3, 2, 1)
    occ.synchronize()
    occ.fillet([box], [tag for _, tag in gmsh.model.getEntities(1)], [0.2])


def plate(occ):
    occ.cut([(3, occ.addBox(-1, -1, -0.25, 2, 2, 0.5))], [(3, occ.addCylinder(0, 0, -1, 0, 0, 2, 0.5))])


def ellipsoid(occ):
    ball = occ.addSphere(0, 0, 0, 1)
    occ.dilate([(3, ball)], 0, 0, 0, 1, 3, 2)  # makes it a spline


def write(directory, make, *endings):
    gmsh.model.add(make.__name__)
    make(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    for ending in endings:
        gmsh.write(str(directory / f"{make.__name__}.{ending}"))


def other_units(directory):
    text = (directory / "sphere.step").read_text()
    assert text.count(MILLIMETRE) == 1
    (directory / "sphere_metre.step").write_text(text.replace(MILLIMETRE, METRE))
    inch = text.replace(MILLIMETRE, INCH).replace("ENDSEC;\nEND-ISO", INCH_IN_MILLIMETRES)
    (directory / "sphere_inch.step").write_text(inch)


def main():
    directory = Path(sys.argv[1])
    directory.mkdir(parents=True, exist_ok=True)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    write(directory, sphere, "step", "brep")
    for make in (cylinder, torus, rounded_box, plate, ellipsoid):
        write(directory, make, "step")
    other_units(directory)
    gmsh.finalize()


main()
