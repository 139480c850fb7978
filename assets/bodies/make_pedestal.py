#!/usr/bin/env python3
"""Makes pedestal.obj: a small round table with a rounded rim, on which fabrics are draped.

A surface of revolution around y: top at y = 0, radius 9 cm as the support of Cusick's drape test,
a stem and a foot. Metres. Usage: make_pedestal.py [pedestal.obj]
"""
import math
import sys

SIDES = 64
RIM = 0.006  # radius of the rounded rim [m]


def profile():
    """Radius and height from the middle of the top down to the middle of the foot."""
    points = [(r, 0.0) for r in (0.02, 0.04, 0.06, 0.075)]
    for k in range(7):
        a = math.pi * k / 6
        points.append((0.09 - RIM + RIM * math.sin(a), -RIM + RIM * math.cos(a)))
    points += [(0.06, -2 * RIM), (0.02, -0.02), (0.015, -0.04), (0.015, -0.24), (0.02, -0.26)]
    points += [(0.07, -0.268), (0.075, -0.272), (0.075, -0.28), (0.04, -0.28)]
    return points


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "pedestal.obj"
    rings = profile()
    with open(path, "w") as out:
        out.write("# round table, made by make_pedestal.py; metres, Y up\n")
        out.write("g obstacle:pedestal\n")
        out.write("v 0 0 0\n")
        for r, y in rings:
            for k in range(SIDES):
                a = 2 * math.pi * k / SIDES
                out.write("v %.6f %.6f %.6f\n" % (r * math.cos(a), y, -r * math.sin(a)))
        last = len(rings) * SIDES + 2
        out.write("v 0 %.6f 0\n" % rings[-1][1])
        for k in range(SIDES):
            n = (k + 1) % SIDES
            out.write("f 1 %d %d\n" % (2 + k, 2 + n))
            for i in range(len(rings) - 1):
                a, b = 2 + i * SIDES + k, 2 + i * SIDES + n
                out.write("f %d %d %d\n" % (a, a + SIDES, b + SIDES))
                out.write("f %d %d %d\n" % (a, b + SIDES, b))
            end = last - SIDES
            out.write("f %d %d %d\n" % (last, end + n, end + k))


main()
