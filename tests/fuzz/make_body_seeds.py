#!/usr/bin/env python3
"""Writes tests/fuzz/seeds/body and the answers of the reader of bodies in regressions/body.

An answer is a JSON head with its length, then arrays, each its number of elements and the elements
as they are in memory (sim/files/body_transport.cpp).
"""
import json
import pathlib
import struct

FOLDER = pathlib.Path(__file__).resolve().parent
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
TRIANGLE = [0, 0, 0, 1, 0, 0, 0, 1, 0]


def head(value):
    text = json.dumps(value, separators=(",", ":")).encode()
    return struct.pack("<Q", len(text)) + text


def array(kind, numbers, per_element):
    """Numbers of one kind, d or i, so many of which are one element."""
    return struct.pack(f"<Q{len(numbers)}{kind}", len(numbers) // per_element, *numbers)


def body(clips=(), rig=None, positions=TRIANGLE, keys=b""):
    nodes = ["hip", "knee"] if rig else []
    bytes_ = head({"bones": 0, "morphs": 0, "nodes": nodes, "clips": list(clips)})
    bytes_ += array("d", positions, 3) + array("i", [0, 1, 2], 3)
    return bytes_ + (rig or struct.pack("<12Q", *[0] * 12)) + keys


def rig(parents=(-1, 0), weights=(1, 0.5, 0.5, 1), local=IDENTITY, morphs=True):
    """Two nodes with a bone each; the second vertex follows both."""
    parts = array("i", list(parents), 1) + array("d", [*IDENTITY, *local], 12)
    parts += array("i", [0, 1], 1) + array("d", IDENTITY * 2, 12) + array("d", TRIANGLE, 3)
    parts += array("i", [0, 1, 3, 4], 1) + array("i", [0, 0, 1, 1], 1)
    parts += array("d", list(weights), 1)
    if not morphs:
        return parts + struct.pack("<4Q", 0, 0, 0, 0)
    parts += array("i", [0, 1, 1, 1], 1) + array("i", [0], 1)
    return parts + array("d", [0, 0, 0.1], 3) + array("d", [0.5], 1)


def clip(times=(0, 1), move=(0, 1, 0), turn=(0.6, 0.8, 0, 0), morphs=True):
    """Node 1 moves and turns, and the morph target comes and goes."""
    keys = array("i", [1], 1) + array("i", [0] if morphs else [], 1)
    keys += array("d", [times[0], 0, 0, 0, times[1], *move], 4)
    keys += array("d", [times[0], 1, 0, 0, 0, times[1], *turn], 5)
    keys += array("d", [0, 1, 1, 1], 4)
    return keys + (array("d", [0, 0, 1, 1], 2) if morphs else b"")


WALK = {"name": "walk", "in_seconds": True}
SEEDS = {
    "mesh": body(),
    "rig": body([WALK], rig(), keys=clip()),
    "plain_rig": body([dict(WALK, in_seconds=False)], rig(morphs=False), keys=clip(morphs=False)),
}
NAN, HUGE = float("nan"), 1e9
LARGE = [HUGE if k in (0, 5, 10) else 0 for k in range(12)]
REGRESSIONS = {
    "bad_error": head({"error": "the file is broken"}),
    "bad_empty_error": head({"error": ""}),
    "bad_nan_position": body(positions=[0, NAN, 0, 1, 0, 0, 0, 1, 0]),
    "bad_nan_move": body([WALK], rig(), keys=clip(move=(NAN, 1, 0))),
    "bad_nan_turn": body([WALK], rig(), keys=clip(turn=(NAN, 1, 0, 0))),
    "bad_falling_times": body([WALK], rig(), keys=clip(times=(1, 0))),
    "bad_nan_time": body([WALK], rig(), keys=clip(times=(0, NAN))),
    "bad_parent_after_child": body([WALK], rig(parents=(1, 0)), keys=clip()),
    "bad_weights": body([WALK], rig(weights=(1, 0.5, 0.2, 1)), keys=clip()),
    "bad_nan_weight": body([WALK], rig(weights=(1, NAN, 0.5, 1)), keys=clip()),
    "bad_missing_clip": body([WALK, WALK], rig(), keys=clip()),
    "bad_more_bytes": body() + b"more",
    "bad_huge_count": head({"bones": 0, "morphs": 0, "nodes": [], "clips": []}) + struct.pack("<Q", 1 << 61),
    "bad_huge_head": struct.pack("<Q", (1 << 64) - 1) + b"{}",
    "bad_missing_names": body(rig=rig()).replace(b'["hip","knee"]', b'["hip"]       '),
    "good_large_maps": body([WALK], rig(local=LARGE), keys=clip(move=(HUGE, HUGE, HUGE))),
}

for kind, files in (("seeds", SEEDS), ("regressions", REGRESSIONS)):
    folder = FOLDER / kind / "body"
    folder.mkdir(parents=True, exist_ok=True)
    for name, contents in files.items():
        (folder / f"{name}.bin").write_bytes(contents)
