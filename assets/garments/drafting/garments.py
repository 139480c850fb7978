"""The garments of the bodies in assets/bodies. Lengths are centimetres."""
from drafting import blocks
from drafting.panel import Pattern

# Joint of the left shoulder, from which the arm hangs at 45 degrees.
WOMAN_SHOULDER = (16.0, 137.6, -2.8)
DANCER_SHOULDER = (16.1, 139.6, -2.6)
BOY_SHOULDER = (12.2, 106.7, -2.1)


def shirt(name, size, shoulder, neck_height, front_at, back_at, bend, sleeve, arm):
    """A shirt with sleeves, closed in front."""
    pattern = Pattern(name)
    front = blocks.trunk('front', size, size['front_neck'], .24)
    back = blocks.trunk('back', size, size['back_neck'], .20)
    front.place((0, neck_height, front_at), (0, 0, 0), bend)
    back.place((0, neck_height, back_at), (0, 180, 0), bend)
    pattern.add(front, back)
    blocks.sew_trunk(pattern, front, back)
    piece = blocks.sleeve('sleeve_left', blocks.armhole_length(front, back), *sleeve)
    blocks.place_sleeve(piece, shoulder, *arm)
    blocks.sew_sleeves(pattern, piece, (front, front), back)
    return pattern


def tee():
    size = dict(neck=8.5, shoulder=(20.8, -3.2), chest=24.5, armhole=23.5, hem=26, length=58,
                front_neck=9, back_neck=2.5)
    return shirt('tee', size, WOMAN_SHOULDER, 147.5, 17, -21, 20,
                 sleeve=(18.5, 13, 17.5), arm=(10.5, 6.6))


def trousers():
    size = dict(crotch=26, hip_at=15, knee_at=56, length=94,
                front=dict(waist=19.8, hip=24.3, fork=5, knee=22, ankle=20, slant=0, **{'raise': 0}),
                back=dict(waist=21.3, hip=26.3, fork=9, knee=24, ankle=22, slant=1.5, **{'raise': 1.5}))
    return make_trousers('trousers', size, 77, 15, -17)


def make_trousers(name, size, fork_height, front_at, back_at):
    pattern = Pattern(name)
    front = blocks.trousers_leg('front_left', True, size)
    back = blocks.trousers_leg('back_left', False, size)
    blocks.place_leg(front, True, fork_height, front_at, .4)
    blocks.place_leg(back, False, fork_height, back_at, .4)
    others = [front.mirror('front_right'), back.mirror('back_right')]
    pattern.add(front, others[0], back, others[1])
    for a, b in (front, back), others:
        for edge in 'out_low', 'out', 'out_high', 'in', 'in_low':
            pattern.sew(a, edge, b, edge)
    for a, b in zip((front, back), others):
        for edge in 'rise', 'fork':
            pattern.sew(a, edge, b, edge)
    return pattern


GARMENTS = dict(tee=tee, trousers=trousers)
