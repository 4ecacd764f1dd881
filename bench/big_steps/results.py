"""Reads the results of run.sh: lines with part, method, dt and the result of a run as JSON, separated by tabs."""
import json

import heap

REFERENCE = ("tumble, splitting", "1e-4")


def read(path):
    """A dictionary from (method, dt) to the results of its runs, in the order of the starts; and the methods and time steps of
    the part `starts`."""
    runs, starts = {}, []
    with open(path, encoding="utf-8") as file:
        for line in file:
            part, method, dt, text = line.rstrip("\n").split("\t")
            result = json.loads(text)
            runs.setdefault((method, dt), []).append(result | derived(result))
            if part == "starts" and (method, dt) not in starts:
                starts.append((method, dt))
    return runs, starts


def derived(result):
    """Figures that follow from others."""
    depths = (result["deepest overlap of clumps (m)"], result["deepest overlap with a wall (m)"])
    return {
        "cost at rest": result["wall seconds, last"] / heap.LAST,
        "cost of the drop": result["wall seconds"] / result["simulated (s)"],
        "deepest overlap at the end (m)": max(depths),
    }


def seconds(dt):
    """The value of a time step such as 1/240 or 1e-3 (s)."""
    numerator, _, denominator = dt.partition("/")
    return float(numerator) / float(denominator or 1.0)
