#!/usr/bin/env python3
"""Makes the tables of the documentation from the recorded results and from the table of parameters.

    docs/make_tables.py            writes the tables and assets/results/presets.json
    docs/make_tables.py --check    changes nothing, exits with 1 where something is out of date

A table stands in a document between the lines `<!-- table NAME -->` and `<!-- end -->`; TABLES below
says how it is made. Measured numbers are kept in docs/results alone: whoever records a suite anew
runs this script, and no prose has to change."""
import json
import pathlib
import re
import sys

sys.dont_write_bytecode = True  # the folder of the documentation stays as it is
from read_parameters import read_parameters

DOCS = pathlib.Path(__file__).resolve().parent
ROOT = DOCS.parent
RESULTS = DOCS / "results"
SCENES = ("flag", "scarf", "sphere", "drape")
PRESETS = ("fast", "normal", "accurate")
AS_IN_SCENE = "as in the scene"


def recorded_file(name):
    """The file of that name that one of the folders of machines holds: a suite is recorded once."""
    found = sorted(RESULTS.glob("*/" + name))
    if len(found) != 1:
        sys.exit(f"docs/results: {len(found)} folders hold {name}, expected 1")
    return found[0]


def recorded(suite):
    """The results file of a suite."""
    return json.loads(recorded_file(f"{suite}.json").read_text())


def number(value):
    """A value of a results file as text: numbers as they are, an empty cell as nothing."""
    return "" if value in (None, "") else f"{value:g}" if isinstance(value, float) else str(value)


def markdown(head, rows):
    """Lines of a table with a heading row."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


class Accuracy:
    """What `icloth bench accuracy` has written: one table of points a scene, and the parts."""

    def __init__(self):
        data = recorded("accuracy")
        self.machine = data["machine"]
        self.points = {scene: data["tables"]["accuracy_" + scene] for scene in SCENES}
        self.parts = data["tables"]["parts"]
        # What two references differ by is a sentence of the report, one a scene, in their order.
        sentence = r"twice its step it is ([\d.e-]+) mm, ([\d.e-]+) % of the energy and ([\d.e-]+) % of the area"
        found = re.findall(sentence, recorded_file("accuracy.txt").read_text())
        self.resolved = dict(zip(SCENES, found, strict=True))

    def point(self, scene, setting, value=None):
        """The first row of a scene with this setting (and value), or None."""
        for row in self.points[scene]:
            if row["setting"] == setting and value in (None, row["value"]):
                return row
        return None

    def settings(self):
        """(setting, value) of all rows that vary one thing, in the order of the first scene."""
        left_out = ("preset", AS_IN_SCENE, "thickness", "mesh", "combination")
        seen = []
        for row in self.points[SCENES[0]]:
            key = (row["setting"], row["value"])
            if row["setting"] not in left_out and key not in seen:
                seen.append(key)
        return seen


def preset_table(accuracy):
    def cell(row, faster):
        if row is None:
            return ""
        parts = [f"{number(row['times faster'])} ×"] if faster else []
        parts += [f"{number(row['position [mm]'])} mm", f"{number(row['energy [%]'])} %",
                  f"{number(row['covered area [%]'])} %"]
        return " · ".join(parts)

    rows = []
    for preset in PRESETS:
        rows.append([f"`--preset {preset}`"] +
                    [cell(accuracy.point(scene, "preset", preset), True) for scene in SCENES])
    rows.append([AS_IN_SCENE] + [cell(accuracy.point(scene, AS_IN_SCENE), True) for scene in SCENES])
    rows.append(["reference with twice its step"] +
                ["{} mm · {} % · {} %".format(*accuracy.resolved[scene]) for scene in SCENES])
    return markdown([""] + list(SCENES), rows)


def settings_table(accuracy):
    rows = []
    for setting, value in accuracy.settings():
        row = [f"{setting} {value}"]
        for scene in SCENES:
            point = accuracy.point(scene, setting, value)
            row.append("" if point is None else
                       f"{number(point['position [mm]'])} mm · {number(point['times faster'])} ×")
        rows.append(row)
    return markdown(["setting"] + list(SCENES), rows)


def mesh_table(accuracy):
    rows = []
    for scene in SCENES:
        for point in accuracy.points[scene]:
            if point["setting"] in ("thickness", "mesh"):
                rows.append([scene, f"{point['setting']} {point['value']}"] +
                            [number(point[k]) for k in ("times faster", "position [mm]", "energy [%]", "covered area [%]")])
    return markdown(["scene", "setting", "times faster", "position [mm]", "energy [%]", "area [%]"], rows)


def parts_table(accuracy):
    head = list(accuracy.parts[0])
    return markdown(head, [[number(row[key]) for key in head] for row in accuracy.parts])


def quick_table(_):
    """The rows of `icloth bench quick`, whose columns stand at fixed places of a text."""
    lines = recorded_file("quick.txt").read_text().splitlines()
    machine, rows = lines[0].rsplit(",", 1)[0], []
    for line in lines[2:]:
        name, values = line[:24].strip(), line[24:].split()
        build, triangles, steps, rate, median, _, peak = values
        rows.append([name, build, triangles, steps, rate, f"{median} ms", f"{peak} MB"])
    head = ["scene", "build", "triangles", "steps", "steps/s", "median step", "peak memory"]
    return [machine, ""] + markdown(head, rows)


def zone_solver_table(_):
    """`icloth bench paper`: steps from the same tangled states with each solver of impact zones."""
    rows = [[f"`{row['solver']}`"] + [number(row[key]) for key in ("rounds", "iterations", "ms collisions", "impacts left", "max strain")]
            for row in recorded("paper")["tables"]["zone_solvers"]]
    return markdown(["solver", "rounds", "iterations", "ms for collisions", "impacts left", "largest strain"], rows)


def preconditioner_table(_):
    """`icloth bench solver`: one line a state, from the four rows that the suite prints of it."""
    states = {}
    for row in recorded("solver")["tables"]["preconditioners"]:
        states.setdefault((row["scene"], row["step"]), {})[row["what"], row["preconditioner"]] = row
    rows = []
    for (scene, step), cells in states.items():
        first = cells["first solve", "multilevel"]
        rows.append([scene, str(step), number(first["contacts"]),
                     number(cells["first solve", "block_jacobi"]["iterations a solve"]),
                     number(first["iterations a solve"]), number(first["times faster"]),
                     number(cells["step", "multilevel"]["times faster"])])
    return markdown(["scene", "step", "contacts", "iterations, block-Jacobi", "iterations, multilevel",
                     "first solve, times faster", "all solves of the step, times faster"], rows)


def drape_table(_):
    """`icloth bench validation --case drape`: the coefficient of each fabric with two meshes."""
    drape = next(case for case in recorded("validation")["results"] if case["name"] == "drape")
    rows = []
    for figure in drape["figures"]:
        fabric, _, what = figure["what"].partition(", ")
        if what.startswith("DC with edges of 2.5 and 5 mm"):
            rows.append([f"`{fabric}`", f"{figure['reference']:.1f} %", f"{figure['measured']:.1f} %"])
    return markdown(["fabric", "edges of 2.5 mm", "edges of 5 mm"], rows)


def parameter_table(_):
    """The parameters of a simulation, from the table that the program works with."""
    return markdown(["parameter", "default", "values", "a lower value, or the first", "a higher value, or the others"],
                    read_parameters(ROOT / "sim" / "scene"))


def paper_table(name, columns=None):
    """A table of `icloth bench paper` with some of its columns; a line where it is not recorded yet."""
    def make(_):
        rows = recorded("paper")["tables"].get(name)
        if not rows:
            return ["*Not recorded yet: `icloth bench paper --out FOLDER` writes it.*"]
        head = columns or list(rows[0])
        return markdown(head, [[number(row[key]) for key in head] for row in rows])
    return make


def paper_machine(_):
    """What the recorded run of `icloth bench paper` was measured on."""
    machine = recorded("paper")["machine"]
    return [f"{machine['processor']}, {machine['threads']} threads, "
            f"{machine['memory_bandwidth'] / 1e9:.1f} GB/s, {machine['compiler']}, commit `{machine['commit'][:7]}`."]


def runs_table(_):
    """Which suites are recorded, each with its machine and the commit that it ran at."""
    commits = {path.stem: recorded(path.stem)["machine"]["commit"] for path in RESULTS.glob("*/*.json")}
    commits["quick"] = recorded_file("quick.txt").read_text().splitlines()[0].rsplit(" ", 1)[1]
    rows = []
    for suite, commit in sorted(commits.items()):
        files = sorted(RESULTS.glob(f"*/{suite}.*"))
        links = ", ".join(f"[{path.name}]({path.relative_to(RESULTS)})" for path in files)
        rows.append([f"`{suite}`", files[0].parent.name, f"`{commit[:7]}`", links])
    return markdown(["suite", "machine", "commit", "files"], rows)


TABLES = {"quick": quick_table, "runs": runs_table, "parameters": parameter_table, "presets": preset_table, "settings": settings_table, "meshes": mesh_table, "parts": parts_table,
          "paper_machine": paper_machine, "paper_speed": paper_table("fig8_speed"), "paper_collisions": paper_table("fig8_collisions"),
          "paper_andy": paper_table("fig5_andy"), "paper_funnel": paper_table("fig5_funnel"), "paper_gradient": paper_table("fig6"),
          "paper_large_steps": paper_table("fig7"), "paper_incremental": paper_table("fig9"), "paper_incremental_all": paper_table("fig9_all"), "paper_collision_steps": paper_table("fig10"),
          "paper_time_steps": paper_table("fig11"), "paper_stages": paper_table("fig12"), "paper_responses": paper_table("response"),
          "paper_attempts": paper_table("single_attempts"), "paper_frames": paper_table("frames"),
          "paper_stretches": paper_table("stretches", ["benchmark", "steps", "what happens", "clip starts at [s]", "way", "steps made", "steps/s",
                                                       "ms collisions", "substeps", "retries", "rounds", "rolled back", "penetrations"]),
          "zone_solvers": zone_solver_table, "preconditioners": preconditioner_table, "drape": drape_table}


def presets_file(accuracy):
    """What the program shows beside its presets: for each the measured points of the scenes."""
    machine = accuracy.machine
    points = {}
    for name in (AS_IN_SCENE,) + PRESETS:
        points[name] = []
        for scene in SCENES:
            row = accuracy.point(scene, name) if name == AS_IN_SCENE else accuracy.point(scene, "preset", name)
            points[name].append({"scene": scene, "times_faster": row["times faster"],
                                 "position_mm": row["position [mm]"], "energy_percent": row["energy [%]"]})
    source = f"icloth bench accuracy, {machine['processor']}, {machine['threads']} threads, commit {machine['commit']}"
    return json.dumps({"source": source, "presets": points}, indent=1) + "\n"


def replaced(text, accuracy, path):
    """The text of a document with all of its tables made anew."""
    def table(match):
        name = match.group(1)
        if name not in TABLES:
            sys.exit(f"{path}: table '{name}' is not known, expected one of {', '.join(TABLES)}")
        return "\n".join([match.group(0).split("\n", 1)[0]] + TABLES[name](accuracy) + ["<!-- end -->"])
    return re.sub(r"<!-- table (\w+) -->\n.*?<!-- end -->", table, text, flags=re.S)


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    accuracy = Accuracy()
    wanted = {ROOT / "assets" / "results" / "presets.json": presets_file(accuracy)}
    for path in sorted(DOCS.glob("*.md")) + [DOCS / "results" / "README.md", ROOT / "README.md"]:
        wanted[path] = replaced(path.read_text(), accuracy, path)
    stale = [path for path, text in wanted.items() if not path.exists() or path.read_text() != text]
    for path in stale:
        if check:
            print(f"{path.relative_to(ROOT)}: out of date, run docs/make_tables.py")
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(wanted[path])
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
