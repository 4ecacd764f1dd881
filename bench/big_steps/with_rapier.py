"""Simulates a heap with Rapier, with the program in `rapier/`.

with_rapier.py FOLDER SECONDS PROGRAM [KEY=VALUE…]: FOLDER holds the output of clumps.py; SECONDS is the simulated time.
Keys: dt (s), iterations, unit (m), frequency (Hz), recycling (0 or 1), see the program.
"""
import json
import pathlib
import subprocess
import sys

import numpy as np

import heap
from clumps import read_start
from frames import FRAME, result_of, steps_per_frame

# Rapier's defaults
SETTINGS = {"dt": 1.0 / 60.0, "iterations": 4, "unit": 1.0, "frequency": 30.0, "recycling": 1}
DENSITY = 1000.0  # kg/m^3


def frames_of(lines, clumps):
    """The states of all clumps in each frame, and the time of the steps up to each frame (s)."""
    blocks = [lines[at : at + clumps + 1] for at in range(0, len(lines), clumps + 1)]
    states = np.array([[row.split() for row in block[:-1]] for block in blocks], float)
    return states, [float(block[-1]) for block in blocks]


def main():
    folder, seconds, program, *words = sys.argv[1:]
    settings = SETTINGS | {key: float(value) for key, value in (word.split("=", 1) for word in words)}
    position, q = read_start(pathlib.Path(folder) / "start.csv")
    clumps, frames = len(position), round(float(seconds) / FRAME) + 1
    steps = steps_per_frame(settings["dt"])
    numbers = (heap.R, DENSITY, heap.FRICTION, heap.GRAVITY, heap.width(clumps), steps, frames, *settings.values())
    rows = np.column_stack((position, q)).tolist()
    lines = "".join(" ".join(map(repr, row)) + "\n" for row in rows)
    done = subprocess.run([program, *map(str, numbers)], input=lines, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"with_rapier.py: {(done.stderr.strip().splitlines() or ['no error message'])[-1]}")
    states, times = frames_of(done.stdout.splitlines(), clumps)
    result = result_of("Rapier 0.36.1", (position, q), states, times)
    print(json.dumps(result | {"settings": {key: str(value) for key, value in settings.items()}}))


if __name__ == "__main__":
    main()
