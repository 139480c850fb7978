"""Poses: arms by angles, legs by where the feet are (inverse kinematics), and tracks of keys.

A pose holds, for each bone, the rotation against its parent about axes that are the world's in the
rest pose, and the place of the hips. Angles are in degrees. Lengths are those of a person whose hip
joints are at 0.885 m; `Poser` scales them.
"""
import numpy as np

from field import unit, vec
from persons import ARM


def turn(axis, angle):
    """Rotation matrix about a unit axis."""
    x, y, z = axis
    a = np.radians(angle)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(a) * k + (1 - np.cos(a)) * (k @ k)


def bend(forward, left, side):
    """Forward about x, to the person's left about y, towards her left side about -z."""
    return turn((0, 1, 0), left) @ turn((0, 0, 1), -side) @ turn((1, 0, 0), forward)


def between(a, b):
    """The shortest rotation that takes direction a to b."""
    axis = np.cross(a, b)
    size = np.linalg.norm(axis)
    if size < 1e-9:
        return np.eye(3)
    return turn(axis / size, np.degrees(np.arctan2(size, a @ b)))


def smooth(x):
    """From 0 to 1 with no speed and no acceleration at both ends."""
    x = min(max(x, 0.), 1.)
    return x * x * x * (10 + x * (6 * x - 15))


def track(keys, t):
    """Values at keys [(time, value), ...] and smooth ways between them."""
    if t <= keys[0][0]:
        return np.array(keys[0][1], float)
    for (t0, a), (t1, b) in zip(keys[:-1], keys[1:]):
        if t < t1:
            s = smooth((t - t0) / (t1 - t0))
            return np.array(a, float) * (1 - s) + np.array(b, float) * s
    return np.array(keys[-1][1], float)


def frame(direction, hinge):
    d = unit(direction)
    h = unit(hinge - (hinge @ d) * d)
    return np.stack([d, h, np.cross(d, h)], 1)


class Poser:
    """Builds a pose of one rig, bone by bone from the hips outwards."""

    def __init__(self, rig):
        self.rig = rig
        self.scale = rig.heads[rig.index['thigh.L']][1] / .885
        self.local = {}
        self.world = {}
        self.place = {}

    def joint(self, name):
        return self.rig.heads[self.rig.index[name]]

    def parent(self, name):
        p = self.rig.parents[self.rig.index[name]]
        return self.rig.names[p] if p >= 0 else None

    def hips(self, offset=(0, 0, 0), rotation=np.eye(3)):
        self.place['hips'] = self.joint('hips') + self.scale * np.array(offset, float)
        self.local['hips'] = self.world['hips'] = rotation

    def set(self, name, local=np.eye(3)):
        parent = self.parent(name)
        self.local[name] = local
        self.world[name] = self.world[parent] @ local
        self.place[name] = (self.place[parent]
                            + self.world[parent] @ (self.joint(name) - self.joint(parent)))

    def set_world(self, name, world):
        self.set(name, self.world[self.parent(name)].T @ world)

    def arm(self, side, down, front, twist=0, elbow=0, wrist=0, out=0):
        """`down`: angle from hanging (90 is level); `front`: 0 sideways, 90 forwards, -90 back.

        `elbow` bends the forearm; with no twist it goes forwards when the arm is at the side. `out`
        leans the upper arm away from the trunk.
        """
        mirror = 1 if side == 'L' else -1
        rise = max(0., down - 60) * .22
        follow = .18 * front * np.sin(np.radians(min(down, 90)))
        self.set('clavicle.' + side, turn((0, 0, 1), mirror * rise)
                 @ turn((0, 1, 0), -mirror * follow))
        upper, fore = 'upper_arm.' + side, 'forearm.' + side
        rest = unit(self.joint(fore) - self.joint(upper))
        a, f = np.radians(down - rise), np.radians(front - follow)
        aim = vec(mirror * np.sin(a) * np.cos(f), -np.cos(a), np.sin(a) * np.sin(f))
        aim = unit(aim + vec(mirror * out, 0, 0))
        self.set(upper, between(ARM * vec(mirror, 1, 1), aim) @ turn(rest, -mirror * twist))
        hinge = unit(np.cross(rest, vec(0, 0, 1)))
        self.set(fore, turn(hinge, elbow))
        self.set('hand.' + side, turn(hinge, wrist))

    def leg(self, side, ball, yaw=0, heel=0, toe=None, aim=None):
        """The ball of the foot at `ball`, an offset from rest; `heel` lifts the heel by an angle.

        The knee points where the foot does, or to the angle `aim`.
        A foot that is not on the ground takes `toe` as the angle between toes and foot.
        """
        thigh, shin, foot, toes = (n + side for n in ('thigh.', 'shin.', 'foot.', 'toe.'))
        hip, knee, ankle, front = (self.joint(n) for n in (thigh, shin, foot, toes))
        self.set(thigh)
        world_foot = turn((0, 1, 0), yaw) @ turn((1, 0, 0), heel)
        target = front + self.scale * np.array(ball, float) + world_foot @ (ankle - front)

        # The knee is where both bones reach, in the plane of the foot's direction.
        start = self.place[thigh]
        upper, lower = np.linalg.norm(knee - hip), np.linalg.norm(ankle - knee)
        way = target - start
        length = min(np.linalg.norm(way), (upper + lower) * .9999)
        ahead = turn((0, 1, 0), yaw if aim is None else aim) @ vec(0, 0, 1)
        if abs(unit(way) @ ahead) > .7:  # a raised leg bends its knee upwards
            ahead = ahead + vec(0, 1, 0)
        hinge = unit(np.cross(ahead, unit(way)))
        along = (upper ** 2 - lower ** 2 + length ** 2) / (2 * length)
        aside = np.sqrt(max(upper ** 2 - along ** 2, 0))
        middle = start + along * unit(way) + aside * unit(np.cross(unit(way), hinge))
        end = start + length * unit(way)

        rest_hinge = unit(np.cross(vec(0, 0, 1), unit(ankle - hip)))
        self.set_world(thigh, frame(middle - start, hinge) @ frame(knee - hip, rest_hinge).T)
        self.set_world(shin, frame(end - middle, hinge) @ frame(ankle - knee, rest_hinge).T)
        self.set_world(foot, world_foot)
        self.set(toes, turn((1, 0, 0), -heel if toe is None else toe))
        return np.linalg.norm(end - target)

    def arrays(self):
        names = self.rig.names
        return (np.array([self.local[n] for n in names]), np.array([self.world[n] for n in names]),
                np.array([self.place[n] for n in names]))


def quaternion(m):
    """x, y, z, w of a rotation matrix."""
    candidates = np.array([m[0, 0] - m[1, 1] - m[2, 2], m[1, 1] - m[0, 0] - m[2, 2],
                           m[2, 2] - m[0, 0] - m[1, 1], m.trace()])
    k = int(np.argmax(candidates))
    size = .5 * np.sqrt(1 + candidates[k])
    if k == 3:
        xyz = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]) / (4 * size)
        return np.array([*xyz, size])
    i, j, l = k, (k + 1) % 3, (k + 2) % 3
    q = np.empty(4)
    q[i] = size
    q[j] = (m[i, j] + m[j, i]) / (4 * size)
    q[l] = (m[i, l] + m[l, i]) / (4 * size)
    q[3] = (m[l, j] - m[j, l]) / (4 * size)
    return q
