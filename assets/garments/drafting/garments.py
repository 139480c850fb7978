"""The garments of the bodies in assets/bodies. Lengths are centimetres."""
import math

from drafting import blocks
from drafting.panel import Pattern

# Joint of the left shoulder, from which the arm hangs at 45 degrees.
WOMAN_SHOULDER = (16.0, 137.6, -2.8)
WAIST = 'lower_interface'  # edges that hang from the waist while a garment is put on
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
    return shirt('tee', size, WOMAN_SHOULDER, 147.5, 17, -21, 22.5,
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


def dress():
    """A sleeveless bodice with darts, and a circle skirt of four gores."""
    pattern = Pattern('dress')
    # The waist of a skirt with an inner radius of 12 is 75.4 long; a dart takes 3 from each quarter.
    size = dict(neck=9, shoulder=(18.6, -3.2), chest=24, armhole=22.5, waist=21.85, length=39.5,
                dart=(9.42, 12.42), dart_top=(10.5, -28))
    front = blocks.bodice('front', size, 10, .22)
    back = blocks.bodice('back', size, 3, .18)
    front.place((0, 147.5, 16), (0, 0, 0), 21)
    back.place((0, 147.5, -19), (0, 180, 0), 21)
    gores = skirt_gores(90, 12, 55)
    blocks.place_round(gores, 115.5, 12, 50)
    pattern.add(front, back, *gores)
    blocks.sew_trunk(pattern, front, back)
    for panel in front, back:
        for sign in '+-':
            pattern.sew(panel, 'dart_in' + sign, panel, 'dart_out' + sign)
    blocks.sew_round(pattern, gores)
    sew_to_quarters(pattern, front, back, 'waist_middle', 'waist_side', gores)
    return pattern


def skirt_gores(angle, inner, length):
    """Gores before, left of, behind and right of the body; the waist of those at the sides is cut
    in halves."""
    return [blocks.gore(name, angle, inner, length, parts) for name, parts in (
        ('skirt_front', (('waist', 1),)), ('skirt_left', blocks.HALVES),
        ('skirt_back', (('waist', 1),)), ('skirt_right', blocks.HALVES))]


def sew_to_quarters(pattern, front, back, middle, side, round_panels):
    """Sews the lower border of a front and a back, each with a middle and two sides, to the upper
    border of four panels: before, left, behind and right."""
    before, left, behind, right = round_panels
    pattern.sew(front, middle, before, 'waist')
    pattern.sew(back, middle, behind, 'waist')
    # From x > 0 to x < 0 of its own, the left panel goes from the back to the front.
    pattern.sew(front, side + '+', left, 'waist_b')
    pattern.sew(back, side + '-', left, 'waist_a')
    pattern.sew(back, side + '+', right, 'waist_b')
    pattern.sew(front, side + '-', right, 'waist_a')


def tiered():
    """A yoke and three tiers, each a ring of four flared pieces. The first one is as long as the
    hem of the yoke; the others are gathered."""
    pattern = Pattern('tiered')
    front = blocks.yoke('yoke_front', 35, 51, 18, .12, QUARTERS, WAIST)
    back = blocks.yoke('yoke_back', 35, 51, 18, .12, QUARTERS, WAIST)
    front.place((0, 108, 16))
    back.place((0, 108, -18), (0, 180, 0))
    tiers = [tier(1, 25.5, 30, 16, 88, 20), tier(2, 30 * FULL, 46, 20, 69, 26),
             tier(3, 46 * FULL, 70, 22, 46, 35)]
    pattern.add(front, back, *(panel for ring in tiers for panel in ring))
    pattern.sew(front, 'seam+', back, 'seam-')
    pattern.sew(front, 'seam-', back, 'seam+')
    for ring in tiers:
        blocks.sew_round(pattern, ring)
    sew_to_quarters(pattern, front, back, 'hem_middle', 'hem_side', tiers[0])
    for above, below in zip(tiers, tiers[1:]):
        for upper, lower in zip(above, below):
            for edge, other in (('hem', 'waist'),) if lower.has('waist') else BORDERS:
                pattern.sew(upper, edge, lower, other)
    return pattern


def flounce():
    """A short circle skirt, to be worn over the yoke and the first tier of the tiered skirt."""
    pattern = Pattern('flounce')
    gores = skirt_gores(90, 11.8, 32)
    blocks.place_round(gores, 118, 14, 50)
    pattern.add(*gores)
    blocks.sew_round(pattern, gores)
    return pattern


QUARTERS = (('hem_side-', .25), ('hem_middle', .5), ('hem_side+', .25))  # of a lower border
FULL = 1.3  # length of a gathered border over that of the border it is sewn to
BORDERS = (('hem_b', 'waist_a'), ('hem_a', 'waist_b'))  # that are sewn together


def tier(number, top, bottom, height, at_height, distance):
    """A ring of four pieces of a circle; the borders of those at the sides are cut in halves."""
    angle = (bottom - top) / height  # the difference of two arcs over that of their radii
    names = ['tier%d_%s' % (number, place) for place in ('front', 'left', 'back', 'right')]
    halves = (('hem_a', .5), ('hem_b', .5))
    ring = [blocks.gore(name, math.degrees(angle), top / angle, height,
                        blocks.HALVES if k % 2 else (('waist', 1),),
                        halves if k % 2 else (('hem', 1),), None) for k, name in enumerate(names)]
    blocks.place_round(ring, at_height + top / angle, distance)
    return ring


def sleeveless(name, size, neck_height, front_at, back_at, bend):
    """A shirt without sleeves."""
    pattern = Pattern(name)
    front = blocks.trunk('front', size, size['front_neck'], .28)
    back = blocks.trunk('back', size, size['back_neck'], .26)
    front.place((0, neck_height, front_at), (0, 0, 0), bend)
    back.place((0, neck_height, back_at), (0, 180, 0), bend)
    pattern.add(front, back)
    blocks.sew_trunk(pattern, front, back)
    return pattern


def tank():
    """To be worn with the tiered skirt."""
    size = dict(neck=9, shoulder=(15.5, -2.2), chest=23.5, armhole=22.5, hem=25.5, length=52,
                front_neck=12, back_neck=6)
    return sleeveless('tank', size, 147.5, 17, -21, 20)


def andy_shirt():
    """Without sleeves: between the jacket and the body they would be pinched in the armpits."""
    size = dict(neck=7.0, shoulder=(13.0, -1.9), chest=20, armhole=18.5, hem=21.5, length=45,
                front_neck=7, back_neck=2)
    return sleeveless('andy_shirt', size, 115, 20, -23, 22)


def andy_trousers():
    # He kicks and stands in deep stances. The waist is narrower than the hips and holds the crotch
    # close to his own: cloth that sinks is stretched between the thighs. Knees are wide, since they
    # pinch the cloth behind them, and the seat is long, since it bends.
    size = dict(crotch=24.5, hip_at=14, knee_at=48, length=77,
                front=dict(waist=15.2, hip=21, fork=6.5, knee=23, ankle=17, slant=0,
                           **{'raise': 0}),
                back=dict(waist=15.8, hip=23, fork=11, knee=25, ankle=19, slant=2.5,
                          **{'raise': 3.5}))
    return make_trousers('andy_trousers', size, 59.5, 12, -14)


def andy_jacket():
    """Open in front, over the shirt."""
    size = dict(neck=8.0, shoulder=(17.5, -2.6), chest=23.5, armhole=21.5, hem=24.5, length=46,
                front_neck=8, back_neck=2.2)
    return open_jacket('andy_jacket', size, BOY_SHOULDER, 114, 20, -23, 20,
                       sleeve=(17.5, 31, 14.5), arm=(9.5, 6.4, 4))


def open_jacket(name, size, shoulder, neck_height, front_at, back_at, bend, sleeve=None, arm=None):
    """Two fronts and a back; without `sleeve`, a vest."""
    pattern = Pattern(name)
    left = blocks.open_front('front_left', size, size['front_neck'], .24, 2)
    back = blocks.trunk('back', size, size['back_neck'], .20)
    left.place((0, neck_height, front_at), (0, 0, 0), bend)
    back.place((0, neck_height, back_at), (0, 180, 0), bend)
    right = left.mirror('front_right')
    pattern.add(left, right, back)
    for edge in 'side', 'shoulder':
        pattern.sew(left, edge + '+', back, edge + '-')
        pattern.sew(right, edge + '-', back, edge + '+')
    if sleeve:
        piece = blocks.sleeve('sleeve_left', blocks.armhole_length(left, back), *sleeve)
        blocks.place_sleeve(piece, shoulder, *arm)
        blocks.sew_sleeves(pattern, piece, (left, right), back)
    return pattern


def bishop_blouse():
    """A shirt with long sleeves."""
    size = dict(neck=8.3, shoulder=(20.4, -3.2), chest=24, armhole=23, hem=25.5, length=56,
                front_neck=9, back_neck=2.5)
    return shirt('bishop_blouse', size, DANCER_SHOULDER, 149.5, 17, -20, 20,
                 sleeve=(18, 40, 14), arm=(10.5, 6.6, 4))


def bishop_skirt():
    """Three quarters of a circle, in four gores, on a straight waistband that holds it above the
    hips."""
    pattern = Pattern('bishop_skirt')
    waist, height = 72, 4
    front, back = (blocks.yoke('band_' + side, waist / 2, waist / 2, height, 0, QUARTERS, WAIST)
                   for side in ('front', 'back'))
    front.place((0, 111, 15))
    back.place((0, 111, -16), (0, 180, 0))
    gores = skirt_gores(67.5, waist / math.radians(270), 56)
    blocks.place_round(gores, 119.5, 9, 35)
    pattern.add(front, back, *gores)
    pattern.sew(front, 'seam+', back, 'seam-')
    pattern.sew(front, 'seam-', back, 'seam+')
    blocks.sew_round(pattern, gores)
    sew_to_quarters(pattern, front, back, 'hem_middle', 'hem_side', gores)
    return pattern


def bishop_vest():
    """Open in front, without sleeves, over the blouse."""
    size = dict(neck=8.8, shoulder=(19.0, -3.0), chest=26, armhole=25, hem=27, length=50,
                front_neck=22, back_neck=2.8)
    return open_jacket('bishop_vest', size, DANCER_SHOULDER, 151, 20, -23, 22)


GARMENTS = dict(tee=tee, trousers=trousers, dress=dress, tank=tank, tiered=tiered,
                flounce=flounce, andy_shirt=andy_shirt, andy_trousers=andy_trousers,
                andy_jacket=andy_jacket, bishop_blouse=bishop_blouse, bishop_skirt=bishop_skirt, bishop_vest=bishop_vest)
