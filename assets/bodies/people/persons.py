"""Who the bodies are: joints, radii and sizes in metres, for the left side (x > 0) of an A-pose.

Y is up, the person faces +z and stands on y = 0; the right side is the mirror image.
"""
import math

from field import unit, vec

ARM = vec(math.sin(math.radians(45)), -math.cos(math.radians(45)), 0)  # the arms hang at 45 degrees


def woman():
    joints = dict(hips=vec(0, .93, -.005), spine=vec(0, 1.03, -.012), chest=vec(0, 1.18, -.020),
                  neck=vec(0, 1.425, -.034), head=vec(0, 1.506, -.016), top=vec(0, 1.70, -.010),
                  clavicle=vec(.030, 1.385, -.015), shoulder=vec(.160, 1.376, -.028),
                  hip=vec(.088, .885, -.008),                   ankle=vec(.108, .078, -.026),
                  ball=vec(.119, .022, .098), toe=vec(.124, .02, .150))
    joints['knee'] = knee(joints, .478, .015)
    add_arm(joints, upper=.278, lower=.238, hand=.172)
    return dict(
        name='woman', height=1.70, joints=joints,
        torso=[  # center, radii, width of the joint with what comes before
            ('pelvis', vec(0, .945, -.008), vec(.163, .130, .102), 0),
            ('waist', vec(0, 1.075, -.010), vec(.110, .20, .079), .09),
            ('ribs', vec(0, 1.228, -.016), vec(.136, .165, .096), .09),
            ('upper back', vec(0, 1.335, -.032), vec(.138, .080, .070), .07),
            ('belly', vec(0, .985, .040), vec(.070, .085, .046), .06),
        ],
        breast=(vec(.071, 1.232, .052), vec(.056, .060, .052), .050),
        seat=(vec(.072, .890, -.062), vec(.076, .088, .062), .055),
        deltoid=(vec(.158, 1.366, -.028), vec(.050, .058, .050), .060),
        trapezius=(.034, .022),
        collarbone=.0075,
        blade=1.0,
        neck=(.053, .047),
        arm=[.046, .044, .0385, .0385, .0305, .0235],
        leg=[.086, .080, .064, .0505, .047, .0465, .038, .0315],
        calf=1.0, knee=1.0,
        head=1.0, hand=1.0, foot=1.0, hair='bun', female=True)


def knee(joints, height, forward):
    """On the line from hip to ankle, and a little before it: so the knee bends forward only."""
    hip, ankle = joints['hip'], joints['ankle']
    return hip + (hip[1] - height) / (hip[1] - ankle[1]) * (ankle - hip) + vec(0, 0, forward)


def add_arm(joints, upper, lower, hand):
    joints['elbow'] = joints['shoulder'] + upper * ARM + vec(0, 0, -.008)
    joints['wrist'] = joints['elbow'] + lower * ARM + vec(0, 0, .022)
    joints['knuckles'] = joints['wrist'] + .52 * hand * ARM + vec(0, 0, .006)
    joints['tip'] = joints['wrist'] + hand * ARM + vec(0, 0, .010)


PERSONS = dict(woman=woman)
