#!/usr/bin/env python3
"""Makes woman.glb, boy.glb and dancer.glb: bodies with bones and clips, on which garments are worn.

    python3 assets/bodies/make_people.py [make|girths|check|sheet|picture] [NAME...]

make     writes NAME.glb beside this script, for all persons if none is named (30 s each).
girths   prints the measures of a garment maker, from the .glb, as a table.
check    prints triangles, and for each clip crossings of the body with itself, speeds, slips.
sheet    writes NAME_body.png (five views) and NAME_CLIP.png (every tenth key) to the folder
         $PEOPLE_SHEETS, or sheets/ in the present one.
picture  writes the small NAME.png of the documentation there.

Needs python 3.9 or newer with numpy (Debian: python3-numpy). Metres, Y up, facing +z, the feet on
y = 0.
"""
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, 'people'))

from anatomy import Body                            # noqa: E402
from gltf import read_glb, write_glb                # noqa: E402
from motions import CLIPS, sample                   # noqa: E402
from persons import PERSONS                         # noqa: E402
from picture import vertex_normals                  # noqa: E402
from report import print_checks, print_girths       # noqa: E402
from rig import Rig, heat_weights                   # noqa: E402
from shape import make_shape                        # noqa: E402
from sheets import write_picture, write_sheets      # noqa: E402


def path_of(name):
    return os.path.join(HERE, name + '.glb')


def make(name):
    person = PERSONS[name]()
    vertices, triangles = make_shape(person)
    rig = Rig(person)
    weights = heat_weights(rig, vertices, triangles, Body(person))
    clips = {clip: sample(rig, clip)[:3] for clip in CLIPS}
    write_glb(path_of(name), name, vertices, vertex_normals(vertices, triangles), triangles, rig,
              weights, clips)
    print('%s: %d vertices, %d triangles, %d bytes' % (name, len(vertices), len(triangles),
                                                       os.path.getsize(path_of(name))))


def main():
    words = sys.argv[1:]
    verb = words.pop(0) if words and words[0] not in PERSONS else 'make'
    unknown = [word for word in words if word not in PERSONS]
    if verb not in ('make', 'girths', 'check', 'sheet', 'picture') or unknown:
        sys.exit(__doc__)
    names = words or list(PERSONS)
    if verb == 'make':
        for name in names:
            make(name)
        return

    people = [(PERSONS[name](), read_glb(path_of(name))) for name in names]
    folder = os.environ.get('PEOPLE_SHEETS', 'sheets')
    if verb == 'girths':
        print_girths(people)
    for person, body in people:
        if verb == 'check':
            print_checks(person, body, CLIPS)
        elif verb == 'sheet':
            write_sheets(person, body, CLIPS, folder)
        elif verb == 'picture':
            write_picture(person, body, folder)


if __name__ == '__main__':
    main()
