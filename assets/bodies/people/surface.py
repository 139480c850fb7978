"""Surface nets: the zero level of a field as triangles, one vertex a cell that it crosses."""
import numpy as np


def sample(field, low, high, cell, coarse=4):
    """Values at the corners of a grid; exact near the surface, only of the right sign elsewhere."""
    n = (np.ceil((high - low) / (cell * coarse)).astype(int)) * coarse + 1
    blocks = (n - 1) // coarse
    step = cell * coarse

    def corners(shape, spacing):
        axes = [low[k] + spacing * np.arange(shape[k]) for k in range(3)]
        return np.stack(np.meshgrid(*axes, indexing='ij'), -1)

    rough = field(corners(blocks + 1, step).reshape(-1, 3)).reshape(blocks + 1)
    value = np.repeat(np.repeat(np.repeat(rough, coarse, 0), coarse, 1), coarse, 2)
    value = value[:n[0], :n[1], :n[2]]
    near = np.abs(value) < 2.5 * step
    grid = corners(n, cell)
    value[near] = field(grid[near])
    return grid, value


CORNERS = list(np.ndindex(2, 2, 2))


def is_simple(code):
    """Whether the corners in a cell, and those out of it, each hang together along its edges."""
    for state in (1, 0):
        left = {c for bit, c in enumerate(CORNERS) if (code >> bit & 1) == state}
        reached = {min(left)} if left else set()
        while True:
            more = {c for c in left - reached
                    if any(sum(abs(a - b) for a, b in zip(c, r)) == 1 for r in reached)}
            if not more:
                break
            reached |= more
        if reached != left:
            return False
    return True


def fill_pinches(value):
    """Takes corners in until one vertex a cell gives a 2-manifold; they fill grooves of a cell."""
    simple = np.array([is_simple(code) for code in range(256)])
    n = value.shape
    while True:
        code = np.zeros([k - 1 for k in n], int)
        for bit, (i, j, k) in enumerate(CORNERS):
            code |= (value[i:n[0] - 1 + i, j:n[1] - 1 + j, k:n[2] - 1 + k] < 0).astype(int) << bit
        bad = np.argwhere(~simple[code])
        if not len(bad):
            return value
        for cell in bad:
            at = [tuple(cell + c) for c in CORNERS if value[tuple(cell + c)] >= 0]
            if at:
                value[min(at, key=lambda c: value[c])] = -1e-6


def surface_nets(field, low, high, cell):
    """Vertices (n, 3) and triangles (m, 3), oriented outwards."""
    grid, value = sample(field, low, high, cell)
    value = fill_pinches(value)
    n = np.array(value.shape)
    inside = value < 0

    # A vertex in the middle of the crossings of a cell's twelve edges.
    position = np.zeros((*(n - 1), 3))
    count = np.zeros(n - 1)

    def shifted(corner):
        return tuple(slice(corner[k], n[k] - 1 + corner[k]) for k in range(3))
    for corner in np.ndindex(2, 2, 2):
        for axis in range(3):
            if corner[axis]:
                continue
            end = tuple(1 if k == axis else corner[k] for k in range(3))
            a, b = value[shifted(corner)], value[shifted(end)]
            crossed = (a < 0) != (b < 0)
            t = a[crossed] / (a[crossed] - b[crossed])
            ga, gb = grid[shifted(corner)][crossed], grid[shifted(end)][crossed]
            position[crossed] += ga + t[:, None] * (gb - ga)
            count += crossed
    used = count > 0
    number = -np.ones(n - 1, int)
    number[used] = np.arange(used.sum())
    vertices = position[used] / count[used][:, None]

    # A quad around each grid edge that the surface crosses.
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        first = [slice(1, n[k] - 1) for k in range(3)]
        first[axis] = slice(0, n[axis] - 1)
        second = list(first)
        second[axis] = slice(1, n[axis])
        a, b = inside[tuple(first)], inside[tuple(second)]
        for outwards, crossed in ((True, a & ~b), (False, ~a & b)):
            at = np.argwhere(crossed) + [0 if k == axis else 1 for k in range(3)]

            def cell_vertex(du, dv):
                c = at.copy()
                c[:, u] += du
                c[:, v] += dv
                return number[c[:, 0], c[:, 1], c[:, 2]]
            quad = np.stack([cell_vertex(-1, -1), cell_vertex(0, -1), cell_vertex(0, 0),
                             cell_vertex(-1, 0)], 1)
            quads.append(quad if outwards else quad[:, ::-1])
    quads = np.concatenate(quads)

    # Each quad is cut along its shorter diagonal.
    ac = np.linalg.norm(vertices[quads[:, 0]] - vertices[quads[:, 2]], axis=1)
    bd = np.linalg.norm(vertices[quads[:, 1]] - vertices[quads[:, 3]], axis=1)
    x, y = quads[ac <= bd], quads[ac > bd]
    triangles = np.concatenate([x[:, [0, 1, 2]], x[:, [0, 2, 3]], y[:, [0, 1, 3]], y[:, [1, 2, 3]]])
    return vertices, triangles


def project(field, points, times=2, limit=.01):
    """Newton steps onto the surface."""
    h = 1e-4
    for _ in range(times):
        value = field(points)
        gradient = np.stack([(field(points + h * axis) - value) / h for axis in np.eye(3)], -1)
        square = np.maximum((gradient * gradient).sum(-1), .25)
        points = points - np.clip(value / square, -limit, limit)[:, None] * gradient
    return points
