"""Prints the Markdown tables of the results of run.sh.

tables.py RESULTS HEAPS: HEAPS holds the output of `cargo bench --bench heaps`, or nothing.
"""
import pathlib
import statistics
import sys

from common import print_table, three_digits
from results import REFERENCE, read, seconds

SPEED = {
    "s per simulated s, at rest": ("cost at rest", "median", three_digits, 1.0),
    "s per simulated s, whole drop": ("cost of the drop", "median", three_digits, 1.0),
    "iterations per step, at rest": ("iterations per step, last", "mean", "{:.1f}".format, 1.0),
    "iterations per step, whole drop": ("iterations per step", "mean", "{:.1f}".format, 1.0),
    "steps not converged": ("steps not converged", "sum", "{:.0f}".format, 1.0),
    "at rest after (s)": ("time to rest (s)", "mean", "{:.2f}".format, 1.0),
}
HEAP = {
    "mean height (m)": ("mean height (m)", "mean", "{:.4f}".format, 1.0),
    "contacts per clump": ("contacts per clump", "mean", "{:.2f}".format, 1.0),
    "mean overlap at rest (mm)": ("mean overlap (m)", "mean", "{:.3f}".format, 1e3),
    "deepest at rest (mm)": ("deepest overlap at the end (m)", "mean", "{:.2f}".format, 1e3),
    "deepest of all samples (mm)": ("deepest overlap of all samples (m)", "mean", "{:.2f}".format, 1e3),
    "deepest of all steps (mm)": ("deepest overlap of all steps (m)", "mean", "{:.2f}".format, 1e3),
}
# column heading: (key, format, whether the ratio to `splitting` is as it should be)
AIMS = {
    "times faster at rest (aim: 12 or more)": ("cost at rest", "{:.1f}", lambda ratio: ratio >= 12.0),
    "times faster, whole drop (4 or more)": ("cost of the drop", "{:.1f}", lambda ratio: ratio >= 4.0),
    "mean height (within 1 %)": ("mean height (m)", "{:.3f}", lambda ratio: abs(ratio - 1.0) <= 0.01),
    "contacts per clump (within 3 %)": ("contacts per clump", "{:.3f}", lambda ratio: abs(ratio - 1.0) <= 0.03),
    "deepest of all steps (1.5 or less)": ("deepest overlap of all steps (m)", "{:.2f}", lambda ratio: ratio <= 1.5),
    "deepest of all samples": ("deepest overlap of all samples (m)", "{:.2f}", None),
    "deepest at rest": ("deepest overlap at the end (m)", "{:.2f}", None),
}
SPEEDUP = 1.6  # aim for two threads
FLAT = 1.3  # aim for the largest cost per clump over the smallest one


def error(values):
    """Standard error of the mean."""
    return statistics.stdev(values) / len(values) ** 0.5


def cell(results, column):
    """The statistic of a column over the starts, with the standard error if it is a mean of several."""
    key, statistic, text, scale = column
    values = [scale * result[key] for result in results if result.get(key) is not None]
    if not values:
        return "–"
    if len(values) < len(results):
        return f"– for {len(results) - len(values)} of {len(results)}"
    value = {"median": statistics.median, "mean": statistics.fmean, "sum": sum}[statistic](values)
    if statistic == "mean" and len(values) > 1:
        return f"{text(value)} ± {text(error(values))}"
    return text(value)


def statistics_table(runs, columns):
    """One row per method and time step."""
    rows = (
        [method, dt, str(len(results)), *(cell(results, column) for column in columns.values())]
        for (method, dt), results in runs.items()
    )
    print_table(["method", "dt (s)", "starts", *columns], rows)


def ratio(results, reference, key):
    """The ratio of a figure to the reference and its standard error, or None. A cost is a median and is inverted."""
    values, others = ([result.get(key) for result in group] for group in (results, reference))
    if None in values + others:
        return None
    if key.startswith("cost"):
        return statistics.median(others) / statistics.median(values), 0.0
    value = statistics.fmean(values) / statistics.fmean(others)
    if min(len(values), len(others)) < 2:
        return value, 0.0
    relative = (error(group) / statistics.fmean(group) for group in (values, others))
    return value, value * sum(part**2 for part in relative) ** 0.5


def ratio_cell(results, reference, aim):
    """A ratio with its error; bold where it misses the aim."""
    key, text, reaches = aim
    found = ratio(results, reference, key)
    if found is None:
        return "–"
    value, uncertainty = found
    words = text.format(value) + (f" ± {text.format(uncertainty)}" if uncertainty else "")
    return words if reaches is None or reaches(value) else f"**{words}**"


def ratio_table(runs):
    """The ratios to the reference."""
    reference = runs[REFERENCE]
    rows = (
        [method, dt, *(ratio_cell(results, reference, aim) for aim in AIMS.values())]
        for (method, dt), results in runs.items()
        if (method, dt) != REFERENCE
    )
    print_table(["method", "dt (s)", *AIMS], rows)


def judge_heaps(table):
    """Says how `implicit` does in the table of `cargo bench --bench heaps`."""
    lines = [line.strip("| ").split(" | ") for line in table.splitlines() if line.startswith("| ")]
    rows = [dict(zip(lines[0], line)) for line in lines[1:]]
    rows = [row for row in rows if row["integrator"] == "implicit"]
    speedups = (f"{row['one ÷ two']} for {int(row['clumps']):,} clumps" for row in rows)
    costs = [float(row["one thread (ns per clump and step)"]) for row in rows]
    print(f"A second core makes `implicit` faster by a factor of {', '.join(speedups)} (aim: {SPEEDUP}).")
    print(f"The largest cost per clump is {max(costs) / min(costs):.2f} times the smallest (aim: {FLAT} or less).\n")


def main():
    runs, starts = read(sys.argv[1])
    heaps = pathlib.Path(sys.argv[2]).read_text(encoding="utf-8").strip()
    of_starts = {key: runs[key] for key in starts}
    print("**Cost**\n")
    statistics_table(of_starts, SPEED)
    print("**Heap**\n")
    statistics_table(of_starts, HEAP)
    if REFERENCE in runs:
        print("**Ratios to `splitting`.** Bold: misses the aim.\n")
        ratio_table(of_starts)
    if heaps:
        print(f"**Heaps at rest, on one core and on two**\n\n{heaps}\n")
        judge_heaps(heaps)
    print("**Penetration and cost, from the first start**\n")
    first = {key: results[:1] for key, results in runs.items()}
    columns = {name: column for name, column in (SPEED | HEAP).items() if "iterations" not in name}
    by_method = sorted(first.items(), key=lambda item: (item[0][0], seconds(item[0][1])))
    statistics_table(dict(by_method), columns)


main()
