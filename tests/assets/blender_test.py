"""Blender opens an export of icloth: usage: blender_test.py ICLOTH BLENDER FOLDER_OF_SCRIPTS

Runs a small scene in all formats and kills it on the way; `icloth export` makes the MDD files. Blender
then opens the point caches with assets/blender/import_icloth.py, as PC2 and as MDD, and frames as OBJ
and PLY, and the vertices are compared with the places that icloth wrote. Exit code 77 without Blender.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

SCENE = {
    'name': 'swing', 'time_step': 0.01, 'duration': 100,
    'cloths': [{'name': 'sheet', 'mesh': {'grid': {'size': [0.3, 0.3]}}, 'triangles': 300, 'pins': ['top_left']}],
    'obstacles': [{'name': 'ball', 'mesh': {'sphere': {'radius': 0.05, 'triangles': 100}},
                   'transform': {'translate': [0.1, -0.1, 0.1]}}],
}

# Runs in Blender. Prints the largest distance of a coordinate from its place, a line for each format.
CHECK = '''
import array
import sys
sys.path.insert(0, {scripts!r})
import bpy
import import_icloth

FOLDER = {folder!r}
OBJECTS = ('cloth_sheet', 'obstacle_ball')
FRAMES = (0, 3, 5)


def numbers(line):
    """In single precision, of which nine digits give every bit back."""
    return array.array('f', map(float, line.split()[1:])).tolist()


def written(frame):
    """The vertices of the OBJ file of a frame, in its order, which are those of all objects."""
    with open(FOLDER + '/frame_%05d.obj' % frame) as file:
        return [numbers(line) for line in file if line.startswith('v ')]


def remove_all():
    for old in list(bpy.data.objects):
        bpy.data.objects.remove(old)


def distance(vertices, places):
    places = list(places)
    assert len(vertices) == len(places) > 0
    return max(abs(a - b) for vertex, place in zip(vertices, places) for a, b in zip(vertex, place))


def upright(place):
    """The z axis of Blender points up."""
    return place[0], -place[2], place[1]


def caches(kind):
    """All objects at the frames, moved by their caches; Blender counts frames from 1."""
    remove_all()
    made = import_icloth.import_folder(FOLDER)
    assert [thing.name for thing in made] == list(OBJECTS)
    assert bpy.context.scene.frame_end > max(FRAMES)
    worst = 0
    for thing in made:
        thing.modifiers[0].cache_format = kind
        thing.modifiers[0].filepath = thing.modifiers[0].filepath[:-3] + kind.lower()
    for frame in FRAMES:
        bpy.context.scene.frame_set(frame + 1)
        places = written(frame)
        for thing in made:
            seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
            local = [tuple(vertex.co) for vertex in seen.data.vertices]
            world = [tuple(seen.matrix_world @ vertex.co) for vertex in seen.data.vertices]
            here, places = places[:len(local)], places[len(local):]
            worst = max(worst, distance(local, here))
            assert distance(world, map(upright, here)) < 1e-6
        assert not places
    return worst


def meshes(name, load, turned):
    """Frames as files of a mesh. `turned`: the importer turns the y axis up."""
    worst = 0
    for frame in FRAMES:
        remove_all()
        load(FOLDER + '/frame_%05d.' % frame + name)
        bpy.context.view_layer.update()
        things = bpy.context.selected_objects
        places = written(frame)
        assert len(things) == 1, things
        local = [tuple(vertex.co) for vertex in things[0].data.vertices]
        world = [tuple(things[0].matrix_world @ vertex.co) for vertex in things[0].data.vertices]
        worst = max(worst, distance(local, places))
        assert distance(world, map(upright, places) if turned else places) < 1e-6
    return worst


for kind in ('PC2', 'MDD'):
    print('loaded ' + kind + ', worst', caches(kind))
print('loaded OBJ, worst', meshes('obj', lambda path: bpy.ops.wm.obj_import(filepath=path), True))
# The older importer sorts the vertices by the faces unless it is told to keep their order.
print('loaded OBJ by the older importer, worst',
      meshes('obj', lambda path: bpy.ops.import_scene.obj(filepath=path, split_mode='OFF'), True))
print('loaded PLY, worst', meshes('ply', lambda path: bpy.ops.import_mesh.ply(filepath=path), False))
'''


def run_and_kill(icloth, folder, out):
    """Exports until a few frames are listed, and dies at that."""
    formats = [word for name in ('obj', 'ply', 'pc2', 'mdd') for word in ('--export', name)]
    run = subprocess.Popen([icloth, 'run', folder + '/swing.json', '--every', '10', '--out', out,
                            '--device', 'cpu', '--quiet'] + formats)
    frames = 0
    while run.poll() is None and frames < 7:
        time.sleep(0.01)
        if os.path.exists(out + '/frames.csv'):
            with open(out + '/frames.csv') as file:
                frames = file.read().count('\n') - 1
    run.kill()
    run.wait()


def main():
    icloth, blender, scripts = sys.argv[1:4]
    if not shutil.which(blender):
        print('there is no Blender: skipped')
        return 77
    with tempfile.TemporaryDirectory() as folder:
        with open(folder + '/swing.json', 'w') as file:
            json.dump(SCENE, file)
        out = folder + '/out'
        run_and_kill(icloth, folder, out)
        subprocess.run([icloth, 'export', out, '--format', 'mdd'], check=True)
        with open(folder + '/check.py', 'w') as file:
            file.write(CHECK.format(scripts=scripts, folder=out))
        done = subprocess.run([blender, '-b', '--python-exit-code', '1', '--python', folder + '/check.py'],
                              capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith('loaded')]
    if done.returncode != 0 or len(lines) != 5:
        print(done.stdout, done.stderr)
        return 1

    print('\n'.join(lines))
    return 0 if all(float(line.split()[-1]) == 0 for line in lines) else 1


if __name__ == '__main__':
    sys.exit(main())
