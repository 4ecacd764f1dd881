"""Writes the cases to a folder, reads them with every program, and prints the comparison as Markdown.

Usage: compare.py MESH_FACTS FOLDER, where MESH_FACTS is the built example of tumble-io.
"""

import importlib.metadata
import json
import pathlib
import subprocess
import sys

import cases_gltf
import cases_obj
import cases_ply
import cases_stl
from case import Facts

LIBRARIES = ["trimesh", "meshio", "VTK"]
PROGRAMS = ["tumble", *LIBRARIES]
FORMATS = {"OBJ": cases_obj.CASES, "STL": cases_stl.CASES, "PLY": cases_ply.CASES, "glTF": cases_gltf.CASES}


def write(folder):
    """Writes all cases. Returns the path of each."""
    paths = {}
    for cases in FORMATS.values():
        for number, case in enumerate(cases):
            own = folder / case.extension / f"{number:03}"
            own.mkdir(parents=True)
            for name, content in case.sides.items():
                (own / name).parent.mkdir(exist_ok=True)
                (own / name).write_bytes(content)
            path = own / f"case.{case.extension}"
            path.write_bytes(case.content)
            assert case.name not in paths, case.name
            paths[case.name] = str(path)
    return paths


def read_with(command, paths):
    """What a program finds in each file. A file on which it crashes or hangs is skipped, and it goes on with the next."""
    found, left = {}, list(paths)
    while left:
        try:
            lines = subprocess.run([*command, *left], capture_output=True, timeout=300).stdout
            why = "crash"
        except subprocess.TimeoutExpired as error:
            lines, why = error.stdout or b"", "hangs"
        for line in lines.decode("utf-8", "replace").splitlines():
            text = line.removeprefix("facts ")
            if text.startswith("{"):
                entry = json.loads(text)
                found[entry["file"]] = entry["facts"]
        left = [path for path in left if path not in found]
        if left:
            found[left.pop(0)] = {"error": why}
    return found


def count(found, key):
    """A count with its noun."""
    one = {"vertices": "vertex", "triangles": "triangle"}[key]
    return f"{found[key]} {one if found[key] == 1 else key}"


def close(a, b):
    # some programs keep single precision
    return abs(a - b) <= 1e-6 * (1.0 + abs(b))


def verdict(expected, found):
    """A tick, or in what a program differs."""
    if "error" in found:
        word = found["error"] if found["error"] in ("crash", "hangs", "empty", "invalid") else "refused"
        # an empty mesh is as good as an error: it cannot be taken for the mesh of the file
        return "✓" if expected is None and word in ("refused", "empty") else word
    if expected is None:
        return f"read: {count(found, 'vertices')}, {count(found, 'triangles')}"
    differences = [count(found, key) for key in ("vertices", "triangles") if found[key] != getattr(expected, key)]
    if not close(found["volume"], expected.volume):
        differences.append(f"volume {found['volume']:.3g}".replace("-", "−"))
    bounds = zip((*expected.low, *expected.high), (*found["bounds"][0], *found["bounds"][1]))
    if not all(close(b, a) for a, b in bounds):
        differences.append("other bounds")
    return ", ".join(differences) or "✓"


def expectation(expected: Facts | None):
    if expected is None:
        return "refused"
    return f"{expected.vertices}, {expected.triangles}, {expected.volume:g}".replace("-", "−")


def table(cases, paths, found):
    reads = [p for p in PROGRAMS if not (p == "meshio" and cases is cases_gltf.CASES)]
    lines = ["| case | holds | " + " | ".join(reads) + " | rule |", "|---|---|" + "---|" * len(reads) + "---|"]
    agreed = dict.fromkeys(reads, 0)
    for case in cases:
        verdicts = [verdict(case.expected, found[program][paths[case.name]]) for program in reads]
        for program, word in zip(reads, verdicts):
            agreed[program] += word == "✓"
        name = case.name.split(" ", 1)[1]
        # a rule is needed only where someone differs
        rule = case.rule if set(verdicts) != {"✓"} else ""
        assert rule or set(verdicts) == {"✓"}, f"{case.name}: {verdicts} need a rule"
        lines.append(f"| {name} | {expectation(case.expected)} | " + " | ".join(verdicts) + f" | {rule} |")
    return lines, agreed


def main():
    mesh_facts, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    paths = write(folder)
    of = lambda format: [paths[case.name] for case in FORMATS[format]]
    everything = [path for format in FORMATS for path in of(format)]
    found = {"tumble": read_with([mesh_facts], everything)}
    script = str(pathlib.Path(__file__).with_name("readers.py"))
    for library in LIBRARIES:
        own = everything if library != "meshio" else [p for p in everything if p not in of("glTF")]
        found[library] = read_with([sys.executable, script, library], own)
    tables = {format: table(cases, paths, found) for format, cases in FORMATS.items()}
    versions = ", ".join(f"{name} {importlib.metadata.version(name.lower())}" for name in LIBRARIES)
    print(f"Versions: {versions}. In how many cases each does what the column *holds* says:\n")
    print("| format | cases | " + " | ".join(PROGRAMS) + " |\n|---|---|" + "---|" * len(PROGRAMS))
    for format, (_, agreed) in tables.items():
        print(f"| {format} | {len(FORMATS[format])} | " + " | ".join(str(agreed.get(p, "–")) for p in PROGRAMS) + " |")
    for format, (lines, _) in tables.items():
        print(f"\n## {format}\n")
        print("\n".join(lines))


if __name__ == "__main__":
    main()
