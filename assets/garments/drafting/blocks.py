"""Pieces that garments are drafted from. Lengths are centimetres, the wearer faces +z."""
import math

from drafting.panel import Panel, solve

ARM = 45  # of the arms below the level [degrees]


def trunk_outline(panel, size, depth, hollow):
    """The half of a front or back at x > 0, from the hem up to the neckline at the middle.

    y = 0 is the height of the shoulder at the neck. `depth` is that of the neckline, and `hollow`
    how far the armhole is cut in.
    """
    neck, shoulder = size['neck'], size['shoulder']
    panel.line('hem+', (size['hem'], -size['length']), 'hem')
    if 'waist' in size:
        panel.bow('side_low+', (size['waist'], -size['waist_at']), .5, .03)
        panel.bow('side+', (size['chest'], -size['armhole']), .5, .03)
    else:
        panel.line('side+', (size['chest'], -size['armhole']))
    panel.bow('armhole+', shoulder, .30, hollow)
    panel.line('shoulder+', (neck, 0))
    return panel.curve('neck+', (0, -depth), (.95 * neck, -.95 * depth), label='collar')


def trunk(name, size, depth, hollow):
    """A whole front or back."""
    panel = trunk_outline(Panel(name, (0, -size['length'])), size, depth, hollow)
    return panel.unfold()


def bodice(name, size, depth, hollow):
    """A front or back that ends at the waist, with a dart in each half."""
    low = -size['length']
    inner, outer = size['dart']
    panel = Panel(name, (0, low))
    panel.line('waist_half+', (inner, low), 'lower_interface')
    panel.line('dart_in+', size['dart_top']).line('dart_out+', (outer, low))
    panel.line('waist_side+', (size['waist'], low), 'lower_interface')
    panel.line('side+', (size['chest'], -size['armhole']))
    panel.bow('armhole+', size['shoulder'], .30, hollow)
    panel.line('shoulder+', (size['neck'], 0))
    panel.curve('neck+', (0, -depth), (.95 * size['neck'], -.95 * depth), label='collar')
    return panel.unfold().join('waist_half-', 'waist_half+', 'waist_middle')


def open_front(name, size, depth, hollow, gap):
    """The left half of a front that is open in the middle, `gap` from the other half."""
    inner = gap / 2
    panel = Panel(name, (inner, -size['length']))
    trunk_outline(panel, size, depth, hollow)
    neck = panel.edges.pop()
    neckline = [(x + inner * (1 - x / size['neck']), y) for x, y in neck.controls]
    panel.curve('neck+', (inner, -depth), *neckline, label='collar')
    return panel.line('opening', (inner, -size['length']))


def sleeve(name, armhole, half, length, wrist, ease=1.02):
    """A sleeve whose cap is as long as `armhole`, and a little longer; `half` of its width."""

    def cap(height):
        panel = Panel(name, (half, 0), 'arm')
        return panel.curve('cap+', (0, height), (.66 * half, .30 * height),
                           (.46 * half, height))

    height = solve(lambda h: cap(h).length('cap+') - ease * armhole / 2, 1, 2 * half)
    panel = Panel(name, (0, -length), 'arm').line('cuff+', (wrist, -length))
    panel.line('under+', (half, 0))
    panel.edges += cap(height).edges
    return panel.unfold()


def place_sleeve(panel, shoulder, along, radius, drop=0):
    """Round the left arm: its widest line is `along` the arm from the joint of the shoulder. A long
    sleeve hangs `drop` degrees steeper than the arm, so that its seam passes below the forearm."""
    x, y, z = shoulder
    c, s = math.cos(math.radians(ARM)), math.sin(math.radians(ARM))
    x, y = x + c * along, y - s * along
    turn = math.radians(ARM - drop)
    return panel.place((x + math.cos(turn) * radius, y + math.sin(turn) * radius, z),
                       (0, 90, ARM - drop), radius)


def sew_trunk(pattern, front, back):
    """Side and shoulder seams."""
    for edge in 'side_low', 'side', 'shoulder':
        if any(e.name == edge + '+' for e in front.edges):
            pattern.sew_both(front, edge, back)


def sew_sleeves(pattern, left, fronts, back):
    """Adds the sleeve and its image, and sews both into the armholes; `fronts`: that of the left
    and of the right arm."""
    right = left.mirror(left.name.replace('left', 'right'))
    pattern.add(left, right)
    # The front of the left arm is at x < 0 of its sleeve, that of the right arm at x > 0.
    pattern.sew(fronts[0], 'armhole+', left, 'cap-')
    pattern.sew(back, 'armhole-', left, 'cap+')
    pattern.sew(fronts[1], 'armhole-', right, 'cap+')
    pattern.sew(back, 'armhole+', right, 'cap-')
    for panel in left, right:
        pattern.sew(panel, 'under+', panel, 'under-')


def armhole_length(front, back):
    return front.length('armhole+') + back.length('armhole+')


def gore(name, angle, inner, length, parts, hem=(('hem', 1),), label='lower_interface'):
    """A piece of a circle skirt of `angle` degrees; (0, 0) is the center of its circles. Its waist
    is divided into arcs with these names and shares of it, from x > 0 to x < 0, and its hem into
    others from x < 0 to x > 0; `label`: that of the waist."""
    def ray(radius, degrees):
        return (radius * math.sin(math.radians(degrees)), -radius * math.cos(math.radians(degrees)))

    outer, half = inner + length, angle / 2
    panel = Panel(name, ray(outer, -half))
    turned = -half
    for part, share in hem:
        turned += share * angle
        panel.circle(part, ray(outer, turned), outer, True)
    panel.line('seam+', ray(inner, half))
    turned = half
    for part, share in parts:
        turned -= share * angle
        panel.circle(part, ray(inner, turned), inner, False)
        panel.edges[-1].label = label
    return panel.line('seam-', panel.start)


def yoke(name, top, bottom, height, hip, hem, label):
    """The front or back of a skirt from the waist to the hips. Its sides bulge by `hip` times their
    length; its hem is divided into parts from x < 0 to x > 0."""
    panel = Panel(name, (-bottom / 2, -height))
    x = -bottom / 2
    for part, share in hem:
        x += share * bottom
        panel.line(part, (x, -height))
    panel.bow('seam+', (top / 2, 0), .5, -hip)
    panel.line('waist', (-top / 2, 0), label)
    return panel.bow('seam-', panel.start, .5, -hip)


HALVES = (('waist_a', .5), ('waist_b', .5))


def place_round(panels, height, distance, spread=0):
    """Four panels before, left of, behind and right of the body, whose lower ends stand out by an
    angle of `spread` degrees."""
    for panel, (x, z, turn) in zip(panels, ((0, 1, 0), (1, 0, 90), (0, -1, 180), (-1, 0, -90))):
        panel.place((x * distance, height, z * distance), (-spread, turn, 0))


def sew_round(pattern, panels):
    """The side seams of panels that follow one another to the wearer's left."""
    for panel, after in zip(panels, panels[1:] + panels[:1]):
        pattern.sew(panel, 'seam+', after, 'seam-')


def trousers_leg(name, front, size):
    """The front or back of the left leg, as the outside shows it, about the crease of the leg.

    `front`: whether it is the front. Points are measured from the middle of the waist.
    """
    part = size['front' if front else 'back']
    crotch = size['crotch']
    middle = (part['hip'] - part['fork']) / 2  # the crease

    def at(x, y):
        return (x - middle, -y) if front else (middle - x, -y)

    rise = at(0, size['hip_at'])
    fork = at(-part['fork'], crotch)
    knee_in, knee_out = (at(middle + side * part['knee'] / 2, size['knee_at']) for side in (-1, 1))
    hem_in, hem_out = (at(middle + side * part['ankle'] / 2, size['length']) for side in (-1, 1))
    waist_in, waist_out = at(part['slant'], -part['raise']), at(part['slant'] + part['waist'], -1.2)
    hip_out = at(part['hip'], size['hip_at'])
    corner = (rise[0], fork[1] + .35 * (rise[1] - fork[1]))

    # From the hem at the inner leg the front runs outwards first, and the back inwards.
    outward = [('hem', hem_out, ()), ('out_low', knee_out, ()), ('out', hip_out, (.5, -.04)),
               ('out_high', waist_out, (.5, -.12)), ('waist', waist_in, ())]
    inward = [('rise', rise, ()), ('fork', fork, corner), ('in', knee_in, ()),
              ('in_low', hem_in, ())]
    panel = Panel(name, hem_in, 'leg')
    path = outward + inward
    if not front:  # the mirrored outline, run through backwards
        points = [hem_in] + [p[1] for p in path]
        path = [(path[k][0], points[k], path[k][2]) for k in reversed(range(len(path)))]
    for edge, end, shape in path:
        label = 'lower_interface' if edge == 'waist' else None
        if edge == 'fork':
            panel.curve(edge, end, shape)
        elif shape:
            panel.bow(edge, end, *shape, label=label)
        else:
            panel.line(edge, end, label)
    return panel


def place_leg(panel, front, height, distance, inner):
    """Before or behind the left leg, its fork at `height` and `inner` from the middle, and turned
    so that the inner seam hangs nearly straight down: it passes between the thighs."""
    def at(name, end):
        k = panel.index(name)
        x, y = panel.edges[k].end if end == front else panel.starts()[k]
        return (x if front else -x), y

    fork, hem = at('fork', True), at('in_low', True)
    turn = -math.atan2(hem[0] - fork[0] - .6, fork[1] - hem[1])
    x = inner - (fork[0] * math.cos(turn) - fork[1] * math.sin(turn))
    y = height - (fork[0] * math.sin(turn) + fork[1] * math.cos(turn))
    panel.place((x, y, distance), (0, 0 if front else 180, math.degrees(turn)))
