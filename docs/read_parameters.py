"""Reads the table of parameters in sim/scene/parameters.cpp, for make_tables.py."""
import re
import sys


def choices_of(source):
    """Enumeration -> the names of its values."""
    lists = dict(re.findall(r"constexpr std::string_view (k\w+)\[\] = \{(.*?)\};", source, re.S))
    return {enum: re.findall(r'"(\w+)"', lists[name])
            for enum, name in re.findall(r"names_of\((\w+)\) \{ return (k\w+); \}", source)}


def defaults_of(header):
    """(struct, member) -> (type, default)."""
    found = {}
    for struct, body in re.findall(r"^struct (\w+Parameters) \{\n(.*?)\n\};", header, re.S | re.M):
        for kind, line in re.findall(r"^  (\w+) (\w+ = [^;]+);", body, re.M):
            for member, value in re.findall(r"(\w+) = ([^,]+)", line):
                found[struct, member] = kind, value
    return found


def read_parameters(folder):
    """A row for each parameter: name, default, values, what lower and what higher values do."""
    source, header = (folder / "parameters.cpp").read_text(), (folder / "parameters.h").read_text()
    names, defaults = choices_of(source), defaults_of(header)
    structs = dict(re.findall(r"^using (\w+) = (\w+Parameters);", source, re.M))
    table = re.search(r"constexpr ParameterInfo kTable\[\] = \{\n(.*?)\n\};", source, re.S).group(1)
    rows = []
    for entry in re.findall(r"^    \{(.*?)\},$", table, re.S | re.M):
        # Texts that go on in the next line are one text.
        entry = re.sub(r'"\s+"', "", " ".join(entry.split()))
        words = re.findall(r'"([^"]*)"', entry)
        struct, member, least, most = re.search(r"field<&(\w+)::(\w+)>\(\), ([^,]+), ([^,]+),", entry).groups()
        kind, default = defaults[structs.get(struct, struct), member]
        default = default.split("::")[-1]

        # Numbers have a range, choices and switches have their names.
        if kind in names:
            values = ", ".join(f"`{choice}`" for choice in names[kind])
        elif kind == "bool":
            values, default = "on, off", "on" if default == "true" else "off"
        else:
            values = f"{float(least):g}…{float(most):g} {words[2]}".strip().replace("-", "−")
            default = f"{float(default):g}".replace("-", "−")
        rows.append([f"`{words[0]}`", default] + [values] + words[3:5])
    if len(rows) != table.count("field<"):
        sys.exit("sim/scene/parameters.cpp: kTable is not laid out as docs/read_parameters.py expects it")
    return rows
