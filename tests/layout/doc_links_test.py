#!/usr/bin/env python3
"""The names in the documentation: prints those that do not exist; exits with 1 then.

    doc_links_test.py [ROOT]

- A relative link leads to a file or folder, and its #anchor to a heading.
- A path in backticks that begins with a folder of the sources names a file or folder. It may hold
  `*`, or NAME for the same, and a folder may end with `/`.
- A source in backticks without a folder, such as `plate.h`, is the name of some source.
- A dotted parameter in backticks is one of the table in sim/scene/parameters.cpp.
- docs/command-line.md names every option of the program, except --version.

Paths that are meant not to exist are listed in COMING; the first column of a table that is headed
`before` has old paths and is left out."""
import pathlib
import re
import sys

FOLDERS = (".ci", "app", "assets", "cmake", "docs", "kernels", "render", "sim", "tests")
SOURCE = re.compile(r"[\w*]+\.(h|cpp|cu|py|sh|glsl)")
PARAMETERS = "sim/scene/parameters.cpp"
OPTIONS = ("app/cli/commands.cpp", "app/common/command_options.h")
# Rooms of coming features, by name.
COMING = {"sim/files/checkpoint.*"}


def documents(root):
    yield root / "README.md"
    for folder in ("docs", "tests"):
        yield from sorted((root / folder).rglob("*.md"))


def anchors(text):
    """The anchors of the headings of a document, as the usual renderers of Markdown make them."""
    headings = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def prose(text):
    """(number, line) of what is not code, without the old paths of tables that are headed `before`."""
    code = old = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            code = not code
        old = line.startswith("| before |") or (old and line.startswith("|"))
        if not code:
            yield number, "|".join(line.split("|")[2:]) if old else line


def missing_link(document, link):
    """What is wrong with a link, or None."""
    path, _, anchor = link.partition("#")
    if re.match(r"[a-z]+:", link):
        return None
    target = document.parent / path if path else document
    if not target.exists():
        return "no such file"
    if anchor and anchor not in anchors(target.read_text()):
        return "no such heading"
    return None


class Names:
    """What a name in backticks may be."""

    def __init__(self, root):
        self.root = root
        self.sources = [path.name for folder in FOLDERS for path in (root / folder).rglob("*")]
        self.sources += [path.name for path in root.iterdir()]
        table = (root / PARAMETERS).read_text()
        self.parameters = set(re.findall(r'^    \{"([a-z_]+\.[a-z_]+)"', table, re.M))
        self.groups = {name.split(".")[0] for name in self.parameters}

    def fault(self, name):
        """What is wrong with a name, or None."""
        if name in COMING or " " in name:
            return None
        if name.startswith(tuple(folder + "/" for folder in FOLDERS)):
            found = any(True for _ in self.root.glob(name.rstrip("/").replace("NAME", "*")))
            return None if found else "no such path"
        if SOURCE.fullmatch(name):
            pattern = re.compile(name.replace(".", r"\.").replace("*", r"\w*"))
            return None if any(map(pattern.fullmatch, self.sources)) else "no such source"
        parameter = name.split("=")[0]
        if re.fullmatch(r"[a-z_]+\.[a-z_]+", parameter) and parameter.split(".")[0] in self.groups:
            return None if parameter in self.parameters else "no such parameter"
        return None


def unnamed_options(root):
    """The options of the command line that docs/command-line.md does not have."""
    page = (root / "docs/command-line.md").read_text()
    found = {option for file in OPTIONS for option in re.findall(r'"(--[a-z-]+)', (root / file).read_text())}
    return sorted(option for option in found - {"--version"} if not re.search(option + r"(?![a-z-])", page))


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    names, faults, checked = Names(root), [], 0
    for document in documents(root):
        for number, line in prose(document.read_text()):
            found = [(link, missing_link(document, link)) for link in re.findall(r"\]\(([^)\s]+)\)", line)]
            found += [(name, names.fault(name)) for name in re.findall(r"`([^`]+)`", line)]
            checked += len(found)
            faults += [f"{document.relative_to(root)}:{number}: {name}: {fault}" for name, fault in found if fault]

    faults += [f"docs/command-line.md: option {option} is not named" for option in unnamed_options(root)]
    print("\n".join(faults) or f"{checked} links and names: all exist")
    return 1 if faults or not checked else 0


if __name__ == "__main__":
    sys.exit(main())
