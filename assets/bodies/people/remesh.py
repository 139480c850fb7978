"""Even triangles of a wanted size, finer where the shape is fine, on the surface of a field.

Rounds of four passes (Botsch and Kobbelt 2004): collapse short edges, split long ones, flip edges
for valences near six, smooth along the surface and put the vertices back onto it. An edge is
collapsed only where the surface stays closed and 2-manifold, and no pass may fold a triangle over.
"""
import math

import numpy as np

from picture import vertex_normals
from surface import project


def remesh(vertices, triangles, size, field, rounds=6):
    """`size(points)` is the wanted edge length at each of the points."""
    for turn in range(rounds):
        mesh = Mesh(vertices, triangles, size(vertices))
        mesh.collapse_short(4 / 5)
        mesh.split_long(4 / 3)
        mesh.flip_for_valence()
        vertices, triangles = mesh.arrays()
        for _ in range(4):
            vertices = smooth(vertices, triangles, field)
        if turn == rounds - 1:
            vertices = project(field, vertices, 3)
    return vertices, triangles


def edges_of(triangles):
    pairs = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(np.sort(pairs, 1), axis=0)


def smooth(vertices, triangles, field):
    """One step towards the mean of the neighbours, along the surface, then back onto it."""
    edges = edges_of(triangles)
    total = np.zeros_like(vertices)
    count = np.zeros(len(vertices))
    for a, b in ((0, 1), (1, 0)):
        np.add.at(total, edges[:, a], vertices[edges[:, b]])
        np.add.at(count, edges[:, a], 1)
    step = total / count[:, None] - vertices
    normals = vertex_normals(vertices, triangles)
    step -= (step * normals).sum(1)[:, None] * normals
    return project(field, vertices + .5 * step, 1)


def normal_of(a, b, c):
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    return (uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)


def agree(m, n, least=.5):
    """Whether two normals, of any length, make an angle of a cosine of `least` or more."""
    dot = m[0] * n[0] + m[1] * n[1] + m[2] * n[2]
    lengths = (m[0] ** 2 + m[1] ** 2 + m[2] ** 2) * (n[0] ** 2 + n[1] ** 2 + n[2] ** 2)
    return dot > 0 and dot * dot >= least * least * lengths and lengths > 0


class Mesh:
    """Triangles that can be changed one at a time: each vertex knows its faces."""

    def __init__(self, vertices, triangles, sizes):
        self.point = [tuple(v) for v in vertices.tolist()]
        self.size = sizes.tolist()
        self.face = [tuple(t) for t in triangles.tolist()]
        self.around = [set() for _ in self.point]
        for index, face in enumerate(self.face):
            for v in face:
                self.around[v].add(index)

    def arrays(self):
        """Vertices in use and their triangles."""
        kept = [v for v in range(len(self.point)) if self.around[v]]
        number = {v: n for n, v in enumerate(kept)}
        faces = [[number[v] for v in face] for face in self.face if face]
        return np.array([self.point[v] for v in kept]), np.array(faces)

    def neighbours(self, v):
        found = set()
        for index in self.around[v]:
            found.update(self.face[index])
        found.discard(v)
        return found

    def edges(self):
        return sorted({(min(a, b), max(a, b)) for f in self.face if f
                       for a, b in ((f[0], f[1]), (f[1], f[2]), (f[2], f[0]))})

    def set_face(self, index, face):
        for v in self.face[index] or ():
            self.around[v].discard(index)
        self.face[index] = face
        for v in face or ():
            self.around[v].add(index)

    def relative_length(self, a, b):
        return math.dist(self.point[a], self.point[b]) / (.5 * (self.size[a] + self.size[b]))

    # --- the passes ---

    def collapse_short(self, least):
        lengths = sorted((self.relative_length(a, b), a, b) for a, b in self.edges())
        for length, a, b in lengths:
            if length >= least:
                break
            if (self.around[a] and self.around[b]
                    and b in self.neighbours(a) and self.relative_length(a, b) < least):
                self.collapse(a, b)

    def collapse(self, a, b):
        """Moves both ends to the middle, unless that breaks the surface or makes a long edge."""
        near_a, near_b = self.neighbours(a), self.neighbours(b)
        if len(near_a & near_b) != 2 or len(near_a | near_b) < 6:
            return
        if min(len(self.around[v]) for v in near_a & near_b) <= 4:
            return
        middle = tuple(.5 * (x + y) for x, y in zip(self.point[a], self.point[b]))
        for v in (near_a | near_b) - {a, b}:
            if math.dist(self.point[v], middle) > 1.3 * self.size[v]:
                return
        shared = self.around[a] & self.around[b]
        for index in (self.around[a] | self.around[b]) - shared:
            before = [self.point[v] for v in self.face[index]]
            after = [middle if v in (a, b) else self.point[v] for v in self.face[index]]
            if not agree(normal_of(*before), normal_of(*after)):
                return
        self.point[a] = middle
        for index in shared:
            self.set_face(index, None)
        for index in list(self.around[b]):
            self.set_face(index, tuple(a if v == b else v for v in self.face[index]))

    def split_long(self, most):
        waiting = self.edges()
        while waiting:
            longest = []
            for a, b in waiting:
                if self.relative_length(a, b) > most:
                    self.split(a, b, longest)
            waiting = longest

    def split(self, a, b, created):
        middle = len(self.point)
        self.point.append(tuple(.5 * (x + y) for x, y in zip(self.point[a], self.point[b])))
        self.size.append(.5 * (self.size[a] + self.size[b]))
        self.around.append(set())
        for index in list(self.around[a] & self.around[b]):
            face = self.face[index]
            created.append((next(v for v in face if v not in (a, b)), middle))
            self.face.append(None)
            self.set_face(len(self.face) - 1, tuple(middle if v == a else v for v in face))
            self.set_face(index, tuple(middle if v == b else v for v in face))

    def flip_for_valence(self):
        for a, b in self.edges():
            pair = list(self.around[a] & self.around[b])
            if len(pair) == 2:
                self.flip(a, b, pair)

    def flip(self, a, b, pair):
        """Replaces the edge of two faces by their other diagonal where valences gain by it."""
        first, second = (self.face[index] for index in pair)
        at = first.index(a)
        if first[(at + 1) % 3] != b:
            first, second = second, first
        c = next(v for v in first if v not in (a, b))
        d = next(v for v in second if v not in (a, b))
        if d in self.neighbours(c):
            return
        valence = [len(self.around[v]) for v in (a, b, c, d)]
        now = sum((v - 6) ** 2 for v in valence)
        then = sum((v + e - 6) ** 2 for v, e in zip(valence, (-1, -1, 1, 1)))
        if then >= now or min(valence[:2]) <= 4:
            return
        p = self.point
        new = (normal_of(p[c], p[a], p[d]), normal_of(p[d], p[b], p[c]))
        old = (normal_of(p[a], p[b], p[c]), normal_of(p[b], p[a], p[d]))
        mean = tuple(old[0][k] + old[1][k] for k in range(3))
        if all(agree(n, mean, .85) for n in new) and agree(new[0], new[1], .85):
            self.set_face(pair[0], (c, a, d))
            self.set_face(pair[1], (d, b, c))
