"""Reads results (JSON, one per line) from standard input and prints Markdown tables of statistics over the starts."""
import json
import statistics
import sys

# column heading: (key of the result, statistic over the starts, format, scale factor)
SPEED = {
    "10⁶ body-steps/s, whole run": ("body-steps per wall second", "median", "{:.3f}", 1e-6),
    "last 0.5 s": ("body-steps per wall second, last", "median", "{:.3f}", 1e-6),
    "per second of processor time, whole run": ("body-steps per processor second", "median", "{:.3f}", 1e-6),
    "per second of processor time, last 0.5 s": ("body-steps per processor second, last", "median", "{:.3f}", 1e-6),
}
HEAP = {
    "mean height (m)": ("mean height (m)", "mean", "{:.4f}", 1.0),
    "contacts per clump": ("contacts per clump", "mean", "{:.2f}", 1.0),
    "wall contacts": ("wall contacts", "mean", "{:.0f}", 1.0),
    "at rest after (s)": ("time to rest (s)", "mean", "{:.2f}", 1.0),
    "deepest overlap at the end (mm)": ("deepest overlap at the end (m)", "max", "{:.2f}", 1e3),
    "deepest overlap of all samples (mm)": ("deepest overlap of all samples (m)", "max", "{:.2f}", 1e3),
    "kinetic energy per clump at the end (J)": ("kinetic energy per clump at the end (J)", "max", "{:.0e}", 1.0),
    "spheres outside": ("spheres outside", "sum", "{:.0f}", 1.0),
}


def cell(results, column):
    """The statistic of a column over all starts, with the standard error if it is a mean of several."""
    key, statistic, number_format, scale = column
    values = [result.get(key) for result in results]
    if any(value is None for value in values):
        missing = sum(value is None for value in values)
        return "–" if statistic == "median" or missing == len(values) else f"– for {missing} of {len(values)}"
    statistics_by_name = {"median": statistics.median, "mean": statistics.fmean, "max": max, "sum": sum}
    text = number_format.format(scale * statistics_by_name[statistic](values))
    if statistic == "mean" and len(values) > 1:
        text += " ± " + number_format.format(scale * statistics.stdev(values) / len(values) ** 0.5)
    return text


def table(groups, columns):
    """Prints a Markdown table with one row per engine, settings and number of clumps."""
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
    depths = (result["deepest overlap of clumps (m)"], result["deepest overlap with a wall (m)"])
    result["deepest overlap at the end (m)"] = max(depths)
    settings = ", ".join(f"{key} {value}" for key, value in result["settings"].items())
    key = (result["engine"], settings, result["clumps"], result["simulated (s)"])
    groups.setdefault(key, []).append(result)
if groups:
    table(groups, SPEED)
    table(groups, HEAP)
