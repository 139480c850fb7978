#!/usr/bin/env python3
"""Drafts the sewing patterns of this folder: NAME_specification.json for each garment.

    python3 assets/garments/make_patterns.py [--out FOLDER] [--scale FACTOR] [NAME...]

Without names all patterns are written, beside this script if no folder is given. --scale makes
them larger or smaller for a body of another size: 0.8 fits one of 1.36 m instead of 1.70 m.

Needs python 3.9 or newer and nothing else.
"""
import argparse
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from drafting.garments import GARMENTS  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('names', nargs='*', metavar='NAME', help=', '.join(GARMENTS))
    parser.add_argument('--out', default=HERE, metavar='FOLDER')
    parser.add_argument('--scale', type=float, default=1, metavar='FACTOR')
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in GARMENTS]
    if unknown:
        parser.error('no garment %s, there are %s' % (', '.join(unknown), ', '.join(GARMENTS)))

    os.makedirs(options.out, exist_ok=True)
    for name in options.names or GARMENTS:
        pattern = GARMENTS[name]()
        pattern.units_in_meter = 100 / options.scale
        pattern.write(os.path.join(options.out, name + '_specification.json'))
        print('%-16s %2d panels, %2d stitches' % (name, len(pattern.panels),
                                                  len(pattern.stitches)))


if __name__ == '__main__':
    main()
