#!/usr/bin/env python3
"""Makes bust.obj: a dress form with a head, on which scarves and garments are tried.

The body is the zero level of a field: ellipsoids and round cones, blended smoothly and cut at the
waist. It is meshed by surface nets (one vertex a cell that the surface crosses), then the triangles
are evened out by edge flips and tangential smoothing, each vertex being put back onto the surface.

Metres, Y up, facing +z, base at y = 1.0, top of the head at about y = 1.75.
Usage: make_bust.py [bust.obj]
"""
import math
import sys

CELL = 0.0182  # of the meshing grid [m]; the edges come out about as long
LOW = (-0.30, 0.94, -0.22)
HIGH = (0.30, 1.82, 0.24)
BASE = 1.0
ROUNDS = 20  # of flips and smoothing


def ellipsoid(p, center, radii):
    """Distance estimate, exact to first order at the surface."""
    q = [(p[k] - center[k]) / radii[k] for k in range(3)]
    scaled = math.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2)
    slope = math.sqrt(sum((q[k] / radii[k]) ** 2 for k in range(3)))
    return scaled * (scaled - 1) / slope if slope > 0 else -min(radii)


def round_cone(p, a, b, ra, rb):
    """Distance to a segment whose radius goes from ra to rb."""
    d = [b[k] - a[k] for k in range(3)]
    t = sum((p[k] - a[k]) * d[k] for k in range(3)) / sum(x * x for x in d)
    t = min(max(t, 0), 1)
    return math.dist(p, [a[k] + t * d[k] for k in range(3)]) - (ra + t * (rb - ra))


def blend(a, b, width):
    """Smooth minimum: differs from min(a, b) only where they are closer than `width`."""
    h = max(width - abs(a - b), 0) / width
    return min(a, b) - h * h * width / 4


def field(p):
    """Below 0 inside the body."""
    x, y, z = abs(p[0]), p[1], p[2]  # left and right are mirror images
    q = (x, y, z)
    body = blend(ellipsoid(q, (0, 0.95, -0.008), (0.176, 0.15, 0.118)),
                 ellipsoid(q, (0, 1.10, -0.006), (0.113, 0.20, 0.086)), 0.10)
    body = blend(body, ellipsoid(q, (0, 1.270, -0.014), (0.148, 0.170, 0.102)), 0.09)
    body = blend(body, ellipsoid(q, (0, 1.370, -0.024), (0.160, 0.085, 0.076)), 0.08)
    body = blend(body, ellipsoid(q, (0.070, 1.268, 0.050), (0.064, 0.070, 0.052)), 0.07)
    body = blend(body, ellipsoid(q, (0.150, 1.378, -0.024), (0.052, 0.066, 0.054)), 0.08)
    body = blend(body, round_cone(q, (0.02, 1.470, -0.034), (0.150, 1.415, -0.026), 0.034, 0.024),
                 0.05)
    neck = round_cone(q, (0, 1.40, -0.030), (0, 1.60, -0.006), 0.058, 0.054)
    head = blend(ellipsoid(q, (0, 1.652, -0.004), (0.076, 0.098, 0.096)),
                 ellipsoid(q, (0, 1.588, 0.030), (0.053, 0.066, 0.060)), 0.06)
    body = blend(body, neck, 0.055)
    body = blend(body, head, 0.030)
    return -blend(-body, y - BASE, 0.05)  # rounded cut at the base


def gradient(p, step=1e-5):
    g = []
    for k in range(3):
        a, b = list(p), list(p)
        a[k] -= step
        b[k] += step
        g.append((field(b) - field(a)) / (2 * step))
    return g


def project(p, times=1):
    """Newton steps onto the surface; returns the point and its unit normal."""
    for _ in range(times):
        g = gradient(p)
        square = max(sum(x * x for x in g), 1e-9)
        step = max(-0.25 * CELL, min(0.25 * CELL, field(p) / math.sqrt(square))) / math.sqrt(square)
        p = [p[k] - step * g[k] for k in range(3)]
    length = math.sqrt(max(sum(x * x for x in g), 1e-18))
    return p, [x / length for x in g]


def surface_nets():
    """One vertex in each cell with a sign change, one quad around each edge with one."""
    n = [math.ceil((HIGH[k] - LOW[k]) / CELL) + 1 for k in range(3)]

    def corner(i, j, k):
        return (LOW[0] + i * CELL, LOW[1] + j * CELL, LOW[2] + k * CELL)

    value = {(i, j, k): field(corner(i, j, k))
             for i in range(n[0]) for j in range(n[1]) for k in range(n[2])}
    vertices, number, faces = [], {}, []

    def cell_vertex(cell):
        if cell not in number:
            crossings = []
            ends = [(cell[0] + a, cell[1] + b, cell[2] + c)
                    for a in (0, 1) for b in (0, 1) for c in (0, 1)]
            for s in range(8):
                for t in range(s + 1, 8):
                    a, b = ends[s], ends[t]
                    if sum(abs(a[k] - b[k]) for k in range(3)) == 1:
                        va, vb = value[a], value[b]
                        if (va < 0) != (vb < 0):
                            w = va / (va - vb)
                            pa, pb = corner(*a), corner(*b)
                            crossings.append([pa[k] + w * (pb[k] - pa[k]) for k in range(3)])
            number[cell] = len(vertices)
            vertices.append([sum(c[k] for c in crossings) / len(crossings) for k in range(3)])
        return number[cell]

    for (i, j, k), v in value.items():
        for axis in range(3):
            end = [i, j, k]
            end[axis] += 1
            w = value.get(tuple(end))
            if w is None or (v < 0) == (w < 0):
                continue
            u, t = (axis + 1) % 3, (axis + 2) % 3
            ring = []
            for du, dt in ((0, 0), (-1, 0), (-1, -1), (0, -1)):
                cell = [i, j, k]
                cell[u] += du
                cell[t] += dt
                ring.append(cell_vertex(tuple(cell)))
            if w < v:
                ring.reverse()
            a, b, c, d = ring
            if math.dist(vertices[a], vertices[c]) < math.dist(vertices[b], vertices[d]):
                faces += [(a, b, c), (a, c, d)]
            else:
                faces += [(a, b, d), (b, c, d)]
    return vertices, faces


def flip_edges(vertices, faces):
    """Flips an edge where that brings the valences of the four vertices around closer to six."""
    valence = [0] * len(vertices)
    for f in faces:
        for v in f:
            valence[v] += 1
    owner = {}
    for index, f in enumerate(faces):
        for s in range(3):
            owner[(f[s], f[(s + 1) % 3])] = index
    flips = 0
    for (a, b), first in sorted(owner.items()):
        if a > b or (a, b) not in owner or (b, a) not in owner:
            continue
        first, second = owner[(a, b)], owner[(b, a)]
        c = next(v for v in faces[first] if v not in (a, b))
        d = next(v for v in faces[second] if v not in (a, b))
        if (c, d) in owner or (d, c) in owner:
            continue
        before = sum((valence[v] - 6) ** 2 for v in (a, b, c, d))
        after = ((valence[a] - 7) ** 2 + (valence[b] - 7) ** 2 +
                 (valence[c] - 5) ** 2 + (valence[d] - 5) ** 2)
        if after >= before or math.dist(vertices[c], vertices[d]) > 2 * CELL:
            continue
        del owner[(a, b)], owner[(b, a)]
        faces[first], faces[second] = (a, d, c), (d, b, c)
        for index in (first, second):
            f = faces[index]
            for s in range(3):
                owner[(f[s], f[(s + 1) % 3])] = index
        for v, change in ((a, -1), (b, -1), (c, 1), (d, 1)):
            valence[v] += change
        flips += 1
    return flips


def smooth(vertices, faces, normals):
    """Each vertex moves towards the area-weighted middle of its triangles, along the surface."""
    total = [[0.0, 0.0, 0.0, 0.0] for _ in vertices]
    for f in faces:
        a, b, c = (vertices[v] for v in f)
        e, g = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        area = math.sqrt((e[1] * g[2] - e[2] * g[1]) ** 2 + (e[2] * g[0] - e[0] * g[2]) ** 2 +
                         (e[0] * g[1] - e[1] * g[0]) ** 2)
        for v in f:
            for k in range(3):
                total[v][k] += area * (a[k] + b[k] + c[k]) / 3
            total[v][3] += area
    for v, p in enumerate(vertices):
        move = [0.7 * (total[v][k] / total[v][3] - p[k]) for k in range(3)]
        along = sum(move[k] * normals[v][k] for k in range(3))
        moved = [p[k] + move[k] - along * normals[v][k] for k in range(3)]
        vertices[v], normals[v] = project(moved, 2)


def make_bust():
    vertices, faces = surface_nets()
    normals = []
    for v, p in enumerate(vertices):
        vertices[v], normal = project(p, 4)
        normals.append(normal)
    for _ in range(ROUNDS):
        flip_edges(vertices, faces)
        smooth(vertices, faces, normals)
    return vertices, faces


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "bust.obj"
    vertices, faces = make_bust()
    with open(path, "w", encoding="ascii") as out:
        out.write("# dress form with head, made by make_bust.py; metres, Y up, facing +z\n")
        out.write("g obstacle:bust\n")
        for p in vertices:
            out.write("v %.6f %.6f %.6f\n" % tuple(p))
        for f in faces:
            out.write("f %d %d %d\n" % tuple(v + 1 for v in f))
    print(f"{path}: {len(vertices)} vertices, {len(faces)} triangles")


if __name__ == "__main__":
    main()
