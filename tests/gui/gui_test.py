#!/usr/bin/env python3
"""Drags the cloth in the real window on a virtual display, as a user would, and looks at what came
of it. Usage: gui_test.py ICLOTH [OUTPUT_FOLDER]. Exit code 77: a tool or OpenGL is missing."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from png import changed_pixels, read_png  # noqa: E402

SKIPPED = 77
SCENE = ["scarf", "--set", "triangles=800"]
LOWEST_FPS = 8        # while the mouse moves; software rendering on two busy cores
MOST_PAUSED = 0.1     # of a core, by a window with nothing new to show
START_TIMEOUT = 150   # [s]
DRAG = (110, -60)     # [pixels]


def skip(reason):
    print("skipped:", reason)
    sys.exit(SKIPPED)


class Window:
    """The program on a display of its own."""

    def __init__(self, program, folder, scene=SCENE, variables=None):
        os.makedirs(folder, exist_ok=True)
        self.folder, self.seen = folder, []
        self.status_file = os.path.join(folder, "status.json")
        self.recording = os.path.join(folder, "session.json")
        self.server, display = self.start_server()
        self.environment = dict(os.environ, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1",
                                ICLOTH_TEST_STATUS=self.status_file, **(variables or {}))
        self.log = open(os.path.join(folder, "icloth.log"), "w")
        self.process = subprocess.Popen(
            [program, "view", *scene, "--device", "cpu", "--screenshots", folder, "--record",
             self.recording], env=self.environment, stdout=self.log, stderr=self.log)
        self.window = None

    @staticmethod
    def start_server():
        read_end, write_end = os.pipe()
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1280x800x24", "-nolisten",
             "tcp"], pass_fds=[write_end], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            number = pipe.readline().strip()
        if not number:
            skip("Xvfb does not start")
        return server, ":" + number

    def xdotool(self, *words):
        done = subprocess.run(["xdotool", *map(str, words)], env=self.environment, text=True,
                              capture_output=True, check=False)
        return done.stdout.strip()

    def key(self, name):
        # A window without a manager gets the keyboard only when it is asked for.
        self.xdotool("windowfocus", self.window)
        self.xdotool("key", name)

    def status(self):
        try:
            with open(self.status_file) as file:
                status = json.load(file)
        except FileNotFoundError:
            return None
        if not self.seen or self.seen[-1] != status:
            self.seen.append(status)
        return status

    def wait(self, condition, what, timeout=60):
        end = time.time() + timeout
        while time.time() < end:
            code = self.process.poll()
            if code is not None:
                self.log.flush()
                with open(self.log.name) as file:
                    text = file.read()
                if code == 3:
                    skip("no OpenGL 4.5 on the virtual display: " + text)
                raise AssertionError(f"the program ended with code {code}: {text}")
            status = self.status()
            if status and condition(status):
                return status
            time.sleep(0.1)
        raise AssertionError(f"not in {timeout} s: {what}; last status {self.status()}")

    def next_status(self, count=1):
        for _ in range(count):
            before = self.status()
            self.wait(lambda s: s != before, "a new status line")
        return self.status()

    def wait_until_up(self):
        self.wait(lambda s: s["step"] >= 3, "the first steps", START_TIMEOUT)
        self.find_window()

    def find_window(self):
        self.window = self.xdotool("search", "--name", "icloth").split("\n")[0]
        assert self.window, "no window with the program's name"

    def screenshot(self):
        before = {f for f in os.listdir(self.folder) if f.endswith(".png")}
        self.key("F12")
        end = time.time() + 30
        while time.time() < end:
            new = {f for f in os.listdir(self.folder) if f.endswith(".png")} - before
            if new:
                time.sleep(0.3)  # until it is written
                return read_png(os.path.join(self.folder, new.pop()))
            time.sleep(0.1)
        raise AssertionError("F12 wrote no picture")

    def quit(self):
        """Ends the program as a user does."""
        self.key("ctrl+q")
        code = self.process.wait(60)
        assert code == 0, f"Ctrl+Q ended with code {code}"

    def close(self):
        for process in (self.process, self.server):
            if process.poll() is None:
                process.kill()
                process.wait()
        self.log.close()


def drag(window, start, way, end_key=None):
    window.xdotool("mousemove", *start)
    time.sleep(0.3)
    window.xdotool("mousedown", 1)
    time.sleep(0.2)
    for k in range(1, 13):
        window.xdotool("mousemove", round(start[0] + way[0] * k / 12),
                       round(start[1] + way[1] * k / 12))
        time.sleep(0.05)
    window.next_status(2)
    if end_key:
        window.key(end_key)
        time.sleep(0.3)
    window.xdotool("mouseup", 1)


def check_drag(window):
    # Where the cloth is drawn is known once a second, so it has to hang still enough to be hit.
    window.wait(lambda s: s["cloth_visible"] and s["step"] > 250 and s["max_speed"] < 0.5,
                "cloth at rest in the view", START_TIMEOUT)
    for attempt in range(3):
        before_picture, before = window.screenshot(), window.next_status()
        start = before["cloth_pixel"]
        drag(window, start, DRAG, "p")
        after = window.next_status(2)
        if after["parked"] == 1:
            break
        print(f"attempt {attempt + 1} missed the cloth at {start}: {after}")
    assert after["parked"] == 1, "one parked handle"
    after_picture = window.screenshot()
    moved = [b - a for a, b in zip(before["mean"], after["mean"])]
    print(f"mean of the cloth moved by {moved} m in {after['step'] - before['step']} steps")
    assert sum(m * m for m in moved) ** 0.5 > 2e-3, "the cloth did not follow the hand"
    assert after["handles"] == 1, "a parked handle stays when the button goes up"
    target = (start[0] + DRAG[0], start[1] + DRAG[1])
    changed = changed_pixels(before_picture, after_picture,
                             (min(start[0], target[0]) - 40, min(start[1], target[1]) - 40,
                              abs(DRAG[0]) + 80, abs(DRAG[1]) + 80))
    print(f"{changed} pixels changed around the drag")
    assert changed > 400, "the picture did not change where the cloth was dragged"


def check_keys(window):
    window.key("x")
    window.wait(lambda s: s["handles"] == 0, "X releases the handle")
    window.key("Tab")
    window.wait(lambda s: not s["panels"], "Tab hides the panels")
    window.key("Tab")
    window.wait(lambda s: s["panels"], "Tab shows the panels")
    window.key("space")
    paused = window.wait(lambda s: not s["playing"], "Space pauses")
    time.sleep(1)
    paused = window.next_status()
    window.key("Right")
    window.wait(lambda s: s["step"] == paused["step"] + 1, "Right makes one step")
    window.key("Left")
    window.wait(lambda s: s["step"] == paused["step"], "Left takes it back")
    window.key("Escape")
    time.sleep(1)
    assert window.process.poll() is None, "Esc must not quit"


def offset(status):
    """From the middle of the cloth to the eye of the camera [m]."""
    return [e - m for e, m in zip(status["eye"], status["mean"])]


def processor_seconds(process):
    with open(f"/proc/{process.pid}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def check_frames(window):
    """Frames come while the mouse moves, and cost nothing while nothing happens."""
    left, top, width, height = window.next_status()["view"]
    end, k = time.time() + 2.5, 0
    while time.time() < end:
        k += 1
        window.xdotool("mousemove", left + width // 2 + k % 40, top + 30)
        time.sleep(0.03)
    busy = window.next_status()["fps"]
    time.sleep(2)
    before = processor_seconds(window.process)
    time.sleep(3)
    paused = (processor_seconds(window.process) - before) / 3
    print(f"{busy:.0f} fps while the mouse moves; paused {100 * paused:.1f} % of a core")
    assert busy >= LOWEST_FPS, "the window is too slow"
    assert paused <= MOST_PAUSED, "a paused window works"


def check_cameras(window):
    first = window.next_status()["eye"]
    for name, axis, sign in (("F5", 2, 1), ("F6", 2, -1), ("F7", 0, -1), ("F8", 0, 1), ("F9", 1, 1)):
        window.key(name)
        window.wait(lambda s: offset(s)[axis] * sign > 0.8 * sum(x * x for x in offset(s)) ** 0.5,
                    f"{name} looks from its side")
    window.key("shift+Home")
    window.wait(lambda s: max(abs(a - b) for a, b in zip(s["eye"], first)) < 1e-6,
                "Shift+Home is the camera of the scene")

    # A drag beside the cloth that would go below the floor ends above it.
    status = window.next_status()
    left, top, width, height = status["view"]
    start = (left + 20, top + height - 20)
    window.xdotool("mousemove", *start)
    window.xdotool("mousedown", 1)
    for k in range(1, 9):
        window.xdotool("mousemove", start[0], start[1] - 60 * k)
        time.sleep(0.05)
    window.xdotool("mouseup", 1)
    window.wait(lambda s: s["eye"][1] < first[1] - 0.1, "the drag lowers the eye")
    assert window.next_status(2)["eye"][1] > -1e-3, "the eye is below the floor"
    window.key("shift+Home")


def check_reload(window):
    before = window.next_status()
    window.key("F5")
    window.wait(lambda s: s["eye"] != before["eye"], "another camera")
    eye = window.next_status()["eye"]
    window.key("ctrl+r")
    again = window.wait(lambda s: 3 <= s["step"] < before["step"], "the scene from its start",
                        START_TIMEOUT)
    assert again["eye"] == eye, "the camera stays"
    window.find_window()


def check_end(window, program):
    window.quit()
    worst = max(s["penetrations"] for s in window.seen)
    print(f"{len(window.seen)} status lines, penetrations {worst}")
    assert worst == 0, "penetrations were reported"
    done = subprocess.run([program, "replay", window.recording, "--quiet"],
                          text=True, capture_output=True, check=False, env=window.environment)
    assert done.returncode == 0, f"the session does not repeat: {done.stdout}{done.stderr}"


def check_recording(program, folder, recording):
    """A recording opens in the window, which makes its steps again and stays at their end."""
    with open(recording) as file:
        steps = len(json.load(file)["steps"])
    window = Window(program, os.path.join(folder, "recording"), [recording])
    try:
        window.wait(lambda s: s["step"] == steps, f"step {steps}", START_TIMEOUT)
        window.find_window()
        time.sleep(1)
        assert window.next_status()["step"] == steps, "it goes on only when asked to"
        window.key("Left")
        window.wait(lambda s: s["step"] == steps - 1, "one step back")
        window.quit()
    finally:
        window.close()
    print(f"a recording of {steps} steps was opened")


def check_no_display(program):
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run([program, "view", *SCENE, "--device", "cpu"], env=environment, text=True,
                          capture_output=True, check=False, timeout=START_TIMEOUT)
    assert done.returncode == 3, f"without a display: code {done.returncode}, expected 3"
    assert "display" in done.stderr, done.stderr


def check_choice(program, folder):
    """As from the menu of a desktop: without a file the window asks for a scene."""
    window = Window(program, os.path.join(folder, "choice"), scene=["--choose"])
    try:
        window.wait(lambda s: s["phase"] == "choosing", "the list of scenes", START_TIMEOUT)
        window.find_window()
        window.quit()
    finally:
        window.close()


def prepare(prefix):
    """The program and an empty folder for its files; skips the test where a tool is missing."""
    for tool in ("Xvfb", "xdotool"):
        if not shutil.which(tool):
            skip(f"{tool} is not installed")
    folder = sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp(prefix=prefix)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    return sys.argv[1], folder


def main():
    program, folder = prepare("icloth_gui_")
    check_no_display(program)
    check_choice(program, folder)
    window = Window(program, folder)
    try:
        window.wait_until_up()
        check_drag(window)
        check_keys(window)
        check_cameras(window)
        check_frames(window)
        check_reload(window)
        check_end(window, program)
    finally:
        window.close()
    check_recording(program, folder, window.recording)
    print("passed; pictures in", folder)


if __name__ == "__main__":
    main()
