"""A heap in tumble.

with_tumble.py FOLDER SECONDS TUMBLE [KEY=VALUE…]: FOLDER holds what clumps.py wrote; SECONDS are simulated;
KEY=VALUE goes to `--set`. RAYON_NUM_THREADS says how many threads, one unless it is set.
"""
import csv
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import heap
from clumps import read_start

THREADS = os.environ.setdefault("RAYON_NUM_THREADS", "1")


def call(*words):
    """Runs tumble; if it fails, so does this script, with what tumble said."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode != 0:
        said = [line for line in done.stderr.splitlines() if line.strip()] or ["nothing said"]
        raise SystemExit(f"with_tumble.py: {words[1]}: {said[0]}")
    return done.stdout


def frames(path, clumps):
    """The rows of all clumps, one frame after the other; the whole file may be too large for memory."""
    rows = csv.reader(path.open())
    next(rows)
    while frame := list(itertools.islice(rows, clumps)):
        yield frame


def looks(path, clumps):
    """The looks at the heap, and the sphere centres at the start."""
    found, first, frame = [], None, None
    for number, frame in enumerate(frames(path, clumps)):
        if number == 0:
            first = centres(frame)
        if number % heap.LOOK == 0:
            found.append(heap.look(centres(frame)))
    if number % heap.LOOK != 0:
        found.append(heap.look(centres(frame)))
    return found, first


def centres(rows):
    """Centres of all spheres (m) from rows of trajectory.csv."""
    poses = np.array([row[2:9] for row in rows], float)
    return heap.spheres(poses[:, :3], poses[:, 3:])


def main():
    folder, seconds, tumble, *sets = sys.argv[1:]
    folder, seconds = pathlib.Path(folder), float(seconds)
    position, q = read_start(folder / "start.csv")
    version = call(tumble, "--version").split()[-1]
    wall = []
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch, "run")
        words = [f"duration={seconds - heap.LAST!r}", f"output.interval={heap.FRAME!r}", *sets]
        options = [word for pair in words for word in ("--set", pair)]
        call(tumble, "run", folder / "heap.toml", "--force", "--out", out, *options)
        wall.append(json.loads(out.joinpath("summary.json").read_text())["wall_seconds"])
        # of the steps since it was resumed
        call(tumble, "resume", out, "--duration", seconds)
        wall.append(json.loads(out.joinpath("summary.json").read_text())["wall_seconds"])
        with out.joinpath("energy.csv").open() as file:
            energies = [float(row["kinetic"]) for row in csv.DictReader(file)]
        found, first = looks(out / "trajectory.csv", len(position))
    start = np.abs(first - heap.spheres(position, q)).max()
    if start > 1e-12:
        raise SystemExit(f"with_tumble.py: the run does not start at start.csv: {start} m apart")
    engine = f"tumble {version}"
    result = heap.result(engine, len(position), energies, {"wall": (sum(wall), wall[-1])}, found)
    print(json.dumps(result | {"settings": {"threads": THREADS} | dict(word.split("=", 1) for word in sets)}))


if __name__ == "__main__":
    main()
