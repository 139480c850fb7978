"""Who the bodies are: joints, radii and sizes, for the left side (x > 0) of an A-pose.

A table is written as for a height of 1.70 m, so that proportions can be compared, and then scaled
to the person's height: `joints` and `scale` are what the other modules read. Y is up, the person
faces +z and stands on y = 0; the right side is the mirror image. Lengths are metres.
"""
import math

from field import vec

TABLE_HEIGHT = 1.70
ARM = vec(math.sin(math.radians(45)), -math.cos(math.radians(45)), 0)  # the arms hang at 45 degrees

# Keys of a table, beside the joints:
#   torso      (name, center, radii, width of the joint with what comes before)
#   breast, seat, deltoid   center, radii, width of the joint
#   trapezius  radii at the neck and at the shoulder
#   blade      size of the shoulder blades, 0 for none; collarbone: its radius
#   neck       radii below and above
#   arm        radii: shoulder, upper arm, elbow, forearm twice, wrist
#   leg        radii: hip, thigh twice, knee, shin four times
#   head, hand, foot, calf, cheek   sizes against the woman's
#   hair       'bun', 'knot' or 'short'


def woman():
    joints = dict(hips=vec(0, .93, -.005), spine=vec(0, 1.03, -.012), chest=vec(0, 1.18, -.020),
                  neck=vec(0, 1.425, -.034), head=vec(0, 1.506, -.016), top=vec(0, 1.70, -.010),
                  clavicle=vec(.030, 1.385, -.015), shoulder=vec(.160, 1.376, -.028),
                  hip=vec(.088, .885, -.008), ankle=vec(.108, .078, -.026),
                  ball=vec(.119, .022, .098), toe=vec(.124, .02, .150))
    add_limbs(joints, knee=.478, upper=.278, lower=.238, hand=.172)
    return finish(dict(
        name='woman', height=1.70, female=True, joints=joints,
        torso=[('pelvis', vec(0, .945, -.008), vec(.163, .130, .102), 0),
               ('waist', vec(0, 1.075, -.010), vec(.107, .20, .077), .09),
               ('ribs', vec(0, 1.228, -.016), vec(.136, .165, .096), .09),
               ('upper back', vec(0, 1.335, -.032), vec(.138, .080, .070), .07),
               ('belly', vec(0, .985, .038), vec(.070, .085, .046), .06)],
        breast=(vec(.071, 1.232, .053), vec(.056, .060, .053), .048),
        seat=(vec(.072, .890, -.062), vec(.076, .088, .062), .055),
        deltoid=(vec(.158, 1.366, -.028), vec(.048, .056, .048), .060),
        trapezius=(.030, .020), blade=1.0, collarbone=.0075, neck=(.046, .042),
        arm=[.043, .041, .0365, .0370, .0300, .0230],
        leg=[.081, .075, .061, .0505, .047, .0465, .038, .0315],
        head=1.0, hand=1.0, foot=1.0, calf=1.0, cheek=.95, hair='bun'))


def dancer():
    """Slimmer and longer in the leg, with a low knot of hair."""
    joints = dict(hips=vec(0, .945, -.005), spine=vec(0, 1.042, -.012), chest=vec(0, 1.19, -.020),
                  neck=vec(0, 1.428, -.032), head=vec(0, 1.514, -.014), top=vec(0, 1.70, -.010),
                  clavicle=vec(.030, 1.388, -.013), shoulder=vec(.159, 1.380, -.026),
                  hip=vec(.085, .902, -.008), ankle=vec(.106, .078, -.026),
                  ball=vec(.118, .022, .098), toe=vec(.124, .02, .150))
    add_limbs(joints, knee=.488, upper=.280, lower=.242, hand=.174)
    return finish(dict(
        name='dancer', height=1.72, female=True, joints=joints,
        torso=[('pelvis', vec(0, .958, -.008), vec(.151, .125, .094), 0),
               ('waist', vec(0, 1.085, -.010), vec(.097, .20, .070), .09),
               ('ribs', vec(0, 1.232, -.016), vec(.130, .165, .090), .09),
               ('upper back', vec(0, 1.338, -.030), vec(.136, .080, .066), .07),
               ('belly', vec(0, .990, .030), vec(.062, .085, .044), .06)],
        breast=(vec(.066, 1.238, .052), vec(.052, .055, .044), .048),
        seat=(vec(.068, .905, -.056), vec(.072, .086, .058), .055),
        deltoid=(vec(.157, 1.370, -.026), vec(.045, .054, .045), .060),
        trapezius=(.028, .019), blade=.9, collarbone=.0085, neck=(.043, .040),
        arm=[.040, .038, .0345, .0350, .0285, .0225],
        leg=[.077, .071, .058, .0485, .045, .0460, .037, .0310],
        head=.96, hand=1.0, foot=1.0, calf=1.05, cheek=.85, hair='knot'))


def boy():
    """About nine years old: a head of 1 : 6.5, shoulders of 32 cm, a straight trunk."""
    joints = dict(hips=vec(0, .900, -.005), spine=vec(0, 1.007, -.010), chest=vec(0, 1.150, -.016),
                  neck=vec(0, 1.396, -.030), head=vec(0, 1.487, -.012), top=vec(0, 1.70, -.006),
                  clavicle=vec(.028, 1.356, -.013), shoulder=vec(.154, 1.344, -.026),
                  hip=vec(.080, .860, -.008), ankle=vec(.112, .080, -.026),
                  ball=vec(.124, .023, .108), toe=vec(.130, .02, .165))
    add_limbs(joints, knee=.468, upper=.268, lower=.232, hand=.178)
    return finish(dict(
        name='boy', height=1.35, female=False, joints=joints,
        torso=[('pelvis', vec(0, .918, -.008), vec(.150, .126, .100), 0),
               ('waist', vec(0, 1.045, -.010), vec(.124, .20, .090), .09),
               ('ribs', vec(0, 1.190, -.014), vec(.137, .17, .100), .09),
               ('upper back', vec(0, 1.303, -.028), vec(.136, .078, .071), .07),
               ('belly', vec(0, 1.007, .036), vec(.082, .094, .056), .06)],
        breast=(vec(.062, 1.245, .050), vec(.058, .044, .036), .05),
        seat=(vec(.064, .860, -.054), vec(.068, .080, .060), .055),
        deltoid=(vec(.151, 1.334, -.026), vec(.045, .055, .046), .060),
        trapezius=(.030, .020), blade=.95, collarbone=.0065, neck=(.043, .041),
        arm=[.041, .039, .0355, .0365, .0305, .0240],
        leg=[.077, .071, .0590, .0525, .0485, .0475, .040, .0335],
        head=1.095, hand=1.04, foot=1.08, calf=.9, cheek=1.05, hair='short'))


def add_limbs(joints, knee, upper, lower, hand):
    """Knee, elbow, wrist, knuckles and fingertip, from heights and lengths of bones."""
    # The knee is a little before the line from hip to ankle: so it bends forwards only.
    hip, ankle = joints['hip'], joints['ankle']
    joints['knee'] = (hip + (hip[1] - knee) / (hip[1] - ankle[1]) * (ankle - hip)
                      + vec(0, 0, .015))
    joints['elbow'] = joints['shoulder'] + upper * ARM + vec(0, 0, -.008)
    joints['wrist'] = joints['elbow'] + lower * ARM + vec(0, 0, .022)
    joints['knuckles'] = joints['wrist'] + .52 * hand * ARM + vec(0, 0, .006)
    joints['tip'] = joints['wrist'] + hand * ARM + vec(0, 0, .010)


def finish(person):
    """Adds the scale to the person's height and the joints at that height."""
    person['scale'] = person['height'] / TABLE_HEIGHT
    person['table_joints'] = person['joints']
    person['joints'] = {name: at * person['scale'] for name, at in person['joints'].items()}
    return person


PERSONS = dict(woman=woman, dancer=dancer, boy=boy)
