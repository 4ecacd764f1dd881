"""Which settings LAMMPS runs quickest with: prints a table.

tune.py FOLDER SECONDS: a heap that clumps.py wrote; each setting runs it anew for so many simulated seconds.
"""
import pathlib
import sys

import heap
from with_lammps import SETTINGS, Lammps

TRIED = (
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
    print("| settings | 10⁶ body-steps a second of processor time, falling and settling | the last 0.5 s | mean height (m) |")
    print("|---|---|---|---|")
    for other in TRIED:
        engine = Lammps(folder / "heap.data", other)
        first, then = engine.run(steps)[1], engine.run(last)[1]
        settings = ", ".join(f"{key} {value}" for key, value in (SETTINGS | other).items())
        rates = (engine.clumps * n / spent / 1e6 for n, spent in ((steps, first), (last, then)))
        height = heap.look(engine.centres())["mean height (m)"]
        print(f"| {settings} | {' | '.join(f'{rate:.3f}' for rate in rates)} | {height:.4f} |", flush=True)
        engine.lammps.close()


main()
