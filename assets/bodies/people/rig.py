"""Bones of a person and the weights with which they move the vertices.

Weights are heat (Baran and Popovic 2007, "bone heat"): each vertex is warmed by the nearest bone
that it sees through the body, and the heat spreads over the surface, which makes them smooth at
joints.
"""
import numpy as np

from field import vec
from remesh import edges_of

# Name, joint at its head, joint at its tail, parent, thickness of the body around it [m].
MIDDLE = [('hips', 'hips', 'spine', None, .140), ('spine', 'spine', 'chest', 'hips', .115),
          ('chest', 'chest', 'neck', 'spine', .120), ('neck', 'neck', 'head', 'chest', .055),
          ('head', 'head', 'top', 'neck', .080)]
SIDE = [('clavicle', 'clavicle', 'shoulder', 'chest', .060),
        ('upper_arm', 'shoulder', 'elbow', 'clavicle', .045),
        ('forearm', 'elbow', 'wrist', 'upper_arm', .036), ('hand', 'wrist', 'tip', 'forearm', .028),
        ('thigh', 'hip', 'knee', 'hips', .082), ('shin', 'knee', 'ankle', 'thigh', .050),
        ('foot', 'ankle', 'ball', 'shin', .036), ('toe', 'ball', 'toe', 'foot', .024)]
MOST = 4  # bones that move one vertex


class Rig:
    """names, parents (numbers, -1 for none), heads and tails (n, 3), thickness."""

    def __init__(self, person):
        joints = person['joints']
        rows = [(n, joints[a], joints[b], p, r) for n, a, b, p, r in MIDDLE]
        for suffix, mirror in (('.L', vec(1, 1, 1)), ('.R', vec(-1, 1, 1))):
            for n, a, b, p, r in SIDE:
                parent = p if p in ('hips', 'chest') else p + suffix
                rows.append((n + suffix, joints[a] * mirror, joints[b] * mirror, parent, r))
        self.names = [row[0] for row in rows]
        self.index = {name: k for k, name in enumerate(self.names)}
        self.parents = [self.index[row[3]] if row[3] else -1 for row in rows]
        self.heads = np.array([row[1] for row in rows])
        self.tails = np.array([row[2] for row in rows])
        self.thickness = np.array([row[4] for row in rows]) * person['scale']

    def skin(self, vertices, weights, rotations, positions):
        """Linear blend skinning: world rotations (bones, 3, 3) and positions of the joints."""
        moved = np.zeros_like(vertices)
        for bone in range(len(self.names)):
            w = weights[:, bone]
            used = w > 0
            at = (vertices[used] - self.heads[bone]) @ rotations[bone].T + positions[bone]
            moved[used] += w[used, None] * at
        return moved


def distances(rig, points):
    """Distance of each point to each bone, and the nearest point of the bone."""
    d = rig.tails - rig.heads
    t = np.clip(((points[:, None] - rig.heads) * d).sum(-1) / (d * d).sum(-1), 0, 1)
    nearest = rig.heads + t[..., None] * d
    return np.linalg.norm(points[:, None] - nearest, axis=-1), nearest


def warming_bones(rig, vertices, field):
    """The bone that warms each vertex, and its distance."""
    distance, nearest = distances(rig, vertices)
    order = np.argsort(distance / rig.thickness, axis=1)
    rows = np.arange(len(vertices))
    chosen = order[:, 0].copy()
    open_rows = rows
    for rank in range(6):  # the nearest one that is seen through the body
        bone = order[open_rows, rank]
        a, b = vertices[open_rows], nearest[open_rows, bone]
        seen = np.ones(len(open_rows), bool)
        for s in np.linspace(.08, .92, 10):
            seen &= field(a + s * (b - a)) < .001
        chosen[open_rows[seen]] = bone[seen]
        open_rows = open_rows[~seen]
        if not len(open_rows):
            break
    return chosen, distance[rows, chosen]


def heat_weights(rig, vertices, triangles, field):
    """Weights (vertices, bones): at most four a vertex, with the sum one."""
    chosen, distance = warming_bones(rig, vertices, field)
    area = np.zeros(len(vertices))
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    face_area = .5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    edges = edges_of(triangles)
    for k in range(3):
        np.add.at(area, triangles[:, k], face_area / 3)

    # Cotangents of the two angles opposite an edge; sharp angles are cut off.
    code = edges[:, 0] * len(vertices) + edges[:, 1]
    stiffness = np.zeros(len(edges))
    for k in range(3):
        i, j, o = triangles[:, k], triangles[:, (k + 1) % 3], triangles[:, (k + 2) % 3]
        u, v = vertices[i] - vertices[o], vertices[j] - vertices[o]
        cot = .5 * (u * v).sum(1) / (2 * face_area)
        at = np.searchsorted(code, np.minimum(i, j) * len(vertices) + np.maximum(i, j))
        np.add.at(stiffness, at, np.clip(cot, .05, 5))

    # The trunk is thick, so its heat would reach far: thighs would move the belly.
    trunk = np.isin(chosen, [rig.index[name] for name in ('hips', 'spine', 'chest')])
    heat = np.where(trunk, 2.5, 1.) * area / np.maximum(distance, .5 * rig.thickness[chosen]) ** 2
    right = np.zeros((len(vertices), len(rig.names)))
    right[np.arange(len(vertices)), chosen] = heat
    weights = solve(edges, stiffness, heat, right)
    return limited(weights)


def solve(edges, stiffness, heat, right, tolerance=1e-6):
    """Conjugate gradients for (Laplacian + heat) x = right, all columns at once."""
    n = len(heat)
    row = np.concatenate([edges[:, 0], edges[:, 1]])
    column = np.concatenate([edges[:, 1], edges[:, 0]])
    value = np.concatenate([stiffness, stiffness])
    order = np.argsort(row, kind='stable')
    row, column, value = row[order], column[order], value[order, None]
    starts = np.searchsorted(row, np.arange(n))
    diagonal = (heat + np.add.reduceat(value[:, 0], starts))[:, None]

    def apply(x):
        return diagonal * x - np.add.reduceat(value * x[column], starts, axis=0)
    x = right / heat[:, None]
    r = right - apply(x)
    z = r / diagonal
    p, rz = z.copy(), (r * z).sum(0)
    limit = tolerance ** 2 * (right * right / diagonal).sum(0)
    for _ in range(1000):
        q = apply(p)
        alpha = rz / np.maximum((p * q).sum(0), 1e-300)
        x += alpha * p
        r -= alpha * q
        z = r / diagonal
        new = (r * z).sum(0)
        if (new <= limit).all():
            break
        p = z + new / np.maximum(rz, 1e-300) * p
        rz = new
    return x


def limited(weights, least=.004):
    """The largest four weights of each vertex, those that matter, with the sum one."""
    weights = np.clip(weights, 0, 1)
    fourth = np.sort(weights, axis=1)[:, -MOST]
    weights = np.where((weights >= fourth[:, None]) & (weights > least), weights, 0)
    return weights / weights.sum(1, keepdims=True)
