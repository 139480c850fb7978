#!/usr/bin/env python3
"""Makes the pictures of docs/scenes.md: each scene of the paper at four moments.

    python3 docs/make_scene_pictures.py [--frames FRAMES] ICLOTH FOLDER [SCENE...]

Each scene is run once with `icloth run --out`, and the exported frames are drawn afterwards. With
--frames, folders FRAMES/SCENE of a run before are drawn where they are there. Needs python 3.9.
"""
import argparse
import csv
import json
import os
import subprocess
import tempfile

# Triangles of a scene, its camera, and its four moments in seconds.
SCENES = {
    'scarf': (10000, 'default', (1.0, 2.2, 3.8, 5.8)),
    'sphere': (20000, 'default', (0.5, 1.5, 2.7, 3.9)),
    'twisting': (20000, 'default', (0.6, 2.0, 4.0, 5.9)),
    'funnel': (20000, 'default', (0.2, 0.5, 0.8, 1.1)),
    'dress': (20000, 'default', (0.2, 2.1, 3.6, 4.6)),
    'tiered': (20000, 'default', (0.2, 2.1, 3.6, 6.9)),
    'andy': (20000, 'default', (1.5, 2.6, 5.2, 7.5)),
    'bishop': (20000, 'default', (1.0, 3.0, 5.8, 6.8)),
}
ASSETS = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'assets', 'scenes')


def scene_of(name):
    """The scene file without its comments, which stand on lines of their own."""
    with open(os.path.join(ASSETS, name + '.json')) as file:
        lines = [line for line in file if not line.lstrip().startswith('//')]
    return json.loads(''.join(lines))


def run(icloth, name, folder):
    triangles, _, moments = SCENES[name]
    steps = round(max(moments) / scene_of(name)['time_step'])
    subprocess.run([icloth, 'run', name, '--set', 'triangles=%d' % triangles, '--steps', str(steps),
                    '--every', '10', '--out', folder, '--quiet'], check=True)


def frame_at(folder, time):
    """The exported frame that is nearest to a time."""
    with open(os.path.join(folder, 'frames.csv')) as file:
        rows = list(csv.DictReader(file))
    nearest = min(range(len(rows)), key=lambda k: abs(float(rows[k]['time']) - time))
    return os.path.join(folder, 'frame_%05d.obj' % nearest)


def split(frame, folder):
    """Writes each object of a frame to a file of its own; returns the names of cloths and bodies."""
    positions, faces = [], {}
    with open(frame) as file:
        for line in file:
            if line.startswith('v '):
                positions.append(line)
            elif line[:2] in ('o ', 'g '):
                current = faces.setdefault(line[2:].strip(), [])
            elif line.startswith('f '):
                current.append([int(word.split('/')[0]) - 1 for word in line[2:].split()])

    # Only the vertices that the faces of an object use go into its file.
    for k, (name, own) in enumerate(faces.items()):
        number = {}
        for face in own:
            for vertex in face:
                number.setdefault(vertex, len(number) + 1)
        with open(os.path.join(folder, 'part%d.obj' % k), 'w') as file:
            file.writelines(positions[vertex] for vertex in number)
            file.writelines('f %d %d %d\n' % tuple(number[v] for v in face) for face in own)
    return list(faces)


def draw(icloth, name, frame, size, picture):
    """Draws a frame as the start of a scene of plain meshes."""
    camera = next(c for c in scene_of(name)['cameras'] if c['name'] == SCENES[name][1])
    with tempfile.TemporaryDirectory() as folder:
        scene = {'cloths': [], 'obstacles': [], 'cameras': [camera]}
        for k, part in enumerate(split(frame, folder)):
            kind = 'cloths' if part.startswith('cloth:') else 'obstacles'
            scene[kind].append({'name': part.split(':')[1], 'mesh': 'part%d.obj' % k})
        file = os.path.join(folder, 'frame.json')
        with open(file, 'w') as out:
            json.dump(scene, out)
        subprocess.run([icloth, 'render', file, '--steps', '0', '--quiet', '--size', size, '--out',
                        picture], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('icloth')
    parser.add_argument('folder')
    parser.add_argument('scenes', nargs='*', metavar='SCENE')
    parser.add_argument('--frames', default='', help='folder of runs that were exported before')
    parser.add_argument('--size', default='320x320')
    options = parser.parse_args()

    # One run gives all four pictures of a scene.
    os.makedirs(options.folder, exist_ok=True)
    for name in options.scenes or SCENES:
        with tempfile.TemporaryDirectory() as own:
            frames = os.path.join(options.frames or own, name)
            if not os.path.exists(os.path.join(frames, 'frames.csv')):
                run(options.icloth, name, frames)
            for number, time in enumerate(SCENES[name][2], 1):
                picture = os.path.join(options.folder, '%s-%d.png' % (name, number))
                draw(options.icloth, name, frame_at(frames, time), options.size, picture)
                print(picture)


if __name__ == '__main__':
    main()
