"""What a body must fulfil: closed, 2-manifold, no crossing of its own triangles; and its girths."""
import numpy as np


def edge_counts(triangles):
    pairs = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, directed = np.unique(pairs, axis=0, return_counts=True)
    _, counts = np.unique(np.sort(pairs, 1), axis=0, return_counts=True)
    return counts, directed


def is_closed_manifold(vertices, triangles):
    """Each edge has two faces of opposite direction, each vertex one ring; Euler number 2."""
    counts, directed = edge_counts(triangles)
    if (counts != 2).any() or (directed != 1).any():
        return False
    if len(vertices) - len(counts) + len(triangles) != 2:
        return False
    following = {(t[k], t[(k + 1) % 3]): t[(k + 2) % 3]
                 for t in triangles.tolist() for k in range(3)}
    valence = np.bincount(triangles.ravel(), minlength=len(vertices))
    start = {}
    for a, b in following:
        start.setdefault(a, b)
    for a, first in start.items():  # walk around the vertex: the ring must hold all its faces
        b, steps = following[(a, first)], 1
        while b != first:
            b, steps = following[(a, b)], steps + 1
        if steps != valence[a]:
            return False
    return True


def volume(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6)


def candidate_pairs(low, high, cell):
    """Pairs of boxes that overlap, found through the cells of a grid."""
    first = np.floor(low / cell).astype(np.int64)
    last = np.floor(high / cell).astype(np.int64)
    span = last - first + 1
    count = span.prod(1)
    owner = np.repeat(np.arange(len(low)), count)
    local = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    sx, sy = span[owner, 0], span[owner, 1]
    key = first[owner] + np.stack([local % sx, local // sx % sy, local // (sx * sy)], -1)
    code = (key[:, 0] + 4096) << 40 | (key[:, 1] + 4096) << 20 | (key[:, 2] + 4096)
    order = np.argsort(code, kind='stable')
    code, owner = code[order], owner[order]
    pairs = []
    for shift in range(1, len(code)):  # neighbours in the sorted list that are in the same cell
        same = np.flatnonzero(code[shift:] == code[:-shift])
        if not len(same):
            break
        pairs.append(np.stack([owner[same], owner[same + shift]], -1))
    pairs = np.unique(np.sort(np.concatenate(pairs), 1), axis=0)
    a, b = pairs[:, 0], pairs[:, 1]
    return pairs[((low[a] <= high[b]) & (low[b] <= high[a])).all(1)]


def segment_hits(p, q, a, b, c):
    """Whether segments p-q pass through triangles a, b, c (Moeller and Trumbore 1997)."""
    d, e1, e2 = q - p, b - a, c - a
    h = np.cross(d, e2)
    det = (e1 * h).sum(1)
    with np.errstate(divide='ignore', invalid='ignore'):
        s = p - a
        u = (s * h).sum(1) / det
        r = np.cross(s, e1)
        v = (d * r).sum(1) / det
        t = (e2 * r).sum(1) / det
        return (np.abs(det) > 0) & (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= 1)


def crossing_pairs(vertices, triangles):
    """Pairs of faces without a common vertex of which an edge of one passes through the other."""
    corner = vertices[triangles]
    low, high = corner.min(1), corner.max(1)
    pairs = candidate_pairs(low, high, 1.5 * np.median((high - low).max(1)))
    shared = (triangles[pairs[:, 0]][:, :, None] == triangles[pairs[:, 1]][:, None]).any((1, 2))
    pairs = pairs[~shared]
    hit = np.zeros(len(pairs), bool)
    for x, y in ((0, 1), (1, 0)):
        f, g = corner[pairs[:, x]], corner[pairs[:, y]]
        for k in range(3):
            hit |= segment_hits(f[:, k], f[:, (k + 1) % 3], g[:, 0], g[:, 1], g[:, 2])
    return pairs[hit]


def girth(vertices, triangles, point, normal, reach=None):
    """Tape measure: the convex outline of the cut through `point`, of what is within `reach`."""
    corner = vertices[triangles]
    side = (corner - point) @ normal
    points = []
    for k in range(3):
        a, b = side[:, k], side[:, (k + 1) % 3]
        cut = (a < 0) != (b < 0)
        t = (a / np.where(a == b, 1, a - b))[cut, None]
        points.append(corner[cut, k] + t * (corner[cut, (k + 1) % 3] - corner[cut, k]))
    points = np.concatenate(points)
    if reach:
        points = points[np.linalg.norm(points - point, axis=1) < reach]
    u = np.cross(normal, [0, 0, 1.]) if abs(normal[2]) < .9 else np.array([1., 0, 0])
    u /= np.linalg.norm(u)
    return hull_length(np.stack([points @ u, points @ np.cross(normal, u)], -1))


def hull_length(points):
    points = sorted(map(tuple, points.tolist()))
    ring = []
    for sweep in (points, points[::-1]):
        chain = []
        for p in sweep:
            while len(chain) > 1 and ((chain[-1][0] - chain[-2][0]) * (p[1] - chain[-2][1])
                                      - (chain[-1][1] - chain[-2][1]) * (p[0] - chain[-2][0])) <= 0:
                chain.pop()
            chain.append(p)
        ring += chain[:-1]
    ring = np.array(ring)
    return float(np.linalg.norm(ring - np.roll(ring, 1, 0), axis=1).sum())
