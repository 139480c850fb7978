"""What tests/on_gpu.sh needs besides running commands: asking for the device, and the report.

on_gpu.py device            prints "CAPABILITY DRIVER NAME", e.g. "90 13.0 NVIDIA H200", or the reason
                            why there is none (exit code 1)
on_gpu.py report WORK OUT [DEVICE]
                            reads what the stages left in WORK, prints the table, writes OUT/results.json
                            and the files beside it; exit code 1 when something did not pass
"""
import ctypes
import datetime
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "gui"))
import png  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LOG_TAIL = 300_000  # bytes of each log that are kept
ON_DEVICE = re.compile(r"cuda32|OnDevice|CudaDevices")


# ---- the device

def device():
    """First device of the driver; asked directly, since nvidia-smi is not everywhere."""
    try:
        cuda = ctypes.CDLL("libcuda.so.1")
    except OSError:
        return None, "there is no NVIDIA driver (libcuda.so.1)"
    count, version, handle = ctypes.c_int(), ctypes.c_int(), ctypes.c_int()
    major, minor, name = ctypes.c_int(), ctypes.c_int(), ctypes.create_string_buffer(256)
    for what, error in (
            ("cuInit", lambda: cuda.cuInit(0)),
            ("cuDriverGetVersion", lambda: cuda.cuDriverGetVersion(ctypes.byref(version))),
            ("cuDeviceGetCount", lambda: cuda.cuDeviceGetCount(ctypes.byref(count))),
            ("cuDeviceGet", lambda: cuda.cuDeviceGet(ctypes.byref(handle), 0)),
            ("cuDeviceGetName", lambda: cuda.cuDeviceGetName(name, 256, handle)),
            ("cuDeviceGetAttribute", lambda: cuda.cuDeviceGetAttribute(ctypes.byref(major), 75, handle)),
            ("cuDeviceGetAttribute", lambda: cuda.cuDeviceGetAttribute(ctypes.byref(minor), 76, handle))):
        code = error()
        if code != 0:
            return None, f"{what} of the driver gives error {code}"
    return (f"{major.value}{minor.value} {version.value // 1000}.{version.value % 1000 // 10} "
            f"{name.value.decode(errors='replace')}"), None


# ---- what the stages left

class Findings:
    """Files of the work folder, and the table that is made of them."""

    def __init__(self, work):
        self.work = work
        self.table = []

    def path(self, name):
        return os.path.join(self.work, name)

    def text(self, name):
        try:
            with open(self.path(name), errors="replace") as file:
                return file.read()
        except OSError:
            return ""

    def step(self, name):
        """(exit code, seconds) of a step, or None where it did not run."""
        words = self.text(name + ".rc").split()
        return (int(words[0]), float(words[1])) if len(words) == 2 else None

    def row(self, name, passed, figure, target):
        self.table.append({"name": name, "result": "pass" if passed else "FAIL",
                           "figure": figure, "target": target})

    def failure(self, name):
        """Why a step failed, in a few words."""
        code, seconds = self.step(name)
        if code in (124, 137):
            return f"stopped after {seconds:.0f} s"
        lines = [line for line in self.text(name + ".log").splitlines() if line.strip()]
        return f"exit code {code}: {lines[-1].strip()[:90] if lines else 'no output'}"


def report_build(found):
    for name in ("configure", "compile"):
        step = found.step(name)
        if not step:
            continue
        warnings = len(re.findall(r"\bwarning\b[: #]", found.text(name + ".log")))
        figure = f"{step[1]:.0f} s, {warnings} warnings" if step[0] == 0 else found.failure(name)
        found.row(name, step[0] == 0, figure, "no error")


def read_tests(found):
    """[{name, status, seconds, output}] of ctest's JUnit file."""
    text = re.sub(r"[^\x09\x0a\x20-\ud7ff\ue000-\ufffd]", "?", found.text("tests.xml"))
    try:
        cases = xml.fromstring(text).iter("testcase")
    except xml.ParseError:
        return []
    tests = []
    for case in cases:
        status = {"run": "passed", "fail": "failed"}.get(case.get("status"), "skipped")
        tests.append({"name": case.get("name").split("  #")[0], "status": status,
                      "seconds": float(case.get("time") or 0),
                      "output": case.findtext("system-out") or ""})
    return tests


def report_tests(found):
    if not found.step("tests"):
        return {}
    tests = read_tests(found)
    if not tests:
        found.row("tests", False, found.failure("tests"), "0 failed")
        return {}
    counts = {}

    def count(name, chosen, may_skip):
        number = {s: sum(t["status"] == s for t in chosen) for s in ("passed", "failed", "skipped")}
        counts[name] = number
        passed = number["failed"] == 0 and number["passed"] > 0 and (may_skip or not number["skipped"])
        found.row(name, passed, ", ".join(f"{n} {s}" for s, n in number.items()),
                  "0 failed" + ("" if may_skip else ", 0 skipped"))

    count("all tests", tests, True)
    count("tests on the device", [t for t in tests if ON_DEVICE.search(t["name"])
                                  or "no device" in t["output"]], False)
    parity = [t for t in tests if "Parity." in t["name"] and t["name"].endswith("/cuda32")]
    count("cuda32 against cpu32", parity, False)
    for test in parity:
        line = re.search(r"largest distance to cpu32: ([\d.e+-]+) m, (.*)", test["output"])
        if line:
            found.row("scarf, 50 steps, cuda32 to cpu32", test["status"] == "passed",
                      f"{line[1]} m, {line[2]}", "< 1e-4 m")
    failed = [t | {"output": t["output"][-3000:]} for t in tests if t["status"] == "failed"]
    slowest = sorted(tests, key=lambda t: -t["seconds"])[:10]
    return {"counts": counts, "failed": failed,
            "skipped": [t["name"] for t in tests if t["status"] == "skipped"],
            "slowest": [[t["name"], t["seconds"]] for t in slowest]}


def sanitizer_runs():
    """Names of the logs: each checker with each line of device_runs.txt."""
    with open(os.path.join(os.path.dirname(__file__), "data", "device_runs.txt")) as lines:
        runs = [line.split()[0] for line in lines if not line.startswith("#")]
    return [f"{tool}_{run}" for tool in ("memcheck", "racecheck") for run in runs]


def report_sanitizer(found):
    for name in sanitizer_runs():
        step = found.step(name)
        if not step:
            continue
        line = re.search(r"(?:ERROR|RACECHECK) SUMMARY: (.*)", found.text(name + ".log"))
        clean = bool(line) and re.match(r"0 (errors|hazards)", line[1]) is not None
        figure = f"{line[1]}, {step[1]:.0f} s" if line else found.failure(name)
        found.row(f"compute-sanitizer {name}", clean and step[0] == 0, figure, "0 errors")


def report_bench(found):
    if found.step("info"):
        for ordinal, line in re.findall(r"(?m)^cuda:(\d+)\s+(.*)$", found.text("info.log")):
            copies = re.search(r"copies (.*)", line)
            found.row(f"copy bandwidth of cuda:{ordinal}", copies is not None,
                      copies[1] if copies else line[:90], "-")
    if not found.step("bench"):
        return {}
    try:
        bench = json.loads(found.text("bench/results.json"))
    except ValueError:
        found.row("bench", False, found.failure("bench"), "0 penetrations")
        return {}
    on_cpu = {r["name"]: r["state_hash"] for r in bench.get("results", []) if r["build"] == "cpu32"}
    for result in bench.get("results", []):
        same = "" if result["build"] == "cpu32" else \
            ", the bits of cpu32" if on_cpu.get(result["name"]) == result["state_hash"] else ", other bits"
        found.row(f"{result['name']}, {result['build']}",
                  result["penetrations"] == 0 and result["refused_steps"] == 0,
                  f"{result['ms_total']['median']:.2f} ms a step, {result['steps_per_second']:.1f} "
                  f"steps/s, {result['penetrations']} penetrations{same}", "0 penetrations")
    builds = {result["build"] for result in bench.get("results", [])}
    if "cuda32" not in builds:
        found.row("bench on the device", False, "did not run", "runs")
    return bench


def report_picture(found):
    steps = [found.step("picture_interop"), found.step("picture_host")]
    if None in steps:
        return
    for name, step in zip(("picture_interop", "picture_host"), steps):
        if step[0] != 0:
            found.row(name, False, found.failure(name), "drawn")
            return
    interop, host = (png.read_png(found.path(name)) for name in ("interop.png", "host.png"))
    if interop[:3] != host[:3]:
        found.row("interop and host copy", False, "sizes differ", "equal pixels")
        return
    step = interop[2]
    different = sum(a[i:i + step] != b[i:i + step] for a, b in zip(interop[3], host[3]) if a != b
                    for i in range(0, len(a), step))
    colours = len({row[i:i + step] for row in interop[3] for i in range(0, len(row), step)})
    found.row("interop and host copy", different == 0 and colours > 100,
              f"{different} pixels differ, {colours} colours", "equal pixels")


# ---- the report

def commit_of_tree():
    try:
        git = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty", "--abbrev=12",
                              "--exclude=*"], capture_output=True, text=True, check=True)
        return git.stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def compiler_version(found, language):
    """What CMake found out when the build folder was made."""
    pattern = os.path.join(os.path.dirname(found.work), "CMakeFiles", "*", f"CMake{language}Compiler.cmake")
    for path in glob.glob(pattern):
        with open(path, errors="replace") as file:
            version = re.search(rf'set\(CMAKE_{language}_COMPILER_VERSION "(.*)"\)', file.read())
        if version:
            return version[1]
    return ""


def describe(found, device_text):
    words = device_text.split(" ", 2) if device_text else ["", "", ""]
    commit = re.search(r"(?m)^icloth +\S+ \((.*)\)", found.text("info.log"))
    commit = commit[1] if commit else os.environ.get("ICLOTH_COMMIT") or commit_of_tree()
    return {"device": words[2], "compute_capability": f"{words[0][:-1]}.{words[0][-1:]}" if words[0] else "",
            "driver": words[1], "cuda": compiler_version(found, "CUDA"), "commit": commit,
            "compiler": compiler_version(found, "CXX"), "cores": os.cpu_count(),
            "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds")}


def text_table(head, table):
    lines = [f"{head['device'] or 'no device'}, driver {head['driver'] or '-'}, CUDA {head['cuda'] or '-'}, "
             f"commit {head['commit']}, {head['cores']} cores"]
    columns = ("name", "result", "figure", "target")
    rows = [dict(zip(columns, columns))] + table
    width = {c: max(len(row[c]) for row in rows) for c in columns}
    lines += ["  ".join(row[c].ljust(width[c]) for c in columns).rstrip() for row in rows]
    return "\n".join(lines) + "\n"


def write_logs(found, path):
    with open(path, "wb") as out:
        for name in sorted(os.listdir(found.work)):
            if name.endswith(".log"):
                with open(found.path(name), "rb") as file:
                    size = file.seek(0, os.SEEK_END)
                    file.seek(max(0, size - LOG_TAIL))
                    out.write(f"\n===== {name}\n".encode() + file.read())


def report(work, out, device_text):
    found = Findings(work)
    report_build(found)
    tests = report_tests(found)
    report_sanitizer(found)
    bench = report_bench(found)
    report_picture(found)
    head = describe(found, device_text)
    table = text_table(head, found.table)
    with open(os.path.join(out, "results.json"), "w") as file:
        json.dump(head | {"table": found.table, "tests": tests, "bench": bench,
                          "info": found.text("info.log").splitlines()}, file, indent=1)
    with open(os.path.join(out, "table.txt"), "w") as file:
        file.write(table)
    write_logs(found, os.path.join(out, "logs.txt"))
    for name in ("interop.png", "host.png"):
        if os.path.exists(found.path(name)):
            shutil.copy(found.path(name), out)
    print(table, end="")
    return 0 if all(row["result"] == "pass" for row in found.table) else 1


def main(words):
    if words[:1] == ["device"]:
        text, problem = device()
        print(text or problem)
        return 0 if text else 1
    if words[:1] == ["report"] and len(words) in (3, 4):
        return report(words[1], words[2], words[3] if len(words) == 4 else "")
    print(__doc__.strip(), file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
