"""From a person to triangles."""
import numpy as np

from anatomy import Body
from checks import is_closed_manifold
from field import vec
from remesh import remesh
from surface import project, surface_nets

GRID = .006   # of the first mesh [m]
COARSE = .0192  # wanted edge length of the trunk [m]


def spots(person):
    """Where the mesh is finer: center, radius, wanted edge length, at the table's height [m]."""
    j, k = person['table_joints'], person['head']
    found = [(j['head'] + vec(0, .045, .075) * k, .055 * k, .0052),
             (j['head'] + vec(0, .118, .070) * k, .035 * k, .0068),
             (j['head'] + vec(0, .060, .0) * k, .120 * k, .0110)]
    for side in (1, -1):
        m = vec(side, 1, 1)
        found.append((j['head'] + vec(side * .075, .060, 0) * k, .030 * k, .0065))
        found.append((j['knuckles'] * m, .085 * person['hand'], .0060))
        found.append((j['ball'] * m + vec(0, 0, .02), .05 * person['foot'], .0085))
        found.append((j['ankle'] * m, .07 * person['foot'], .0115))
    return found


def wanted_size(person):
    places, scale = spots(person), person['scale']

    def size(points):
        value = np.full(len(points), COARSE)
        for center, radius, length in places:
            distance = np.linalg.norm(points / scale - center, axis=1)
            value = np.minimum(value, length + .16 * np.maximum(distance - radius, 0))
        return value * scale ** .6  # a smaller body may have fewer triangles
    return size


def make_shape(person):
    """Vertices, and triangles that are closed, 2-manifold and oriented outwards."""
    body = Body(person)
    reach = person['joints']['tip'][0] + .06
    high = vec(reach, person['height'] + .06, .30)
    vertices, triangles = surface_nets(body, vec(-reach, -.03, -.27), high,
                                       GRID * person['scale'])
    vertices = project(body, vertices, 2)
    vertices, triangles = remesh(vertices, triangles, wanted_size(person), body)
    if not is_closed_manifold(vertices, triangles):
        raise SystemExit('the mesh of the %s is not closed and manifold' % person['name'])
    return vertices, triangles
