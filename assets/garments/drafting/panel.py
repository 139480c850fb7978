"""Panels, edges and stitches of a pattern, and the file that holds them. Lengths are centimetres."""
import json
import math

PIECES = 200  # straight pieces that a curve is measured with


class Edge:
    """From the point before it to `end`: straight, a Bezier curve through `controls`, or an arc."""

    def __init__(self, name, end, controls=(), arc=None, label=None):
        self.name, self.end, self.controls, self.arc, self.label = name, end, controls, arc, label

    def points(self, start):
        """The edge as a polyline."""
        if self.arc:
            return arc_points(start, self.end, *self.arc)
        knots = [start, *self.controls, self.end]
        if len(knots) == 2:
            return knots
        return [bezier(knots, k / PIECES) for k in range(PIECES + 1)]


class Panel:
    """An outline that is drawn counter-clockwise, as the wearer's outside shows it, y upwards.

    Names of edges are used by stitches. A mirrored edge has the name of its image with the sign at
    its end exchanged: 'side+' lies at x > 0, and 'side-' at x < 0.
    """

    def __init__(self, name, start, label='body'):
        self.name, self.start, self.label = name, start, label
        self.edges = []
        self.translation, self.rotation, self.bend_radius = (0, 0, 0), (0, 0, 0), 0

    def line(self, name, end, label=None):
        self.edges.append(Edge(name, end, label=label))
        return self

    def curve(self, name, end, *controls, label=None):
        self.edges.append(Edge(name, end, controls, label=label))
        return self

    def bow(self, name, end, along, left, label=None):
        """A curve whose control point lies `along` the chord and to the left of it, over its
        length: inside the panel for a positive `left`."""
        s, d = self.at(), difference(end, self.at())
        control = (s[0] + along * d[0] - left * d[1], s[1] + along * d[1] + left * d[0])
        return self.curve(name, end, control, label=label)

    def circle(self, name, end, radius, outwards):
        """The smaller arc of a circle, which bulges out of the panel or into it."""
        self.edges.append(Edge(name, end, arc=(radius, outwards)))
        return self

    def place(self, translation, rotation=(0, 0, 0), bend_radius=0):
        self.translation, self.rotation, self.bend_radius = translation, rotation, bend_radius
        return self

    def at(self):
        return self.edges[-1].end if self.edges else self.start

    def unfold(self):
        """Adds the mirror image of what was drawn from (0, bottom) over x > 0 to (0, top)."""
        for edge, start in reversed(list(zip(self.edges, self.starts()))):
            self.edges.append(mirrored(edge, start))
        return self

    def join(self, last, first, name):
        """Makes one straight edge of the last one and of the first one, which continues it."""
        if self.edges[-1].name != last or self.edges[0].name != first:
            raise ValueError('panel %s does not start within a border' % self.name)
        self.start = self.starts()[-1]
        self.edges.pop()
        self.edges[0].name = name
        return self

    def mirror(self, name):
        """The panel of the other side, with its place."""
        starts = self.starts()
        image = Panel(name, flip(self.start), self.label)
        image.edges = [mirrored(e, s) for e, s in reversed(list(zip(self.edges, starts)))]
        x, y, z = self.translation
        a, b, c = self.rotation
        return image.place((-x, y, z), (a, -b if b != 180 else b, -c), self.bend_radius)

    def starts(self):
        return [self.start] + [edge.end for edge in self.edges[:-1]]

    def index(self, name):
        found = [k for k, edge in enumerate(self.edges) if edge.name == name]
        if len(found) != 1:
            raise ValueError('panel %s has %d edges named %s' % (self.name, len(found), name))
        return found[0]

    def has(self, name):
        return any(edge.name == name for edge in self.edges)

    def length(self, name):
        k = self.index(name)
        return path_length(self.edges[k].points(self.starts()[k]))


class Pattern:
    def __init__(self, name):
        self.name, self.panels, self.stitches = name, [], []
        self.units_in_meter = 100  # centimetres; fewer make it larger

    def add(self, *panels):
        self.panels += panels

    def sew(self, a, edge_a, b, edge_b):
        self.stitches.append(((a, edge_a), (b, edge_b)))

    def sew_both(self, front, edge, back, other=None):
        """Both sides of a front and a back: what is at x > 0 of one is at x < 0 of the other."""
        for sign, opposite in ('+', '-'), ('-', '+'):
            self.sew(front, edge + sign, back, (other or edge) + opposite)

    def write(self, path):
        with open(path, 'w', encoding='utf-8', newline='\n') as f:
            f.write(self.text())

    def text(self):
        """The pattern as JSON, a row for each edge and stitch."""
        panels = ',\n'.join(panel_text(panel) for panel in self.panels)
        stitches = ',\n'.join('      [%s]' % ', '.join(
            json.dumps({'panel': panel.name, 'edge': panel.index(edge)}) for panel, edge in pair)
            for pair in self.stitches)
        order = json.dumps([panel.name for panel in self.panels])
        return ('{ "pattern": {\n    "panels": {\n%s },\n    "stitches": [\n%s ],\n'
                '    "panel_order": %s },\n  "parameters": {}, "parameter_order": [],\n'
                '  "properties": { "curvature_coords": "relative", "normalize_panel_translation": '
                'false,\n    "normalized_edge_loops": true, "units_in_meter": %s } }\n'
                % (panels, stitches, order, tidy(self.units_in_meter, 4)))


def panel_text(panel):
    if math.dist(panel.at(), panel.start) > 1e-9:
        raise ValueError('the outline of %s is not closed' % panel.name)
    starts = panel.starts()
    edges = []
    for k, (edge, start) in enumerate(zip(panel.edges, starts)):
        parts = {'endpoints': [k, (k + 1) % len(starts)]}
        if edge.controls:
            kind = 'quadratic' if len(edge.controls) == 1 else 'cubic'
            parts['curvature'] = {'type': kind, 'params': [
                relative(start, edge.end, control) for control in edge.controls]}
        if edge.arc:
            parts['curvature'] = {'type': 'circle', 'params': [
                tidy(edge.arc[0], 4), 0, 1 if edge.arc[1] else 0]}
        if edge.label:
            parts['label'] = edge.label
        edges.append('          ' + json.dumps(parts))

    place = {'translation': [tidy(v, 2) for v in panel.translation],
             'rotation': [tidy(v, 2) for v in panel.rotation]}
    if panel.bend_radius:
        place['bend_radius'] = tidy(panel.bend_radius, 2)
    place['label'] = panel.label
    vertices = json.dumps([[tidy(v, 3) for v in start] for start in starts])
    return ('      %s: {\n        "vertices": %s,\n        "edges": [\n%s ],\n        %s }'
            % (json.dumps(panel.name), vertices, ',\n'.join(edges), json.dumps(place)[1:-1]))


def tidy(value, digits):
    """Rounded, without a point where it is whole."""
    value = round(value, digits)
    return int(value) if value == int(value) else value


def difference(a, b):
    return a[0] - b[0], a[1] - b[1]


def flip(point):
    return -point[0], point[1]


def mirrored(edge, start):
    """The image at x -> -x, run through backwards, so that the outline keeps its sense."""
    name = edge.name
    if name[-1] in '+-':
        name = name[:-1] + ('-' if name[-1] == '+' else '+')
    return Edge(name, flip(start), [flip(c) for c in reversed(edge.controls)], edge.arc, edge.label)


def relative(start, end, point):
    """Coordinates along the chord and to the left of it, over its length."""
    d, p = difference(end, start), difference(point, start)
    square = d[0] * d[0] + d[1] * d[1]
    return [tidy((p[0] * d[0] + p[1] * d[1]) / square, 4),
            tidy((p[1] * d[0] - p[0] * d[1]) / square, 4)]


def bezier(knots, t):
    while len(knots) > 1:
        knots = [((1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1])
                 for a, b in zip(knots, knots[1:])]
    return knots[0]


def arc_points(start, end, radius, outwards):
    """Counter-clockwise about its center where it bulges outwards, else clockwise."""
    d = difference(end, start)
    chord = math.hypot(*d)
    height = math.sqrt(max(0, radius * radius - chord * chord / 4))
    side = 1 if outwards else -1
    center = ((start[0] + end[0]) / 2 - side * height * d[1] / chord,
              (start[1] + end[1]) / 2 + side * height * d[0] / chord)
    begin = math.atan2(start[1] - center[1], start[0] - center[0])
    angle = side * 2 * math.asin(min(1, chord / (2 * radius)))
    return [(center[0] + radius * math.cos(begin + angle * k / PIECES),
             center[1] + radius * math.sin(begin + angle * k / PIECES))
            for k in range(PIECES + 1)]


def path_length(points):
    return sum(math.dist(a, b) for a, b in zip(points, points[1:]))


def solve(function, low, high):
    """Where an increasing function is zero, between two values."""
    for _ in range(60):
        middle = (low + high) / 2
        if function(middle) < 0:
            low = middle
        else:
            high = middle
    return (low + high) / 2
