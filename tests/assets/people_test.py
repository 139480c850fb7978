#!/usr/bin/env python3
"""Checks the bodies of assets/bodies: closed, manifold, of the right size, with bones and clips.

usage: people_test.py FOLDER, which holds the .glb files. It needs nothing beyond python itself.
"""
import json
import math
import os
import struct
import sys

# Height [m] and clips of each person.
CLIPS = {'dance', 'walk', 'turn', 'kungfu', 'swing'}
PEOPLE = {'woman': (1.70, CLIPS), 'dancer': (1.72, CLIPS), 'boy': (1.35, CLIPS)}
COMPONENTS = {'SCALAR': 1, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}
FORMATS = {5121: 'B', 5123: 'H', 5126: 'f'}


class Glb:
    def __init__(self, path):
        with open(path, 'rb') as f:
            data = f.read()
        magic, version, size = struct.unpack_from('<4sII', data)
        if (magic, version, size) != (b'glTF', 2, len(data)):
            raise ValueError('%s is not a whole glTF 2.0 file' % path)
        length = struct.unpack_from('<I', data, 12)[0]
        self.size = size
        self.document = json.loads(data[20:20 + length])
        self.binary = data[28 + length:]

    def rows(self, index):
        """The values of an accessor as tuples."""
        accessor = self.document['accessors'][index]
        view = self.document['bufferViews'][accessor['bufferView']]
        width = COMPONENTS[accessor['type']]
        kind = '<%d%s' % (width, FORMATS[accessor['componentType']])
        size = struct.calcsize(kind) * accessor['count']
        start = view['byteOffset']
        return list(struct.iter_unpack(kind, self.binary[start:start + size]))


def expect(holds, message, *values):
    if not holds:
        raise AssertionError(message % values)


def check_surface(vertices, triangles):
    """Each edge has two faces of opposite direction, each vertex one ring of faces."""
    following = {}
    for t in triangles:
        for k in range(3):
            edge = (t[k], t[(k + 1) % 3])
            expect(edge[0] != edge[1], 'face %s has a corner twice', t)
            expect(edge not in following, 'edge %s has two faces of one direction', edge)
            following[edge] = t[(k + 2) % 3]
    for a, b in following:
        expect((b, a) in following, 'edge %s is at a border', (a, b))
    euler = len(vertices) - len(following) // 2 + len(triangles)
    expect(euler == 2, 'the Euler characteristic is %d', euler)

    # Walking around a vertex must pass all its faces.
    valence, first = {}, {}
    for a, b in following:
        valence[a] = valence.get(a, 0) + 1
        first.setdefault(a, b)
    expect(len(valence) == len(vertices), 'a vertex has no face')
    for a, start in first.items():
        b, count = following[(a, start)], 1
        while b != start:
            b, count = following[(a, b)], count + 1
        expect(count == valence[a], 'vertex %d has two rings of faces', a)

    volume = 0.
    for t in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (vertices[v] for v in t)
        volume += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz)
                   + az * (bx * cy - by * cx)) / 6
    expect(.02 < volume < .12, 'volume %g m3: faces look inwards, or the size is wrong', volume)


def check_size(vertices, height):
    low = [min(v[k] for v in vertices) for k in range(3)]
    high = [max(v[k] for v in vertices) for k in range(3)]
    expect(abs(low[1]) < .002, 'the feet are at y = %g', low[1])
    expect(abs(high[1] - height) < .01, 'the height is %g', high[1])
    expect(abs(low[0] + high[0]) < .005, 'left and right reach to %g and %g', high[0], low[0])
    feet = [v for v in vertices if v[1] < .02 * height]
    expect(max(v[2] for v in feet) > -1.5 * min(v[2] for v in feet), 'the feet do not point to +z')


def check_skin(glb, attributes, count):
    joints = glb.document['skins'][0]['joints']
    names = {glb.document['nodes'][n]['name'] for n in joints}
    for name in ('hips', 'spine', 'chest', 'neck', 'head', 'upper_arm.L', 'forearm.R', 'hand.L',
                 'thigh.L', 'shin.R', 'foot.L'):
        expect(name in names, 'there is no bone %s', name)
    weights, bones = glb.rows(attributes['WEIGHTS_0']), glb.rows(attributes['JOINTS_0'])
    expect(len(weights) == count and len(bones) == count, 'not every vertex has weights')
    for v, (w, b) in enumerate(zip(weights, bones)):
        expect(abs(sum(w) - 1) < 1e-5 and min(w) >= 0, 'the weights of vertex %d are %s', v, w)
        expect(max(b) < len(joints), 'vertex %d has a bone %s that is not there', v, b)


def check_clips(glb, wanted):
    found = {clip['name']: clip for clip in glb.document['animations']}
    expect(wanted <= set(found), 'of the clips %s only %s are there', sorted(wanted), sorted(found))
    for name, clip in found.items():
        expect(clip['channels'], 'clip %s moves nothing', name)
        moved = 0.
        for sampler in clip['samplers']:
            times, values = glb.rows(sampler['input']), glb.rows(sampler['output'])
            expect(times[0][0] == 0 and times[-1][0] >= 5, 'clip %s lasts %g s', name, times[-1][0])
            expect(all(a < b for a, b in zip(times, times[1:])), 'the times of %s fall', name)
            expect(len(times) == len(values), 'clip %s has %d times', name, len(times))
            first, last = values[0], values[-1]
            if len(first) == 4:  # a quaternion and its negative are one rotation
                expect(all(abs(math.hypot(*q) - 1) < 1e-4 for q in values),
                       '%s: not a rotation', name)
                if sum(a * b for a, b in zip(first, last)) < 0:
                    last = [-x for x in last]
            expect(max(abs(a - b) for a, b in zip(first, last)) < 1e-5, 'clip %s jumps', name)
            moved = max(moved, max(max(v[k] for v in values) - min(v[k] for v in values)
                                   for k in range(len(first))))
        expect(moved > .05, 'clip %s stands still', name)


def check(folder, name):
    height, clips = PEOPLE[name]
    glb = Glb(os.path.join(folder, name + '.glb'))
    expect(glb.size <= 1 << 20, '%d bytes are more than 1 MB', glb.size)
    primitive = glb.document['meshes'][0]['primitives'][0]
    vertices = glb.rows(primitive['attributes']['POSITION'])
    corners = [row[0] for row in glb.rows(primitive['indices'])]
    triangles = list(zip(corners[0::3], corners[1::3], corners[2::3]))
    expect(12000 <= len(triangles) <= 20000, '%d triangles', len(triangles))
    check_surface(vertices, triangles)
    check_size(vertices, height)
    check_skin(glb, primitive['attributes'], len(vertices))
    check_clips(glb, clips)
    print('%s: %d triangles, %d clips' % (name, len(triangles), len(glb.document['animations'])))


def check_the_checks():
    """A tetrahedron that is turned inside out, opened or doubled must be refused."""
    points = [(0, 0, 0), (.6, 0, 0), (0, .6, 0), (0, 0, .6)]
    good = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    check_surface(points, good)
    for bad in (good[:3], good + good[:1], [t[::-1] for t in good], good[:3] + [(1, 3, 2)]):
        try:
            check_surface(points, bad)
        except AssertionError:
            continue
        raise AssertionError('the faces %s were accepted' % bad)


def main():
    check_the_checks()
    failed = False
    for name in PEOPLE:
        try:
            check(sys.argv[1], name)
        except (AssertionError, ValueError, KeyError, OSError) as error:
            print('%s: %s' % (name, error))
            failed = True
    return failed


if __name__ == '__main__':
    sys.exit(main())
