#!/usr/bin/env python3
"""Checks that the patterns of assets/garments are those that their script drafts, byte for byte, and
that stitched edges are as long as each other, but for gathers.

usage: garments_test.py FOLDER, which holds make_patterns.py. It needs nothing beyond python itself.
"""
import os
import sys
import tempfile

sys.dont_write_bytecode = True
MOST_BYTES = 16 * 1024
EASE = 1.03  # of lengths that are sewn together without a gather

# Garments that are gathered: how much longer one of two edges may be there.
GATHERS = {'tiered': 1.31}


def check_files(folder, garments):
    """The files of the folder are those of the script, and no others."""
    with tempfile.TemporaryDirectory() as made:
        for name, draft in garments.items():
            path = os.path.join(made, name + '_specification.json')
            draft().write(path)
            with open(path, 'rb') as f, open(os.path.join(folder, os.path.basename(path)), 'rb') as g:
                new, committed = f.read(), g.read()
            if new != committed:
                raise AssertionError('%s is not what make_patterns.py writes' % name)
            if len(new) > MOST_BYTES:
                raise AssertionError('%s has %d bytes' % (name, len(new)))
        files = {f for f in os.listdir(folder) if f.endswith('.json')}
        if files != set(os.listdir(made)):
            raise AssertionError('not from the script: %s' % sorted(files ^ set(os.listdir(made))))


def check_stitches(garments):
    for name, draft in garments.items():
        pattern = draft()
        used = set()
        for (a, edge_a), (b, edge_b) in pattern.stitches:
            lengths = sorted((a.length(edge_a), b.length(edge_b)))
            most = GATHERS.get(name, EASE)
            if lengths[1] > most * lengths[0]:
                raise AssertionError('%s: %s:%s is %.2f cm long, %s:%s %.2f' % (
                    name, a.name, edge_a, a.length(edge_a), b.name, edge_b, b.length(edge_b)))
            for side in (a.name, edge_a), (b.name, edge_b):
                if side in used:
                    raise AssertionError('%s: %s:%s is sewn twice' % (name, *side))
                used.add(side)


def main():
    folder = sys.argv[1]
    sys.path.insert(0, folder)
    from drafting.garments import GARMENTS
    check_files(folder, GARMENTS)
    check_stitches(GARMENTS)
    print('%d patterns' % len(GARMENTS))


if __name__ == '__main__':
    main()
