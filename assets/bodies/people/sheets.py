"""Contact sheets: five views of a body, and every tenth key of each clip."""
import os

import numpy as np

from field import vec
from motions import sample
from picture import draw, write_png
from rig import Rig


def row(pictures, columns=None):
    """Pictures side by side, in rows of `columns`; what is missing in the last row is white."""
    columns = columns or len(pictures)
    height = max(p.shape[0] for p in pictures)
    rows = []
    for start in range(0, len(pictures), columns):
        line = [np.pad(p, ((0, height - p.shape[0]), (0, 0), (0, 0)), constant_values=1)
                for p in pictures[start:start + columns]]
        rows.append(np.concatenate(line, 1))
    width = max(r.shape[1] for r in rows)
    return np.concatenate([np.pad(r, ((0, 0), (0, width - r.shape[1]), (0, 0)), constant_values=1)
                           for r in rows], 0)


def body_sheet(person, vertices, triangles, size=520):
    """Front, between, side and back, then face, hand and foot."""
    h, j = person['height'], person['joints']
    middle = vec(0, h / 2, 0)
    whole = [draw(vertices, triangles, middle, h * 1.06, (int(size * part), size), yaw, 4)
             for yaw, part in ((0, .86), (40, .74), (90, .40), (180, .86))]
    width, tall = sum(p.shape[1] for p in whole), int(size * .6)
    third = width // 6
    k = person['head']
    face = j['head'] + vec(0, .052, 0) * k
    hand = j['wrist'] + vec(.055, -.055, .01) * person['hand']
    foot = vec(j['ankle'][0], .085, .04)
    near = hand[0] - .16  # the hand without the body behind it
    alone = triangles[(vertices[triangles][:, :, 0] > near).all(1)]
    close = [draw(vertices, triangles, face, .34 * k, (third, tall), yaw, p)
             for yaw, p in ((0, 0), (38, 5), (90, 0))]
    close += [draw(vertices, alone, hand, .28 * person['hand'], (third, tall), yaw, p)
              for yaw, p in ((85, 20), (-95, -35))]
    close += [draw(vertices, triangles, foot, .36 * person['foot'],
                   (width - 5 * third, tall), 40, 20)]
    return np.concatenate([row(whole), row(close)], 0)


def clip_sheet(person, body, clip, every=10, columns=8):
    vertices, triangles, weights = body
    rig = Rig(person)
    _, _, _, world, joints = sample(rig, clip)
    h = person['height']
    return row([draw(rig.skin(vertices, weights, world[n], joints[n]), triangles, vec(0, h / 2, 0),
                     h * 1.16, (210, 240), 25, 6) for n in range(0, len(world), every)], columns)


def write_sheets(person, body, clips, folder):
    os.makedirs(folder, exist_ok=True)
    name = person['name']
    write_png(os.path.join(folder, name + '_body.png'), body_sheet(person, *body[:2]))
    for clip in clips:
        write_png(os.path.join(folder, '%s_%s.png' % (name, clip)), clip_sheet(person, body, clip))


def write_picture(person, body, folder):
    """The small picture of the documentation: four views, and the face."""
    os.makedirs(folder, exist_ok=True)
    vertices, triangles, _ = body
    h, j = person['height'], person['joints']
    k = person['head'] * person['scale']
    views = [draw(vertices, triangles, vec(0, h / 2, 0), h * 1.06, size, yaw, 4)
             for yaw, size in ((0, (290, 340)), (40, (250, 340)), (90, (130, 340)),
                               (180, (290, 340)))]
    views.append(draw(vertices, triangles, j['head'] + vec(0, .05, 0) * k, .36 * k, (240, 340),
                      35, 5))
    write_png(os.path.join(folder, person['name'] + '.png'), row(views))
