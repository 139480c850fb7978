"""Writes a skinned mesh with named clips as binary glTF 2.0 (.glb)."""
import json
import struct

import numpy as np

FLOAT, BYTE, SHORT = 5126, 5121, 5123
ARRAY, ELEMENT = 34962, 34963


class Buffer:
    """The binary part: pieces of data, each a view with one accessor."""

    def __init__(self):
        self.data = bytearray()
        self.views, self.accessors = [], []

    def add(self, array, kind, component, target=None, bounds=False):
        array = np.ascontiguousarray(array)
        view = dict(buffer=0, byteOffset=len(self.data), byteLength=array.nbytes)
        if target:
            view['target'] = target
        self.views.append(view)
        self.data += array.tobytes()
        self.data += b'\0' * (-len(self.data) % 4)
        accessor = dict(bufferView=len(self.views) - 1, componentType=component, count=len(array),
                        type=kind)
        if kind == 'SCALAR':
            accessor['count'] = array.size
        if bounds:
            flat = array.reshape(len(array), -1)
            accessor['min'] = [float(x) for x in flat.min(0)]
            accessor['max'] = [float(x) for x in flat.max(0)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def write_glb(path, name, vertices, normals, triangles, rig, weights, clips):
    """`clips`: name -> (times, quaternions (frames, bones, 4), places of the hips (frames, 3))."""
    buffer = Buffer()
    bones = len(rig.names)
    order = np.argsort(-weights, axis=1, kind='stable')[:, :4]
    values = np.take_along_axis(weights, order, 1).astype('<f4')
    order = np.where(values > 0, order, 0).astype(np.uint8)
    bind = np.tile(np.eye(4, dtype='<f4'), (bones, 1, 1))
    bind[:, 3, :3] = -rig.heads  # columns first: a move to the joint's frame
    attributes = dict(POSITION=buffer.add(vertices.astype('<f4'), 'VEC3', FLOAT, ARRAY, True),
                      NORMAL=buffer.add(normals.astype('<f4'), 'VEC3', FLOAT, ARRAY),
                      JOINTS_0=buffer.add(order, 'VEC4', BYTE, ARRAY),
                      WEIGHTS_0=buffer.add(values, 'VEC4', FLOAT, ARRAY))
    indices = buffer.add(triangles.astype('<u2').reshape(-1), 'SCALAR', SHORT, ELEMENT)
    bind_accessor = buffer.add(bind.reshape(bones, 16), 'MAT4', FLOAT)

    # Node 0 is the mesh, node 1 the rig's root, the bones come after them.
    nodes = [dict(name=name, mesh=0, skin=0), dict(name=name + '_rig', children=[2])]
    for bone in range(bones):
        parent = rig.parents[bone]
        at = rig.heads[bone] - (rig.heads[parent] if parent >= 0 else 0)
        node = dict(name=rig.names[bone], translation=[round(float(x), 7) for x in at])
        children = [2 + k for k in range(bones) if rig.parents[k] == bone]
        if children:
            node['children'] = children
        nodes.append(node)

    document = dict(
        asset=dict(version='2.0', generator='make_people.py'), scene=0,
        scenes=[dict(nodes=[0, 1])], nodes=nodes,
        meshes=[dict(name=name, primitives=[dict(attributes=attributes, indices=indices)])],
        skins=[dict(inverseBindMatrices=bind_accessor, skeleton=1,
                    joints=list(range(2, 2 + bones)))],
        animations=[animation(buffer, clip, *clips[clip]) for clip in clips])
    document.update(accessors=buffer.accessors, bufferViews=buffer.views,
                    buffers=[dict(byteLength=len(buffer.data))])
    save(path, document, bytes(buffer.data))


def animation(buffer, name, times, quaternions, places):
    """One sampler a bone that moves, and the path of the hips."""
    times = buffer.add(times.astype('<f4'), 'SCALAR', FLOAT, bounds=True)
    buffer.accessors[times]['min'] = buffer.accessors[times]['min'][:1]
    samplers, channels = [], []

    def channel(node, path, output):
        samplers.append(dict(input=times, output=output, interpolation='LINEAR'))
        channels.append(dict(sampler=len(samplers) - 1, target=dict(node=node, path=path)))
    channel(2, 'translation', buffer.add(places.astype('<f4'), 'VEC3', FLOAT))
    for bone in range(quaternions.shape[1]):
        values = quaternions[:, bone]
        if np.abs(values - [0, 0, 0, 1]).max() > 1e-6:
            channel(2 + bone, 'rotation', buffer.add(values.astype('<f4'), 'VEC4', FLOAT))
    return dict(name=name, samplers=samplers, channels=channels)


def save(path, document, binary):
    text = json.dumps(document, separators=(',', ':')).encode()
    text += b' ' * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary)
    with open(path, 'wb') as f:
        f.write(struct.pack('<4sII', b'glTF', 2, size))
        f.write(struct.pack('<I4s', len(text), b'JSON') + text)
        f.write(struct.pack('<I4s', len(binary), b'BIN\0') + binary)


def read_glb(path):
    """vertices, triangles and weights (vertices, bones) of a file that write_glb has written."""
    with open(path, 'rb') as f:
        data = f.read()
    length = struct.unpack_from('<I', data, 12)[0]
    document = json.loads(data[20:20 + length])
    binary = data[28 + length:]

    def array(accessor, kind, width):
        a = document['accessors'][accessor]
        view = document['bufferViews'][a['bufferView']]
        flat = np.frombuffer(binary, kind, a['count'] * width, view['byteOffset'])
        return flat.reshape(-1, width)
    primitive = document['meshes'][0]['primitives'][0]
    names = primitive['attributes']
    vertices = array(names['POSITION'], '<f4', 3).astype(float)
    triangles = array(primitive['indices'], '<u2', 1).reshape(-1, 3).astype(int)
    weights = np.zeros((len(vertices), len(document['skins'][0]['joints'])))
    joints, values = array(names['JOINTS_0'], 'u1', 4), array(names['WEIGHTS_0'], '<f4', 4)
    for k in range(4):
        weights[np.arange(len(vertices)), joints[:, k]] += values[:, k]
    return vertices, triangles, weights
