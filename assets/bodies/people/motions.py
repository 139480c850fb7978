"""The clips: dance, walk, turn, kungfu and swing.

Each clip starts and ends in the rest pose (A-pose), in which garments are put on; in between a
smooth envelope brings the movement in and out. Clips are sampled at FPS keys a second.
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
    slow, quick = wave(t, 4.), wave(t, 1., .25)

    # The hips sway and turn; what is above leans and turns against them.
    torso(p, ((.055 * s * e, (-.024 - .008 * quick) * e, 0), (2 * e, 13 * slow * e, 6 * s * e)),
          spine=(2 * e, -5 * slow * e, -7 * s * e), chest=(-2 * e, -9 * slow * e, -5 * s * e),
          neck=(0, 4 * slow * e, 2 * s * e), head=(-2 * e, 8 * wave(t, 4., .05) * e, 4 * s * e))
    for side, k in (('L', 1), ('R', -1)):
        free = smooth(.5 - .75 * k * s)  # the foot without the weight
        p.arm(side, 45 + (22 + 24 * k * s) * e, (14 + 16 * k * c) * e, 20 * e,
              (28 + 18 * k * c) * e, 10 * k * c * e)
        p.leg(side, (0, 0, 0), yaw=0, heel=(4 + 24 * free) * e)


def walk(p, t, length=6.):
    """Walking on the spot, a second a pair of steps: knees up, arms opposite to the legs."""
    e = envelope(t, length, 1.2)
    period = 1.2
    s = wave(t, period)
    bob = wave(t, period / 2, .25)

    # The hips lean over the standing foot, and the shoulders turn against the hips.
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

    # The weight goes to the foot that stands.
    sway = wave(t - first, 2 * beat) * e
    place = -.022 * sway * (turn((0, 1, 0), yaw) @ np.array([1., 0, 0]))
    torso(p, (place + [0, -.010 * e, 0], (0, 0, 2.5 * sway)), chest=(-1 * e, 0, -3 * sway),
          head=(0, 10 * e, 0), yaw=yaw)

    # Left and right foot take turns; each step goes a little ahead of the body.
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


# Arms of the kung-fu clip: down, front, twist, elbow, wrist, out. An arm that goes back is one that
# goes forwards by a negative angle: so a punch passes the hip and not the side.
REST = (45, 0, 0, 0, 0, 0)
GUARD = (34, 18, 10, 80, 0, .10)
CHAMBER = (-34, 104, 20, 88, 0, .34)
PUNCH = (84, 84, 60, 8, 0, .10)
CRANE = (108, 25, 10, 38, -20, 0)

KUNGFU_ARMS = dict(
    L=[(.3, REST), (.9, GUARD), (1.5, CHAMBER), (2.42, CHAMBER), (3.14, PUNCH), (3.2, PUNCH),
       (3.94, CHAMBER), (5.9, CHAMBER), (6.8, CRANE), (7.1, CRANE), (8.2, REST)],
    R=[(.3, REST), (.9, GUARD), (1.5, CHAMBER), (1.65, CHAMBER), (2.37, PUNCH), (2.42, PUNCH),
       (3.14, CHAMBER), (5.9, CHAMBER), (6.8, CRANE), (7.1, CRANE), (8.2, REST)])

# Sideways place, height and depth of the hips.
KUNGFU_HIPS = [(.5, (0, 0, 0)), (1.6, (0, -.200, -.03)), (3.5, (0, -.200, -.03)),
               (4.3, (-.175, -.045, 0)), (5.5, (-.175, -.045, 0)), (6.3, (0, -.170, -.03)),
               (7.1, (0, -.170, -.03)), (8.2, (0, 0, 0))]

# The balls of the feet: x, y, z, yaw, heel, toe (the foot against the toes while it is lifted).
WIDE = (.17, 0, 0, 18, 0, 0)
KNEE_UP = (-.02, .40, .24, 0, 14, 0)
KICK = (-.03, .55, .64, 0, -42, -8)
KUNGFU_LEFT = [(.4, (0,) * 6), (.9, WIDE), (4.0, WIDE), (4.55, KNEE_UP), (4.6, KNEE_UP),
               (5.0, KICK), (5.05, KICK), (5.45, KNEE_UP), (6.05, WIDE), (7.2, WIDE), (7.7, (0,) * 6)]
KUNGFU_RIGHT = [(.9, (0,) * 6), (1.4, (-.17, 0, 0, -18, 0, 0)), (7.7, (-.17, 0, 0, -18, 0, 0)),
                (8.2, (0,) * 6)]


def hop(t, moves, height=.035):
    """How high a foot is that is lifted in the times [(start, end), ...]."""
    return sum(height * np.sin(np.pi * (t - a) / (b - a)) ** 2 for a, b in moves if a < t < b)


def kungfu(p, t, length=9.):
    """Horse stance, a punch of each hand, a front kick of the left leg, arms up as a crane."""
    hips = track(KUNGFU_HIPS, t)
    low = -hips[1] / .2

    # The shoulders turn into the punches, and the trunk leans back for the kick.
    twist = track([(1.7, [0.]), (2.35, [14.]), (2.45, [14.]), (3.1, [-14.]), (3.2, [-14.]),
                   (3.8, [0.])], t)[0]
    kick = track([(4.5, [0.]), (5.0, [1.]), (5.1, [1.]), (5.7, [0.])], t)[0]
    torso(p, (hips, (6 * low - 6 * kick, .4 * twist, 0)), spine=(-3 * low, .3 * twist, 0),
          chest=(-3 * low - 2 * kick, .5 * twist, 0), neck=(0, -.5 * twist, 0),
          head=(4 * kick, -.6 * twist, 0))

    for side in 'LR':
        p.arm(side, *track(KUNGFU_ARMS[side], t))
    left, right = track(KUNGFU_LEFT, t), track(KUNGFU_RIGHT, t)
    left[1] += hop(t, [(.4, .9), (7.2, 7.7)])
    right[1] += hop(t, [(.9, 1.4), (7.7, 8.2)])
    p.leg('L', left[:3], left[3], left[4], left[5] if 4. < t < 6.05 else None, aim=1.5 * left[3])
    p.leg('R', right[:3], right[3], right[4], aim=1.5 * right[3])


# Steps of the swing: start, end, lift, (x, z). The turn is on the ball of the left foot.
SPIN = (4.0, 6.05)
SWING_LEFT = [(0, 0, 0, (0, 0)), (.6, .9, .04, (.17, 0)), (1.3, 1.6, .04, (.28, 0)),
              (2.15, 2.45, .04, (.04, 0)), (2.9, 3.2, .05, (0, -.15)), (3.3, 3.6, .05, (0, 0)),
              (6.3, 6.6, .04, (.17, 0)), (7.0, 7.3, .04, (0, .0))]
SWING_RIGHT = [(0, 0, 0, (0, 0)), (.95, 1.25, .04, (.14, 0)), (1.8, 2.1, .04, (.02, 0)),
               (2.5, 2.8, .04, (-.10, 0)), (3.62, 3.92, .04, (0, 0)), (6.65, 6.95, .04, (.12, 0)),
               (7.35, 7.65, .04, (0, 0))]
SWING_HIPS = [(.4, (0, 0)), (1.5, (.20, 0)), (2.7, (-.04, 0)), (3.05, (-.05, -.05)),
              (3.5, (-.03, 0)), (3.95, (0, 0)), (6.2, (0, 0)), (6.8, (.13, 0)), (7.7, (0, 0))]


def swing(p, t, length=9.):
    """Triple steps to the left and to the right, a rock step, and a whole turn with spread arms."""
    e = envelope(t, length, 1.2)
    spread = track([(3.5, [0.]), (4.4, [1.]), (5.6, [1.]), (6.4, [0.])], t)[0]
    yaw = 360 * smooth_linear((t - SPIN[0]) / (SPIN[1] - SPIN[0]), .25)
    carried = track([(3.92, [0.]), (4.4, [1.]), (5.6, [1.]), (6.1, [0.])], t)[0]
    beat = wave(t, 1.)
    groove = beat * e * (1 - spread)
    bounce = (-.024 - .010 * wave(t, .5)) * e * (1 - .6 * carried)

    # The hips come over the left foot for the turn.
    at = track(SWING_HIPS, t)
    pivot = p.joint('toe.L') / p.scale * [1, 0, 1] + [0, 0, -.04]
    offset = np.array([at[0], 0, at[1]])
    if carried:
        offset = pivot + turn((0, 1, 0), yaw) @ ((offset - pivot) * (1 - .65 * carried))
    torso(p, (offset + [0, bounce - .004 * carried, 0], (3 * e, 5 * groove, 3 * groove)),
          spine=(0, -4 * groove, -3 * groove), chest=(0, -6 * groove, 0),
          head=(-2 * e, 5 * groove, 0), yaw=yaw)

    for side, k, plan in (('L', 1, SWING_LEFT), ('R', -1, SWING_RIGHT)):
        free = e * (1 - spread)
        p.arm(side, 45 + (2 + 5 * k * beat) * free + 33 * spread, (30 + 20 * k * beat) * free,
              25 * free, (52 + 12 * k * beat) * free + 8 * spread)
        (x, z), lift = steps(plan, t)
        rest = p.joint('toe.' + side) / p.scale * [1, 0, 1]
        ball = rest + [x, 0, z]
        heel = 420 * lift
        if side == 'R':  # carried around, a little closer and lifted
            ball = ball - pivot + carried * np.array([.07, 0, -.10])
            ball = pivot + turn((0, 1, 0), yaw) @ ball
            lift, heel = lift + .09 * carried, heel + 30 * carried
        else:
            heel += 14 * carried
        p.leg(side, ball - rest + [0, lift, 0], yaw, heel + 3 * e)


CLIPS = dict(dance=(dance, 8.), walk=(walk, 6.), turn=(turning, 9.), kungfu=(kungfu, 9.),
             swing=(swing, 9.))


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
