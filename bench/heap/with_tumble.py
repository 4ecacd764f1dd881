"""Simulates a heap with tumble.

with_tumble.py FOLDER SECONDS TUMBLE [KEY=VALUE…]: FOLDER holds the output of clumps.py; SECONDS is the simulated
time; TUMBLE is the path of the command; each KEY=VALUE is passed to `--set`. RAYON_NUM_THREADS sets the number of threads
(default: 1).
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


def run_command(*arguments):
    """Runs a command and returns its standard output. If it fails, exits with the first line of its error message."""
    done = subprocess.run([str(argument) for argument in arguments], capture_output=True, text=True)
    if done.returncode != 0:
        message = [line for line in done.stderr.splitlines() if line.strip()] or ["no error message"]
        raise SystemExit(f"with_tumble.py: {arguments[1]}: {message[0]}")
    return done.stdout


def frames(path, clumps):
    """Yields the rows of all clumps frame by frame, since the file may not fit into memory."""
    rows = csv.reader(path.open())
    next(rows)
    while frame := list(itertools.islice(rows, clumps)):
        yield frame


def sample_statistics(path, clumps):
    """Heap statistics at regular intervals and at the end, and the sphere centres at the start."""
    samples, first, frame = [], None, None
    for number, frame in enumerate(frames(path, clumps)):
        if number == 0:
            first = centres(frame)
        if number % heap.FRAMES_PER_SAMPLE == 0:
            samples.append(heap.heap_statistics(centres(frame)))
    if number % heap.FRAMES_PER_SAMPLE != 0:
        samples.append(heap.heap_statistics(centres(frame)))
    return samples, first


def centres(rows):
    """Centres of all spheres (m) from rows of trajectory.csv."""
    poses = np.array([row[2:9] for row in rows], float)
    return heap.spheres(poses[:, :3], poses[:, 3:])


def solver_statistics(before, after):
    """Figures that only tumble reports, from the summaries at the start of the last part of the run and at its end."""
    result = {"deepest overlap of all steps (m)": after["max_depth"]}
    if "solver" in after:
        first, second = before["solver"], after["solver"]
        result["iterations per step"] = second["iterations"] / after["steps"]
        last = (second["iterations"] - first["iterations"]) / (after["steps"] - before["steps"])
        result["iterations per step, last"] = last
        result["steps not converged"] = second["steps_not_converged"]
    return result


def main():
    folder, seconds, tumble, *settings = sys.argv[1:]
    folder, seconds = pathlib.Path(folder), float(seconds)
    position, q = read_start(folder / "start.csv")
    version = run_command(tumble, "--version").split()[-1]
    summaries = []
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch, "run")
        pairs = [f"duration={seconds - heap.LAST!r}", f"output.interval={heap.FRAME!r}", *settings]
        options = [word for pair in pairs for word in ("--set", pair)]
        run_command(tumble, "run", folder / "heap.toml", "--force", "--out", out, *options)
        summaries.append(json.loads(out.joinpath("summary.json").read_text()))
        # wall_seconds covers the steps since the run resumed
        run_command(tumble, "resume", out, "--duration", seconds)
        summaries.append(json.loads(out.joinpath("summary.json").read_text()))
        with out.joinpath("energy.csv").open() as file:
            energies = [float(row["kinetic"]) for row in csv.DictReader(file)]
        samples, first = sample_statistics(out / "trajectory.csv", len(position))
    difference = np.abs(first - heap.spheres(position, q)).max()
    if difference > 1e-12:
        raise SystemExit(f"with_tumble.py: the first frame and start.csv differ by {difference} m")
    wall = [summary["wall_seconds"] for summary in summaries]
    engine = f"tumble {version}"
    result = heap.summarise(engine, len(position), energies, {"wall": (sum(wall), wall[-1])}, samples)
    result |= solver_statistics(*summaries)
    print(json.dumps(result | {"settings": {"threads": THREADS} | dict(word.split("=", 1) for word in settings)}))


if __name__ == "__main__":
    main()
