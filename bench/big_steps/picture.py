"""Draws penetration against cost, one point per method and time step, from the first start.

picture.py RESULTS FILE: FILE is an .svg or a .png.
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams |= {"font.family": "sans-serif", "font.size": 9, "svg.hashsalt": "big_steps", "svg.fonttype": "none"}
from matplotlib import pyplot
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, StrMethodFormatter

from results import read, seconds

INK, GRID = "#2D343E", "#E2E6EC"
PANELS = {
    "deepest overlap at rest (mm)": "deepest overlap at the end (m)",
    "mean overlap at rest (mm)": "mean overlap (m)",
    "deepest overlap while it falls, every 0.1 s (mm)": "deepest overlap of all samples (m)",
}
# shades of one colour for one engine
COLOURS = {
    "tumble": ["#C0392B", "#E67E22", "#7B241C"],
    "Rapier": ["#1F618D", "#3498DB", "#16A085", "#48C9B0", "#7F8C8D"],
    "MuJoCo": ["#6C3483", "#AF7AC5", "#D2B4DE"],
    "LAMMPS": ["#000000"],
}
MARKERS = {"1e-4": "x", "1e-3": "o", "1/480": "D", "1/240": "s", "1/120": "^", "1/60": "*"}


def curves(runs):
    """A dictionary from method to its time steps and the results from the first start, from the smallest step on."""
    found = {}
    for (method, dt), results in sorted(runs.items(), key=lambda item: seconds(item[0][1])):
        found.setdefault(method, []).append((dt, results[0]))
    return dict(sorted(found.items(), key=lambda item: (list(COLOURS).index(engine(item[0])), item[0])))


def engine(method):
    """The program of a method."""
    return method.split(",")[0]


def colours(methods):
    """A colour for each method."""
    left = {name: iter(palette) for name, palette in COLOURS.items()}
    return {method: next(left[engine(method)], INK) for method in methods}


def draw_panel(axes, title, key, found, colour):
    """One panel: a line per method, a marker per time step."""
    for method, points in found.items():
        x = [result["cost at rest"] for _, result in points]
        y = [1e3 * result[key] for _, result in points]
        axes.plot(x, y, color=colour[method], linewidth=1.3 if engine(method) != "tumble" else 2.2, zorder=2)
        for (dt, _), at, depth in zip(points, x, y):
            size = 11 if MARKERS[dt] == "*" else 6.5
            edge = None if MARKERS[dt] == "x" else "white"
            style = {"markersize": size, "color": colour[method], "markeredgecolor": edge or colour[method]}
            axes.plot(at, depth, MARKERS[dt], **style, markeredgewidth=0.6 if edge else 2.0, zorder=3)
    axes.set(xscale="log", yscale="log", xlabel="s of one core per simulated s, at rest")
    axes.set_title(title, fontsize=10, color=INK, loc="left")
    axes.grid(which="major", color=GRID)
    axes.set_axisbelow(True)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_locator(LogLocator(subs="all"))
        axis.set_minor_formatter("")
    axes.spines[["top", "right"]].set_visible(False)


def style_of(points):
    """The sign of a method in the legend: its line, or its marker if it has only one point."""
    if len(points) > 1:
        return {"linewidth": 2}
    marker = MARKERS[points[0][0]]
    return {"linestyle": "", "marker": marker, "markeredgewidth": 2.0 if marker == "x" else 0.6}


def legends(figure, found, colour):
    """The methods and the time steps, below the panels."""
    lines = [
        Line2D([], [], color=colour[method], label=method, **style_of(points))
        for method, points in found.items()
    ]
    used = {dt for points in found.values() for dt, _ in points}
    marks = [
        Line2D([], [], color=INK, marker=marker, linestyle="", markersize=9 if marker == "*" else 6.5, label=f"dt = {dt} s")
        for dt, marker in MARKERS.items()
        if dt in used
    ]
    figure.legend(handles=lines, loc="lower left", bbox_to_anchor=(0.04, 0.01), ncols=3, frameon=False)
    figure.legend(handles=marks, loc="lower right", bbox_to_anchor=(0.98, 0.01), ncols=2, frameon=False)


def main():
    runs, _ = read(sys.argv[1])
    found = curves(runs)
    colour = colours(found)
    clumps = next(iter(runs.values()))[0]["clumps"]
    figure, axes = pyplot.subplots(1, len(PANELS), figsize=(13, 5.6), sharex=True)
    for ax, (title, key) in zip(axes, PANELS.items()):
        draw_panel(ax, title, key, found, colour)
    figure.suptitle(f"A heap of {clumps:,} clumps: penetration and cost", x=0.04, ha="left", color=INK, fontsize=13)
    legends(figure, found, colour)
    figure.subplots_adjust(left=0.05, right=0.98, top=0.86, bottom=0.3, wspace=0.2)
    path = pathlib.Path(sys.argv[2])
    figure.savefig(path, dpi=110, metadata={"Date": None} if path.suffix == ".svg" else None)


main()
