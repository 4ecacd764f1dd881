"""Makes Markdown tables of the results (JSON, one a line) on standard input."""
import json
import sys

COLUMNS = {
    "clumps": lambda r: f"{r['clumps']:,}",
    "simulated (s)": lambda r: f"{r['simulated (s)']:g}",
}
SPEED = COLUMNS | {
    "10⁶ body-steps/s, whole": lambda r: f"{r['body-steps a wall second'] / 1e6:.3f}",
    "last 0.5 s": lambda r: f"{r['body-steps a wall second, last'] / 1e6:.3f}",
    "of processor time, whole": lambda r: millions(r.get("body-steps a processor second")),
    "of processor time, last 0.5 s": lambda r: millions(r.get("body-steps a processor second, last")),
    "wall s per simulated s": lambda r: f"{r['wall seconds'] / r['simulated (s)']:.3g}",
}
HEAP = COLUMNS | {
    "mean height (m)": lambda r: f"{r['mean height (m)']:.4f}",
    "pairs of spheres in contact": lambda r: f"{r['pairs in contact']:,}",
    "contacts a clump": lambda r: f"{r['contacts a clump']:.2f}",
    "wall contacts": lambda r: f"{r['wall contacts']:,}",
    "deepest at the end (mm)": lambda r: millimetres(max(r["deepest overlap (m)"], r["deepest at a wall (m)"])),
    "deepest of all looks (mm)": lambda r: millimetres(r["deepest of all looks (m)"]),
    "at rest after (s)": lambda r: "–" if r["time to rest (s)"] is None else f"{r['time to rest (s)']:.2f}",
    "kinetic a clump at the end (J)": lambda r: f"{r['kinetic a clump at the end (J)']:.0e}",
    "spheres outside": lambda r: f"{r['spheres outside']}",
}


def millions(value):
    return f"{value / 1e6:.3f}" if value else "–"


def millimetres(value):
    return f"{1e3 * value:.2f}"


def table(results, columns):
    """A Markdown table, one row a result."""
    rows = [["engine", "settings", *columns], ["---"] * (2 + len(columns))]
    for result in results:
        settings = ", ".join(f"{key} {value}" for key, value in result["settings"].items())
        rows.append([result["engine"], settings, *(cell(result) for cell in columns.values())])
    for row in rows:
        print("|", " | ".join(row), "|")
    print()


results = [json.loads(line) for line in sys.stdin]
if results:
    table(results, SPEED)
    table(results, HEAP)
