"""The field of a person: torso, limbs, head, hands and feet from the person's table."""
import numpy as np

from field import carve, cone, ellipsoid, flat_cone, inside_box, join, limb, unit, vec
from persons import ARM

# The frame of the left hand: along the fingers, out of the palm, towards the thumb.
PALM = unit(vec(-1, -1, 0))
THUMB = vec(0, 0, 1)


class Body:
    """A person's field; `body(p)` is below zero inside."""

    def __init__(self, person):
        self.person = person
        self.joints = person['table_joints']

    def __call__(self, p):
        return self.value(p / self.person['scale']) * self.person['scale']

    def value(self, q):
        """The field at the table's height of 1.70 m."""
        q[:, 0] = np.sqrt(q[:, 0] ** 2 + .003 ** 2)  # mirror images that meet without a crease
        j = self.joints
        value = self.torso(q)
        value = join(value, inside_box(q, vec(.06, j['tip'][1] - .06, -.2),
                                       vec(1, j['shoulder'][1] + .08, .2), self.arm), .035)
        value = join(value, inside_box(q, vec(-.02, -.1, -.3), vec(.3, j['hip'][1] + .28, .4),
                                       self.leg), .055)
        value = self.collarbones(q, value)
        low = j['neck'] - vec(.3, .14, .3)
        value = join(value, inside_box(q, low, vec(.3, 3, .4), self.neck), .04)
        low = j['head'] - vec(.3, .12, .3)
        return join(value, inside_box(q, low, vec(.3, 3, .4), self.head), .02)

    # --- torso ---

    def torso(self, q):
        t, j = self.person, self.joints
        value = None
        for _, center, radii, width in t['torso']:
            piece = ellipsoid(q, center, radii)
            value = piece if value is None else join(value, piece, width)
        if t['breast']:
            center, radii, width = t['breast']
            value = join(value, ellipsoid(q, center, radii), width)
        for center, radii, width in (t['seat'], t['deltoid']):
            value = join(value, ellipsoid(q, center, radii), width)

        # The slope from the neck to the shoulder, the shoulder blades and the furrow of the spine.
        ra, rb = t['trapezius']
        neck, shoulder = j['neck'], j['shoulder']
        value = join(value, cone(q, vec(.014, neck[1] + .020, neck[2]),
                                 shoulder + vec(-.022, .022, -.004), ra, rb), .05)
        s = t['blade']
        if s:
            back = j['chest'] + vec(.078, .125, -.070) * s
            tilt = [unit(vec(1, .25, .30)), unit(vec(-.25, 1, -.2)), unit(vec(-.3, .1, 1))]
            value = join(value, ellipsoid(q, back, vec(.040, .058, .024) * s, tilt), .045)
        furrow = cone(q, j['hips'] + vec(0, .02, -.128), j['chest'] + vec(0, .15, -.130),
                      .010, .014)
        return carve(value, furrow, .055)

    def collarbones(self, q, value):
        """From the pit of the throat to the shoulders, over the joint with the arms."""
        r = self.person['collarbone']
        if not r:
            return value
        j = self.joints
        a = vec(.020, j['clavicle'][1] + .004, j['clavicle'][2] + .044)
        b = vec(.085, j['clavicle'][1] + .018, j['clavicle'][2] + .036)
        c = j['shoulder'] + vec(-.004, .034, .012)
        bone = np.minimum(cone(q, a, b, r, r * .85), cone(q, b, c, r * .85, r * .8))
        return join(value, bone, .022)

    # --- arm and hand ---

    def arm(self, q):
        j, r = self.joints, self.person['arm']
        s, e, w = j['shoulder'], j['elbow'], j['wrist']
        fore = w - e
        value = limb(q, [s, s + .45 * (e - s), e - .06 * (e - s), e + .25 * fore, e + .62 * fore,
                         w], r)
        biceps = ellipsoid(q, s + .55 * (e - s) + vec(0, 0, .008),
                           vec(r[1] * .95, .075, r[1] * .95),
                           [unit(vec(-ARM[1], ARM[0], 0)), ARM, THUMB])
        value = join(value, biceps, .03)
        elbow = ellipsoid(q, e + vec(0, 0, -r[2] * .42) + .004 * ARM,
                          vec(r[2] * .62, .028, r[2] * .72),
                          [PALM, ARM, THUMB])
        value = join(value, elbow, .02)
        hand = inside_box(q, w - .20, w + .24, self.hand)
        return join(value, hand, .016)

    def hand(self, q):
        """A palm of four bones, four fingers that lie together, and a thumb."""
        k = self.person['hand']
        p = (q - self.joints['wrist']) / k
        p = np.stack([p @ ARM, p @ PALM, p @ THUMB], -1)  # along, out of the palm, to the thumb
        value = flat_cone(p, vec(.002, 0, 0), vec(.026, 0, .002), .0245, .0285, vec(0, 1, 0), .72)

        # Fingers from the forefinger to the little finger: base and length, slightly fanned.
        fingers = None
        for side, base, length, radius in ((.0280, .091, .071, .0092),
                                           (.0095, .095, .079, .0096),
                                           (-.0090, .092, .073, .0092),
                                           (-.0265, .083, .058, .0084)):
            fan = side * .55
            points, angle = [vec(base, -.001, side)], .06
            for part in (.45, .31, .24):
                step = part * length * vec(np.cos(angle), np.sin(angle), fan)
                points.append(points[-1] + step)
                angle += .24
            finger = limb(p, points, [radius * 1.08, radius, radius * .95, radius * .86], 3)
            fingers = finger if fingers is None else join(fingers, finger, .005)
            bone = cone(p, vec(.012, -.001, side * .55), vec(base, -.001, side),
                        .0135, radius * 1.08)
            value = join(value, bone, .018)
        value = join(value, fingers, .008)

        # The balls of the thumb and of the little finger, then the thumb.
        value = join(value, ellipsoid(p, vec(.036, .010, .024), vec(.032, .014, .016)), .016)
        value = join(value, ellipsoid(p, vec(.040, .008, -.022), vec(.034, .012, .013)), .016)
        thumb = limb(p, [vec(.022, .008, .022), vec(.056, .014, .044), vec(.084, .018, .056),
                         vec(.106, .021, .060)], [.0135, .0118, .0108, .0085], 3)
        return join(value, thumb, .014) * k

    # --- leg and foot ---

    def leg(self, q):
        j, r, t = self.joints, self.person['leg'], self.person
        hip, knee, ankle = j['hip'], j['knee'], j['ankle']
        thigh, shin = knee - hip, ankle - knee
        value = limb(q, [hip + vec(-.012, .050, 0), hip + vec(.004, -.03, 0),
                         hip + .35 * thigh, hip + .70 * thigh, knee,
                         knee + .18 * shin + vec(0, 0, -.004), knee + .38 * shin + vec(0, 0, -.008),
                         knee + .68 * shin + vec(0, 0, -.004), ankle + vec(0, .035, -.002)],
                     [.84 * r[0]] + r)

        # Calf: the inner head hangs lower than the outer one.
        c = r[4]
        for x, along, out in ((-.014, .30, .62), (.014, .25, .60)):
            center = knee + along * shin + vec(x, 0, -c * .50)
            value = join(value, ellipsoid(q, center, vec(c * .62, .098 * t['calf'], c * out)), .03)
        tendon = cone(q, knee + .50 * shin + vec(0, 0, -.014), ankle + vec(0, -.02, -.030),
                      .016, .012)
        value = join(value, tendon, .04)

        # Knee cap, and the muscle over it.
        k = r[3]
        cap = ellipsoid(q, knee + vec(0, .004, k * .68), vec(k * .46, .032, k * .40))
        value = join(value, cap, .040)
        value = join(value, ellipsoid(q, hip + .55 * thigh + vec(0, 0, r[1] * .22),
                                      vec(r[1] * .80, .16, r[1] * .80)), .04)
        foot = inside_box(q, vec(-.1, -.1, -.3), vec(.4, ankle[1] + .14, .5), self.foot)
        return join(value, foot, .030)

    def foot(self, q):
        k = self.person['foot']
        j = self.joints
        forward = unit((j['toe'] - j['ankle']) * vec(1, 0, 1))
        out = vec(forward[2], 0, -forward[0])
        a = j['ankle'] * vec(1, 0, 1)
        p = q - a
        p = np.stack([p @ out, q[:, 1], p @ forward], -1) / k  # outwards, up, forwards

        # Heel, instep, outer edge and ball.
        up = vec(0, 1, 0)
        value = ellipsoid(p, vec(0, .030, -.028), vec(.030, .034, .033))
        value = join(value, cone(p, vec(.001, .060, .002), vec(-.006, .030, .100),
                                 .0315, .022), .03)
        value = join(value, flat_cone(p, vec(.008, .020, .005), vec(.012, .018, .100),
                                      .024, .030, up, .75), .03)
        value = join(value, flat_cone(p, vec(-.006, .022, .105), vec(.022, .018, .098),
                                      .026, .024, up, .80), .02)

        # Toes from the big one outwards: place, from where to where, radius, height.
        toes = None
        for x, start, end, radius, height in ((-.0200, .125, .173, .0130, .0135),
                                              (.0000, .128, .172, .0095, .0115),
                                              (.0160, .122, .162, .0090, .0110),
                                              (.0305, .112, .150, .0086, .0105),
                                              (.0435, .098, .136, .0084, .0100)):
            toe = cone(p, vec(x * .92, height + .004, start - .02), vec(x, height, end - radius),
                       radius * 1.05, radius)
            toes = toe if toes is None else join(toes, toe, .004)
        value = join(value, toes, .012)

        # Ankle bones, the arch and the flat sole.
        for x, y, z in ((-.027, .078, .000), (.029, .070, -.008)):
            value = join(value, ellipsoid(p, vec(x, y, z), vec(.0090, .012, .012)), .016)
        value = carve(value, ellipsoid(p, vec(-.040, 0, .040), vec(.022, .016, .040)), .02)
        return carve(value * k, q[:, 1], .008)

    # --- neck and head ---

    def neck(self, q):
        j = self.joints
        ra, rb = self.person['neck']
        k = self.person['head']
        value = cone(q, j['neck'] + vec(0, -.035, 0), j['head'] + vec(0, .02, .002), ra, rb)
        cord = cone(q, j['head'] + vec(.038, .030, -.014) * k,
                    vec(.014, j['clavicle'][1] + .006, j['clavicle'][2] + .042), .009, .007)
        value = join(value, cord, .022)
        throat = cone(q, j['head'] + vec(0, -.02, .035), j['neck'] + vec(0, -.03, .04), .016, .012)
        return join(value, throat, .03)

    def head(self, q):
        k = self.person['head']
        base = self.joints['head'] + vec(0, -.042, .010) * k  # the chin's height, under the ears
        p = (q - base) / k
        # Skull, face, forehead, jaw, chin, cheekbones and cheeks.
        value = ellipsoid(p, vec(0, .138, -.010), vec(.0715, .083, .092))
        for center, radii, width in (
                (vec(0, .080, .024), vec(.0540, .080, .0575), .04),
                (vec(0, .146, .021), vec(.057, .050, .054), .03)):
            value = join(value, ellipsoid(p, center, radii), width)
        jaw = cone(p, vec(.034, .048, .010), vec(.007, .016, .062), .0170, .0135)
        value = join(value, jaw, .034)
        for center, radii, width in (
                (vec(0, .0135, .066), vec(.015, .0130, .0140), .018),
                (vec(.040, .076, .050), vec(.021, .020, .021), .035),
                (vec(.029, .044, .046), vec(.021, .026, .022) * self.person['cheek'], .035)):
            value = join(value, ellipsoid(p, center, radii), width)
        brow = np.minimum(cone(p, vec(.010, .1265, .0730), vec(.030, .1310, .0690), .0065, .0065),
                          cone(p, vec(.030, .1310, .0690), vec(.047, .125, .052), .0065, .0060))
        value = join(value, brow, .016)

        # Eyes: sockets, then the balls under closed lids.
        socket = ellipsoid(p, vec(.0305, .1120, .091), vec(.0180, .0095, .0170))
        value = carve(value, socket, .014)
        value = join(value, ellipsoid(p, vec(.0310, .1115, .0660), vec(.0150, .0100, .0115)), .004)

        nose = cone(p, vec(0, .114, .0770), vec(0, .078, .0970), .0050, .0065)
        nose = join(nose, ellipsoid(p, vec(.0070, .0740, .0905), vec(.0055, .0050, .0080)), .007)
        nose = join(nose, ellipsoid(p, vec(0, .0770, .0990), vec(.0065, .0065, .0070)), .008)
        value = join(value, nose, .013)

        # Mouth: two lips with a groove between them, on a low mound, and the hollow over the chin.
        value = join(value, ellipsoid(p, vec(0, .046, .064), vec(.034, .020, .0175)), .022)
        upper = cone(p, vec(.005, .0515, .0815), vec(.0240, .0475, .0715), .0045, .0028)
        lower = cone(p, vec(.004, .0410, .0805), vec(.0215, .0455, .0710), .0055, .0030)
        value = join(value, join(upper, lower, .001), .005)
        value = carve(value, ellipsoid(p, vec(0, .0290, .0905), vec(.020, .0045, .0080)), .014)

        # Ears lean outwards and back.
        axes = [unit(vec(1, .1, .35)), unit(vec(-.1, 1, -.18)), unit(vec(-.35, .15, 1))]
        ear = ellipsoid(p, vec(.0725, .102, -.012), vec(.0070, .0275, .0160), axes)
        shell = ellipsoid(p, vec(.0805, .104, -.006), vec(.0050, .0165, .0090), axes)
        ear = carve(ear, shell, .006)
        return self.hair(p, join(value, ear, .006)) * k

    def hair(self, p, value):
        """A smooth cap of hair, cut out for face, ears and nape."""
        style = self.person['hair']
        cap = ellipsoid(p, vec(0, .140, -.014), vec(.0830, .0960, .1065))
        cap = carve(cap, ellipsoid(p, vec(0, .072, .125), vec(.076, .100, .108)), .007)
        cap = carve(cap, ellipsoid(p, vec(.090, .082, .012), vec(.036, .042, .040)), .006)
        cap = carve(cap, ellipsoid(p, vec(0, -.010, -.050), vec(.12, .088, .10)), .012)
        value = join(value, cap, .005)
        if style == 'bun':
            value = join(value, ellipsoid(p, vec(0, .176, -.122), vec(.036, .034, .034)), .014)
        if style == 'knot':
            value = join(value, ellipsoid(p, vec(0, .102, -.112), vec(.042, .034, .030)), .014)
        return value
