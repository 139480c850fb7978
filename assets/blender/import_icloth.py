"""Opens an export of icloth in Blender: each object with its point cache, moving as it did.

    icloth run SCENE --out FOLDER --export pc2
    blender --python assets/blender/import_icloth.py -- FOLDER

Every NAME.pc2 of the folder becomes the Mesh Cache modifier of the mesh in NAME.obj. Frame 1 of the
scene is the start state, and the frame rate is that of frames.csv. The y axis of icloth points up;
the objects are turned, so that Blender's z axis does.
"""

import csv
import os
import sys

import bpy


def frame_rate(folder):
    """Exported frames a second, from the times of the first two; 24 for a single one."""
    with open(os.path.join(folder, 'frames.csv'), newline='') as file:
        times = [float(row['time']) for row in csv.DictReader(file)]
    return 1 / (times[1] - times[0]) if len(times) > 1 else 24


def import_object(folder, name):
    """The mesh NAME.obj with the cache NAME.pc2, whose vertices have the same order."""
    bpy.ops.wm.obj_import(filepath=os.path.join(folder, name + '.obj'), up_axis='Y', forward_axis='NEGATIVE_Z')
    made = bpy.context.selected_objects[0]
    made.name = name
    cache = made.modifiers.new('icloth', 'MESH_CACHE')
    cache.cache_format = 'PC2'
    cache.filepath = os.path.abspath(os.path.join(folder, name + '.pc2'))
    cache.frame_start = 1
    return made


def import_folder(folder):
    """All objects of an export, and the scene's length and rate."""
    names = sorted(entry[:-4] for entry in os.listdir(folder) if entry.endswith('.pc2'))
    if not names:
        raise SystemExit(folder + ': no point cache, expected an export with --export pc2')
    made = [import_object(folder, name) for name in names]
    scene = bpy.context.scene
    rate = frame_rate(folder)
    scene.render.fps = max(1, round(rate))
    scene.render.fps_base = scene.render.fps / rate
    size = os.path.getsize(os.path.join(folder, names[0] + '.pc2')) - 32
    scene.frame_start = 1
    scene.frame_end = size // (12 * len(made[0].data.vertices))
    return made


if __name__ == '__main__':
    if '--' not in sys.argv:
        raise SystemExit('usage: blender --python import_icloth.py -- FOLDER')
    import_folder(sys.argv[sys.argv.index('--') + 1])
