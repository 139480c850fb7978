"""The clips: dance, walk and turn.

Each clip starts and ends in the rest pose (A-pose), in which garments are put on; in between a smooth
envelope brings the movement in and out. Clips are sampled at FPS keys a second.
"""
import numpy as np

from posing import Poser, bend, quaternion, smooth, track, turn

FPS = 24


def wave(t, period, phase=0.):
    return np.sin(2 * np.pi * (t / period + phase))


def envelope(t, length, fade):
    return smooth(t / fade) * smooth((length - t) / fade)


def torso(p, hips, spine=(0, 0, 0), chest=(0, 0, 0), neck=(0, 0, 0), head=(0, 0, 0), yaw=0.):
    """The middle of the body: place and tilt of the hips, then the tilts of what is above."""
    place, tilt = hips
    p.hips(place, turn((0, 1, 0), yaw) @ bend(*tilt))
    for name, angles in (('spine', spine), ('chest', chest), ('neck', neck), ('head', head)):
        p.set(name, bend(*angles))


def around(point, yaw, center=(0., 0., 0.)):
    """The offset of a foot that turns with the body about the vertical through `center`."""
    point, center = np.array(point, float), np.array(center, float)
    return center + turn((0, 1, 0), yaw) @ (point - center) - point


def steps(plan, t):
    """A foot from plan [(start, end, lift, value), ...]: it moves to each value in its time.

    Returns the value and how high the foot is.
    """
    value, height = np.array(plan[0][3], float), 0.
    for start, end, lift, goal in plan[1:]:
        if t <= start:
            break
        s = smooth((t - start) / (end - start))
        value = value * (1 - s) + np.array(goal, float) * s
        if t < end:
            u = (t - start) / (end - start)
            height = lift * (np.sin(np.pi * u) ** 2)
    return value, height


def dance(p, t, length=8.):
    """A sway from foot to foot, two seconds each way and back, with waving arms."""
    e = envelope(t, length, 1.4)
    s, c = wave(t, 2.), wave(t, 2., .25)
    quick = wave(t, 1., .25)
    torso(p, ((.055 * s * e, (-.024 - .008 * quick) * e, 0), (2 * e, 13 * wave(t, 4.) * e, 6 * s * e)),
          spine=(2 * e, -5 * wave(t, 4.) * e, -7 * s * e), chest=(-2 * e, -9 * wave(t, 4.) * e, -5 * s * e),
          neck=(0, 4 * wave(t, 4.) * e, 2 * s * e), head=(-2 * e, 8 * wave(t, 4., .05) * e, 4 * s * e))
    for side, k in (('L', 1), ('R', -1)):
        free = smooth(.5 - .75 * k * s)  # the foot without the weight
        p.arm(side, 45 + (22 + 24 * k * s) * e, (14 + 16 * k * c) * e, 20 * e, (28 + 18 * k * c) * e,
              10 * k * c * e)
        p.leg(side, (0, 0, 0), yaw=0, heel=(4 + 24 * free) * e)


def walk(p, t, length=6.):
    """Walking on the spot, a second a pair of steps: knees up, arms opposite to the legs."""
    e = envelope(t, length, 1.2)
    period = 1.2
    s = wave(t, period)
    bob = wave(t, period / 2, .25)
    torso(p, ((.022 * -s * e, (-.020 - .012 * bob) * e, 0), (3 * e, 6 * s * e, -3 * s * e)),
          spine=(1 * e, -5 * s * e, 2 * s * e), chest=(-1 * e, -7 * s * e, 2 * s * e),
          neck=(0, 3 * s * e, 0), head=(0, 3 * s * e, 0))
    for side, k in (('L', 1), ('R', -1)):
        up = max(0., k * s) ** 1.5 * e
        p.arm(side, 45 - 24 * e, -k * 30 * s * e * 1.0, 0, (16 - 9 * k * s) * e)
        p.leg(side, (0, .15 * up, .045 * up), heel=34 * up, toe=-10 * up)


def turning(p, t, length=9.):
    """A slow turn on the spot, by small steps, with the arms a little lifted."""
    e = envelope(t, length, 1.3)
    count, first, last = 20, .9, length - .9
    beat = (last - first) / count
    yaw = 360 * smooth_linear((t - first) / (last - first))
    sway = wave(t - first, 2 * beat) * e
    place = -.022 * sway * (turn((0, 1, 0), yaw) @ np.array([1., 0, 0]))
    torso(p, (place + [0, -.010 * e, 0], (0, 0, 2.5 * sway)), chest=(-1 * e, 0, -3 * sway),
          head=(0, 10 * e, 0), yaw=yaw)
    for side, k in (('L', 1), ('R', -1)):
        plan = [(0, 0, 0, [0.])]
        for n in range(count):
            if (n % 2 == 0) == (k > 0):
                goal = min(360. * (n + 1.5) / count, 360) if n + 2 < count else 360.
                plan.append((first + n * beat, first + (n + .95) * beat, .035, [goal]))
        angle, lift = steps(plan, t)
        rest = p.joint('toe.' + side) / p.scale
        ball = around([rest[0], 0, rest[2]], angle[0], (0, 0, -.01))
        p.arm(side, 45 + 18 * e + 4 * k * sway, 8 * e, 10 * e, 14 * e, -8 * e)
        p.leg(side, ball + [0, lift, 0], yaw=angle[0], heel=4 * e + 220 * lift,
              aim=.5 * (yaw + angle[0]))


def smooth_linear(x, ramp=.12):
    """From 0 to 1 at a steady speed, smoothly brought in and out."""
    x = min(max(x, 0.), 1.)
    speed = 1 / (1 - ramp)

    def distance(u):  # along a ramp of the speed from 0 to 1
        return u ** 4 * (2.5 - 3 * u + u * u) * ramp
    if x < ramp:
        return speed * distance(x / ramp)
    if x > 1 - ramp:
        return 1 - speed * distance((1 - x) / ramp)
    return speed * (x - ramp / 2)


CLIPS = dict(dance=(dance, 8.), walk=(walk, 6.), turn=(turning, 9.))


def clips_of(name):
    return list(CLIPS)


def sample(rig, name):
    """times, local quaternions (frames, bones, 4), places of the hips, world rotations, joints."""
    clip, length = CLIPS[name]
    times = np.arange(int(round(length * FPS)) + 1) / FPS
    local, world, joints = [], [], []
    for t in times:
        p = Poser(rig)
        clip(p, t)
        l, w, j = p.arrays()
        local.append([quaternion(m) for m in l])
        world.append(w)
        joints.append(j)
    local, joints = np.array(local), np.array(joints)

    # The sign of a quaternion is free: take the one next to the key before.
    for n in range(1, len(local)):
        local[n][(local[n] * local[n - 1]).sum(-1) < 0] *= -1
    return times, local, joints[:, 0], np.array(world), joints
