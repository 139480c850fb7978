"""Blender opens an export of icloth: usage: blender_test.py ICLOTH BLENDER FOLDER_OF_SCRIPTS

Runs a small scene, opens its point caches with assets/blender/import_icloth.py, as PC2 and as MDD,
and compares the vertices at three frames with those of the OBJ files. Exit code 77 without Blender.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile

SCENE = {
    'name': 'swing', 'time_step': 0.01, 'duration': 1,
    'cloths': [{'name': 'sheet', 'mesh': {'grid': {'size': [0.3, 0.3]}}, 'triangles': 300, 'pins': ['top_left']}],
}

# Runs in Blender: prints the largest distance of a coordinate from those of the OBJ files.
CHECK = '''
import sys
sys.path.insert(0, {scripts!r})
import bpy
import import_icloth

for old in list(bpy.data.objects):
    bpy.data.objects.remove(old)
made = import_icloth.import_folder({folder!r})[0]
scene = bpy.context.scene
worst = 0
for kind in ('PC2', 'MDD'):
    modifier = made.modifiers[0]
    modifier.cache_format = kind
    modifier.filepath = modifier.filepath[:-3] + kind.lower()
    for frame in (1, 4, 6):
        scene.frame_set(frame)
        mesh = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        with open({folder!r} + '/frame_%05d.obj' % (frame - 1)) as file:
            expected = [[float(word) for word in line.split()[1:]] for line in file if line.startswith('v ')]
        assert len(expected) == len(mesh.vertices)
        for vertex, place in zip(mesh.vertices, expected):
            worst = max(worst, max(abs(a - b) for a, b in zip(vertex.co, place)))
print('frames', scene.frame_start, scene.frame_end, 'worst', worst)
'''


def main():
    icloth, blender, scripts = sys.argv[1:4]
    if not shutil.which(blender):
        print('there is no Blender: skipped')
        return 77
    with tempfile.TemporaryDirectory() as folder:
        with open(folder + '/swing.json', 'w') as file:
            json.dump(SCENE, file)
        out = folder + '/out'
        formats = [word for name in ('obj', 'pc2', 'mdd') for word in ('--export', name)]
        subprocess.run([icloth, 'run', folder + '/swing.json', '--steps', '50', '--every', '10', '--out', out,
                        '--device', 'cpu', '--quiet'] + formats, check=True)
        with open(folder + '/check.py', 'w') as file:
            file.write(CHECK.format(scripts=scripts, folder=out))
        done = subprocess.run([blender, '-b', '--python-exit-code', '1', '--python', folder + '/check.py'],
                              capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith('frames')]
    if done.returncode != 0 or not lines:
        print(done.stdout, done.stderr)
        return 1

    # OBJ files have nine digits, a cache all bits.
    print(lines[0])
    words = lines[0].split()
    return 0 if words[1:3] == ['1', '6'] and float(words[4]) < 1e-8 else 1


if __name__ == '__main__':
    sys.exit(main())
