#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws how boundary facets sweep prisms and how these are split: docs/pictures/prisms.py docs/pictures/prisms.svg"""
import sys

HEIGHT = 110  # of a layer
EDGE = [(0, 0), (100, 0)]
TRIANGLE = [(0, 0), (110, 12), (62, -34)]
BELOW, ABOVE, SPLIT = "#3b78b0", "#2c8c6a", "#d07020"


def lifted(points):
    return [(x + 14, y - HEIGHT) for x, y in points]


def shifted(points, by):
    return [(x + by[0], y + by[1]) for x, y in points]


def line(a, b, colour="#444", width=1.6, dash=""):
    dash = f' stroke-dasharray="{dash}"' if dash else ""
    return (f'<line x1="{a[0]:.0f}" y1="{a[1]:.0f}" x2="{b[0]:.0f}" y2="{b[1]:.0f}" stroke="{colour}" '
            f'stroke-width="{width}"{dash}/>')


def area(points, colour):
    corners = " ".join(f"{x:.0f},{y:.0f}" for x, y in points)
    return f'<polygon points="{corners}" fill="{colour}" fill-opacity="0.3" stroke="{colour}" stroke-width="1.6"/>'


def text(x, y, words):
    return f'<text x="{x}" y="{y}" text-anchor="middle">{words}</text>'


def quadrilateral(x, words, split):
    below = shifted(EDGE, (x, 150))
    above = lifted(below)
    parts = [area([below[0], below[1], above[1], above[0]], "#999")]
    parts += [line(*below, BELOW, 4), line(*above, ABOVE, 4)]
    corners = below + above
    if split == "diagonal":
        parts.append(line(below[0], above[1], SPLIT, 2))
    if split == "centre":
        centre = tuple(sum(each) / 4 for each in zip(*corners))
        parts += [line(centre, corner, SPLIT, 2) for corner in corners]
        parts.append(f'<circle cx="{centre[0]:.0f}" cy="{centre[1]:.0f}" r="4" fill="{SPLIT}"/>')
    return parts + [text(x + 57, 185, words)]


def prism(x, words):
    below = shifted(TRIANGLE, (x, 395))
    above = lifted(below)
    parts = [area(below, BELOW)] + [line(a, b) for a, b in zip(below, above)] + [area(above, ABOVE)]
    return parts + [text(x + 62, 430, words)]


def split_prism(x, words):
    """Split A: three tetrahedra, drawn apart."""
    below = shifted(TRIANGLE, (x, 395))
    v, w = below, lifted(below)
    parts = []
    for k, corners in enumerate(([v[0], v[1], v[2], w[2]], [v[0], v[1], w[1], w[2]], [v[0], w[0], w[1], w[2]])):
        apart = shifted(corners, (150 * k, 0))
        colour = (BELOW, SPLIT, ABOVE)[k]
        parts.append(area(apart[:3], colour))
        parts += [line(a, apart[3], colour, 1.6) for a in apart[:3]]
    return parts + [text(x + 210, 430, words)]


def main():
    parts = quadrilateral(90, "an edge sweeps a quadrilateral", "") + quadrilateral(320, "split diagonal: 2 triangles", "diagonal")
    parts += quadrilateral(540, "split centre: 4 triangles", "centre")
    parts += prism(90, "a triangle sweeps a prism") + split_prism(310, "split A: 3 tetrahedra, drawn apart")
    parts += [line((30, 160), (30, 40), "#888"), line((30, 40), (26, 50), "#888"), line((30, 40), (34, 50), "#888"),
              text(18, 44, "t"), text(34, 14, "2D + t"), text(34, 240, "3D + t")]
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 445" width="760" height="445" role="img" '
                   'aria-label="Boundary facets sweep prisms, which are split into simplices" '
                   'font-family="sans-serif" font-size="14" fill="#333">\n<rect width="760" height="445" fill="#fff"/>\n')
        file.write("\n".join(parts) + "\n</svg>\n")


if __name__ == "__main__":
    main()
