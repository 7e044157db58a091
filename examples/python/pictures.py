# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of triangles for the scripts beside this one: by matplotlib as PNG where it is installed, else as SVG."""
import importlib.util

import numpy

ALONG = numpy.array([0.62, 0.45, -0.64])  # from the eye, which is above
LIGHT = numpy.array([0.3, 0.8, -0.52])


def seen_from_the_eye(corners):
    """Right, up and depth of points."""
    forward = ALONG / numpy.linalg.norm(ALONG)
    right = numpy.cross([0, 0, 1], forward)
    right /= numpy.linalg.norm(right)
    return corners @ numpy.stack([right, numpy.cross(forward, right), forward], axis=1)


def shades(corners):
    """How bright triangles (n, 3, 3) are, from 0.35 to 1."""
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = numpy.linalg.norm(normals, axis=1)
    facing = abs(normals @ LIGHT) / numpy.where(lengths > 0, lengths, 1) / numpy.linalg.norm(LIGHT)
    return 0.35 + 0.65 * facing


def draw(scenes, name, colours=None):
    """Draws scenes, triangles (n, 3, 3) each, side by side. `colours`: (n, 3) for each, from 0 to 1. Returns the file."""
    flat = [seen_from_the_eye(corners) for corners in scenes]
    if colours is None:
        colours = [numpy.tile([0.93, 0.55, 0.25], (len(corners), 1)) for corners in scenes]
    colours = [each * shades(corners)[:, None] for each, corners in zip(colours, scenes)]
    orders = [numpy.argsort(-corners[:, :, 2].mean(axis=1)) for corners in flat]  # what is behind comes first
    painted = [(corners[order, :, :2], colour[order]) for corners, colour, order in zip(flat, colours, orders)]
    if importlib.util.find_spec("matplotlib"):
        return by_matplotlib(painted, name + ".png")
    return as_svg(painted, name + ".svg")


def by_matplotlib(painted, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.collections import PolyCollection

    figure, axes = pyplot.subplots(1, len(painted), figsize=(4 * len(painted), 4), squeeze=False)
    for axis, (corners, colours) in zip(axes[0], painted):
        axis.add_collection(PolyCollection(corners, facecolors=colours, edgecolors=colours * 0.7, linewidths=0.3))
        axis.autoscale_view()
        axis.set_aspect("equal")
        axis.axis("off")
    figure.savefig(path, dpi=120)
    return path


def as_svg(painted, path, size=400):
    low = numpy.min([corners.reshape(-1, 2).min(axis=0) for corners, colours in painted], axis=0)
    high = numpy.max([corners.reshape(-1, 2).max(axis=0) for corners, colours in painted], axis=0)
    scale = 0.9 * size / (high - low).max()
    with open(path, "w", encoding="utf-8") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{size * len(painted)}" height="{size}">\n')
        for k, (corners, colours) in enumerate(painted):
            places = (corners - (low + high) / 2) * scale * [1, -1] + [size * (k + 0.5), size / 2]
            for triangle, colour in zip(places, (255 * colours).astype(int)):
                points = " ".join(f"{x:.1f},{y:.1f}" for x, y in triangle)
                paint = "#%02x%02x%02x" % tuple(colour)
                file.write(f'<polygon points="{points}" fill="{paint}" stroke="{paint}" stroke-width="0.5"/>\n')
        file.write("</svg>\n")
    return path
