#!/usr/bin/env python3
"""Opens a scene with garments in the real window on a virtual display: watches how they are put on,
cancels it, holds the dancing body, and pulls the cloth while it dances.
Usage: dressed_test.py ICLOTH [OUTPUT_FOLDER]. Exit code 77: a tool or OpenGL is missing."""
import os
import re
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from gui_test import LOWEST_FPS, Window, check_end, drag, prepare  # noqa: E402

SCENE = ["dressed", "--set", "triangles=2500"]
DRESS_TIMEOUT = 300   # [s] on two busy cores
DRAG = (90, -40)      # [pixels]
CANCEL_BUTTON = (57, 764)  # in a window of 1280 by 800 pixels


def colours(picture):
    """How many different colours a picture has: few where nothing but panels is drawn."""
    width, _, channels, rows = picture
    return len({row[channels * x:channels * x + 3] for row in rows[::4]
                for x in range(0, width, 4)})


def open_window(program, folder, name, cache):
    place = os.path.join(folder, name)
    os.makedirs(place)
    return Window(program, place, SCENE, {"XDG_CACHE_HOME": cache})


def check_cancel(program, folder):
    window = open_window(program, folder, "cancel", os.path.join(folder, "no_cache"))
    try:
        window.wait(lambda s: s["phase"] == "opening", "the screen of the opening")
        window.find_window()
        window.wait(lambda s: s["dressing_step"] >= 5, "dressing", DRESS_TIMEOUT)
        assert colours(window.screenshot()) > 300, "dressing is not drawn"
        window.xdotool("mousemove", *CANCEL_BUTTON)
        time.sleep(0.3)
        window.xdotool("click", 1)
        window.wait(lambda s: s["phase"] == "choosing", "Cancel leads to the list of scenes", 20)
        window.screenshot()
        window.quit()
    finally:
        window.close()
    steps = [s["dressing_step"] for s in window.seen]
    fps = sorted(s["fps"] for s in window.seen if s["dressing_step"] > 0)
    print(f"{len(steps)} status lines before the cancel, up to step {max(steps)} of dressing, fps "
          f"median {fps[len(fps) // 2]:.0f}, lowest {fps[0]:.0f}")
    assert fps[len(fps) // 2] >= LOWEST_FPS, "the window waits for dressing"


def check_garments(window):
    window.wait(lambda s: s["phase"] == "running" and s["step"] >= 5, "a dressed figure",
                DRESS_TIMEOUT)
    window.find_window()
    status = window.wait(lambda s: s["garments"], "seams and strains")
    print(status["garments"])
    found = re.fullmatch(r"sewn (\d+)/(\d+), max gap 0 mm, strain p95 ([\d.]+) %",
                         status["garments"])
    assert found and found.group(1) == found.group(2) != "0", status["garments"]
    assert float(found.group(3)) < 20, "the garments are stretched"


def check_hold(window):
    window.key("b")
    held = window.wait(lambda s: s["body_speed"] == 0, "B holds the bodies")
    window.wait(lambda s: s["step"] >= held["step"] + 5, "the cloth goes on")
    window.screenshot()
    window.key("b")
    window.wait(lambda s: s["body_speed"] == 1, "B lets them go on")


def check_pull(window):
    for attempt in range(5):
        before = window.wait(lambda s: s["cloth_visible"], "cloth in the view")
        drag(window, before["cloth_pixel"], DRAG, "p")
        after = window.next_status(2)
        if after["parked"] == 1:
            break
        print(f"attempt {attempt + 1} missed the cloth at {before['cloth_pixel']}")
        window.key("shift+x")
    assert after["parked"] == 1, "one parked handle"
    window.screenshot()
    window.wait(lambda s: s["step"] >= after["step"] + 5, "the dance goes on")
    window.key("x")
    window.wait(lambda s: s["handles"] == 0, "X releases the handle")


def main():
    program, folder = prepare("icloth_dressed_")
    check_cancel(program, folder)
    window = open_window(program, folder, "run", os.path.join(folder, "cache"))
    try:
        check_garments(window)
        check_hold(window)
        check_pull(window)
        check_end(window, program)
    finally:
        window.close()
    print("passed; pictures in", folder)


if __name__ == "__main__":
    main()
