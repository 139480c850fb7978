"""Building blocks of a body: distance estimates of simple shapes, and how they are joined.

A field is below zero inside. All functions take points as an array (n, 3) and return n values.
They estimate the distance to first order, which is what smooth joints and projection need.
"""
import numpy as np


def vec(*coordinates):
    return np.array(coordinates, float)


def unit(v):
    return v / np.linalg.norm(v)


def ellipsoid(p, center, radii, axes=None):
    """An ellipsoid; the rows of `axes` are its axes where they are not x, y and z."""
    local = p - center
    if axes is not None:
        local = local @ np.asarray(axes).T
    scaled = local / radii
    size = np.sqrt((scaled * scaled).sum(-1))
    slope = np.sqrt(((scaled / radii) ** 2).sum(-1))
    return size * (size - 1) / np.maximum(slope, 1e-9)


def cone(p, a, b, radius_a, radius_b):
    """A segment whose radius goes from `radius_a` to `radius_b`, with round ends."""
    d = b - a
    t = np.clip(((p - a) @ d) / (d @ d), 0, 1)
    return np.linalg.norm(p - (a + t[:, None] * d), axis=-1) - (radius_a
                                                                + t * (radius_b - radius_a))


def flat_cone(p, a, b, radius_a, radius_b, axis, thickness):
    """A cone that is `thickness` times as thick along the unit vector `axis` as across it."""
    def stretch(x):
        return x + (1 / thickness - 1) * (x @ axis)[..., None] * axis
    return cone(stretch(p), stretch(a), stretch(b), radius_a, radius_b) * min(thickness, 1)


def curve(points, per_piece=4):
    """A smooth (Catmull-Rom) curve through rows of numbers, `per_piece` steps between two rows."""
    rows = np.array(points, float)
    last = len(rows) - 1
    t = np.linspace(0, last, per_piece * last + 1)
    i = np.minimum(t.astype(int), last - 1)
    u = (t - i)[:, None]
    ends = np.concatenate([[2 * rows[0] - rows[1]], rows, [2 * rows[-1] - rows[-2]]])
    a, b, c, d = ends[i], ends[i + 1], ends[i + 2], ends[i + 3]
    return 0.5 * (2 * b + (c - a) * u + (2 * a - 5 * b + 4 * c - d) * u ** 2
                  + (3 * b - a - 3 * c + d) * u ** 3)


def limb(p, points, radii, per_piece=4):
    """A tube around a smooth curve: its distance less the radius where the curve is nearest."""
    rows = curve(np.column_stack([np.array(points), radii]), per_piece)
    nearest = np.full(len(p), np.inf)
    value = np.empty(len(p))
    for a, b in zip(rows[:-1], rows[1:]):
        d = b[:3] - a[:3]
        t = np.clip(((p - a[:3]) @ d) / (d @ d), 0, 1)
        distance = np.linalg.norm(p - (a[:3] + t[:, None] * d), axis=-1)
        closer = distance < nearest
        nearest[closer] = distance[closer]
        value[closer] = (distance - (a[3] + t * (b[3] - a[3])))[closer]
    return value


def join(a, b, width):
    """Smooth minimum: differs from min(a, b) only where they are closer than `width`."""
    h = np.maximum(width - np.abs(a - b), 0) / width
    return np.minimum(a, b) - h * h * width / 4


def carve(a, b, width):
    """What is in a and not in b, with a rounded edge."""
    return -join(-a, b, width)


def inside_box(p, low, high, shape):
    """`shape` inside a box that holds it with room for its joints; far away outside."""
    value = np.full(len(p), 1.0)
    near = ((p >= low) & (p <= high)).all(-1)
    if near.any():
        value[near] = shape(p[near])
    return value
