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

    def most(low, high, x=0., reach=None, pick=max):
        return pick(level(y, x, 0, reach) for y in np.linspace(low, high, 25))

    def across(a, b, reach, share):
        """Around the limb from a to b, at a share of its length."""
        return girth(vertices, triangles, a + share * (b - a), unit(b - a), reach)
    hip, knee, ankle, shoulder = j['hip'], j['knee'], j['ankle'], j['shoulder']
    wide = shoulder[0] + .02  # the trunk without the arms
    shin = knee - ankle
    return {
        'head with hair': most(j['head'][1] + .06, j['head'][1] + .13),
        'neck': across(j['neck'], j['head'], .12, .5),
        'bust or chest': most(j['chest'][1] + .02, j['chest'][1] + .09, 0, wide),
        'waist': most(j['spine'][1] - .02, j['chest'][1] - .02, 0, .25, min),
        'hip': most(hip[1] - .02, hip[1] + .10, 0, .30),
        'thigh': level(hip[1] - .11, hip[0], 0, .115 if hip[0] > .08 else .09),
        'knee': level(knee[1], knee[0], 0, .1),
        'calf': most(ankle[1] + .5 * shin[1], ankle[1] + .85 * shin[1],
                     .5 * (knee + ankle)[0], .1),
        'ankle': level(ankle[1] + .035, ankle[0], ankle[2], .08),
        'upper arm': across(shoulder, j['elbow'], .09, .45),
        'wrist': across(j['elbow'], j['wrist'], .08, .94)}


def print_girths(people):
    """A table in Markdown; `people` are pairs of a person and a body."""
    rows = [['', *(person['name'] for person, _ in people)], ['---'] * (len(people) + 1)]
    rows.append(['height', *('%.1f' % (100 * body[0][:, 1].max()) for _, body in people)])
    columns = [girths(person, *body[:2]) for person, body in people]
    for name in columns[0]:
        rows.append([name, *('%.1f' % (100 * column[name]) for column in columns)])
    rows.append(['volume [l]', *('%.1f' % (1000 * volume(*body[:2])) for _, body in people)])
    for row in rows:
        print('| ' + ' | '.join(row) + ' |')


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
        print('  %-7s %4.1f s, pairs that cross: at most %d, in %d of %d frames; lowest point '
              '%.1f mm; hands to %.2f m/s, %.0f mm from the body; feet slip to %.0f mm/s'
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
    def to_edge(u, v):
        d = v - u
        return np.linalg.norm(p - u - np.clip((p - u) @ d / (d @ d), 0, 1) * d)
    return min(to_edge(u, v) for u, v in ((a, b), (b, c), (c, a)))


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
