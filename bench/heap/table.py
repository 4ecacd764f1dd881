"""Makes Markdown tables of the results (JSON, one a line) on standard input: means over the starts that were run."""
import json
import statistics
import sys

# each column: what of a result, how the starts are summed up, how that is shown
SPEED = {
    "10⁶ body-steps/s, whole": ("body-steps a wall second", "median", "{:.3f}", 1e-6),
    "last 0.5 s": ("body-steps a wall second, last", "median", "{:.3f}", 1e-6),
    "of processor time, whole": ("body-steps a processor second", "median", "{:.3f}", 1e-6),
    "of processor time, last 0.5 s": ("body-steps a processor second, last", "median", "{:.3f}", 1e-6),
}
HEAP = {
    "mean height (m)": ("mean height (m)", "mean", "{:.4f}", 1.0),
    "contacts a clump": ("contacts a clump", "mean", "{:.2f}", 1.0),
    "wall contacts": ("wall contacts", "mean", "{:.0f}", 1.0),
    "at rest after (s)": ("time to rest (s)", "mean", "{:.2f}", 1.0),
    "deepest at the end (mm)": ("deepest", "max", "{:.2f}", 1e3),
    "deepest of all looks (mm)": ("deepest of all looks (m)", "max", "{:.2f}", 1e3),
    "kinetic a clump at the end (J)": ("kinetic a clump at the end (J)", "max", "{:.0e}", 1.0),
    "spheres outside": ("spheres outside", "sum", "{:.0f}", 1.0),
}


def cell(results, column):
    """One number of all starts; a mean with its standard error where there are several."""
    key, kind, form, unit = column
    values = [result.get(key) for result in results]
    if any(value is None for value in values):
        missing = sum(value is None for value in values)
        return "–" if kind == "median" or missing == len(values) else f"– for {missing} of {len(values)}"
    sums = {"median": statistics.median, "mean": statistics.fmean, "max": max, "sum": sum}
    text = form.format(unit * sums[kind](values))
    if kind == "mean" and len(values) > 1:
        text += " ± " + form.format(unit * statistics.stdev(values) / len(values) ** 0.5)
    return text


def table(groups, columns):
    """A Markdown table, one row for each engine and number of clumps."""
    rows = [["engine", "settings", "clumps", "simulated (s)", "starts", *columns]]
    rows.append(["---"] * len(rows[0]))
    for (engine, settings, clumps, seconds), results in groups.items():
        row = [engine, settings, f"{clumps:,}", f"{seconds:g}", str(len(results))]
        rows.append(row + [cell(results, column) for column in columns.values()])
    for row in rows:
        print("|", " | ".join(row), "|")
    print()


groups = {}
for line in sys.stdin:
    result = json.loads(line)
    result["deepest"] = max(result["deepest overlap (m)"], result["deepest at a wall (m)"])
    settings = ", ".join(f"{key} {value}" for key, value in result["settings"].items())
    key = (result["engine"], settings, result["clumps"], result["simulated (s)"])
    groups.setdefault(key, []).append(result)
if groups:
    table(groups, SPEED)
    table(groups, HEAP)
