"""What the script prints about a body: girths, and how sound its shape and its clips are."""
import numpy as np

from checks import crossing_pairs, girth, is_closed_manifold, volume
from field import unit, vec
from motions import FPS, sample
from rig import Rig


def girths(person, vertices, triangles):
    """Name -> circumference [m], as a tape would take it."""
    j = person['joints']
    up = vec(0, 1, 0)

    def level(y, x=0., z=0., reach=None):
        return girth(vertices, triangles, vec(x, y, z), up, reach)

    def widest(low, high, x=0., reach=None, pick=max):
        return pick(level(y, x, 0, reach) for y in np.linspace(low, high, 25))
    hip, knee, ankle, shoulder = j['hip'], j['knee'], j['ankle'], j['shoulder']
    wide = shoulder[0] + .02  # the trunk without the arms
    shin = knee - ankle
    arm = unit(j['elbow'] - shoulder)
    neck_axis = unit(j['head'] - j['neck'])
    found = {
        'head': widest(j['head'][1] + .06, j['head'][1] + .13),
        'neck': girth(vertices, triangles, .5 * (j['neck'] + j['head']), neck_axis, .12),
        'bust' if person['female'] else 'chest': widest(j['chest'][1] + .02, j['chest'][1] + .09, 0, wide),
        'waist': widest(j['spine'][1] - .02, j['chest'][1] - .02, 0, .25, min),
        'hip': widest(hip[1] - .02, hip[1] + .10, 0, .30),
        'thigh': level(hip[1] - .11, hip[0], 0, .115 if hip[0] > .08 else .09),
        'knee': level(knee[1], knee[0], 0, .1),
        'calf': widest(ankle[1] + .5 * shin[1], ankle[1] + .85 * shin[1], .5 * (knee + ankle)[0], .1),
        'ankle': level(ankle[1] + .035, ankle[0], ankle[2], .08),
        'upper arm': girth(vertices, triangles, shoulder + .45 * (j['elbow'] - shoulder), arm, .09),
        'wrist': girth(vertices, triangles, j['wrist'], unit(j['wrist'] - j['elbow']), .08)}
    return found


def print_girths(person, body):
    vertices, triangles, _ = body
    print('%s: height %.3f m, volume %.1f l' % (person['name'], vertices[:, 1].max(),
                                                1000 * volume(vertices, triangles)))
    for name, value in girths(person, vertices, triangles).items():
        print('  %-10s %5.1f cm' % (name, 100 * value))


def print_checks(person, body, clips):
    vertices, triangles, weights = body
    edges = np.linalg.norm(vertices[triangles] - vertices[np.roll(triangles, 1, 1)], axis=2)
    print('%s: %d vertices, %d triangles, closed and manifold: %s, pairs that cross at rest: %d, '
          'edges %.1f to %.1f mm' % (person['name'], len(vertices), len(triangles),
                                     is_closed_manifold(vertices, triangles),
                                     len(crossing_pairs(vertices, triangles)),
                                     1000 * edges.min(), 1000 * edges.max()))
    rig = Rig(person)
    bone = weights.argmax(1)
    arms = np.isin(bone, [rig.index[n + s] for n in ('forearm', 'hand') for s in ('.L', '.R')])
    trunk = ~arms & ~np.isin(bone, [rig.index['upper_arm' + s] for s in ('.L', '.R')])
    for clip in clips:
        times, local, _, world, joints = sample(rig, clip)
        frames = [rig.skin(vertices, weights, w, j) for w, j in zip(world, joints)]
        pairs = [len(crossing_pairs(f, triangles)) for f in frames[::5]]
        print('  %-7s %4.1f s, pairs that cross: at most %d, in %d of %d frames; lowest point %.1f mm; '
              'hands to %.2f m/s, %.0f mm from the body; feet slip to %.0f mm/s'
              % (clip, times[-1], max(pairs), sum(n > 0 for n in pairs), len(pairs),
                 1000 * min(f[:, 1].min() for f in frames), hand_speed(rig, joints),
                 1000 * min(gap(f, triangles, arms, trunk) for f in frames[::5]),
                 1000 * slip(rig, joints)))


def gap(vertices, triangles, arms, trunk):
    """The least distance from vertices of the lower arms to the trunk, the legs and the head.

    Distances to vertices find the closest places, the faces around these give the distance.
    """
    a, others = vertices[arms], np.flatnonzero(trunk)
    b = vertices[others]
    near = b - .5 * (a.min(0) + a.max(0))
    keep = (np.abs(near) < .5 * (a.max(0) - a.min(0)) + .1).all(1)
    others, b = others[keep], b[keep]
    square = (a * a).sum(1)[:, None] + (b * b).sum(1) - 2 * a @ b.T
    nearest = square.argmin(1)
    first = np.argsort(square[np.arange(len(a)), nearest])[:12]
    least = np.inf
    for p, v in zip(a[first], others[nearest[first]]):
        for face in triangles[(triangles == v).any(1)]:
            least = min(least, point_triangle(p, *vertices[face]))
    return least


def point_triangle(p, a, b, c):
    """Distance of a point to a triangle, by its edges and by its plane."""
    n = unit(np.cross(b - a, c - a))
    inside = all(np.cross(v - u, p - u) @ n >= 0 for u, v in ((a, b), (b, c), (c, a)))
    if inside:
        return abs((p - a) @ n)
    return min(np.linalg.norm(p - u - np.clip((p - u) @ (v - u) / ((v - u) @ (v - u)), 0, 1) * (v - u))
               for u, v in ((a, b), (b, c), (c, a)))


def hand_speed(rig, joints):
    speed = [np.linalg.norm(np.diff(joints[:, rig.index['hand' + s]], axis=0), axis=1).max() * FPS
             for s in ('.L', '.R')]
    return max(speed)


def slip(rig, joints):
    """The fastest horizontal move of a ball of a foot that is on the ground in two keys."""
    most = 0.
    for s in ('.L', '.R'):
        ball = joints[:, rig.index['toe' + s]]
        down = ball[:, 1] < rig.heads[rig.index['toe' + s]][1] + .002
        speed = np.linalg.norm(np.diff(ball[:, [0, 2]], axis=0), axis=1) * FPS
        stays = down[1:] & down[:-1]
        most = max(most, speed[stays].max() if stays.any() else 0)
    return most
