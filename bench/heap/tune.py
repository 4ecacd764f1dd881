"""Compares the speed of LAMMPS with different settings; prints a table.

tune.py FOLDER SECONDS: FOLDER holds the output of clumps.py. Each setting simulates SECONDS from the start.
"""
import pathlib
import sys

import heap
from with_lammps import SETTINGS, Lammps

VARIANTS = (
    {},
    {"skin": "0.005"},
    {"skin": "0.01"},
    {"skin": "0.03"},
    {"skin": "0.04"},
    {"check": "delay 5 every 1 check yes"},
    {"newton": "on"},
    {"rigid": "rigid/nve/small"},
    {},
)


def main():
    folder, seconds = pathlib.Path(sys.argv[1]), float(sys.argv[2])
    last = round(heap.LAST / heap.DT)
    steps = round(seconds / heap.DT) - last
    print("| settings | 10⁶ body-steps per second of processor time, falling and settling | last 0.5 s | mean height (m) |")
    print("|---|---|---|---|")
    for changes in VARIANTS:
        engine = Lammps(folder / "heap.data", changes)
        settling, at_rest = engine.run(steps)[1], engine.run(last)[1]
        settings = ", ".join(f"{key} {value}" for key, value in (SETTINGS | changes).items())
        rates = (engine.clumps * n / spent / 1e6 for n, spent in ((steps, settling), (last, at_rest)))
        height = heap.heap_statistics(engine.centres())["mean height (m)"]
        print(f"| {settings} | {' | '.join(f'{rate:.3f}' for rate in rates)} | {height:.4f} |", flush=True)
        engine.lammps.close()


main()
