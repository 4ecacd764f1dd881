"""The bouncing body in tumble, whose command is given: bouncing.toml, with numbers laid over it."""
import csv
import json
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

from motion import BOUNCE, DROP, DROP_TIME, PHASES


class Tumble:
    """One row: `sets` are laid over the scene, as with `--set`."""

    until = None  # all of it

    def __init__(self, command, folder, dt, label, sets):
        self.command, self.folder, self.dt, self.settings = command, pathlib.Path(folder), dt, label
        self.sets = [f"dt={dt!r}", *sets]
        words = subprocess.run([command, "--version"], capture_output=True, text=True, check=True)
        self.engine = f"tumble {words.stdout.split()[-1]}"
        shutil.copy(pathlib.Path(__file__).with_name("bouncing.toml"), self.folder)

    def _call(self, *words):
        subprocess.run([self.command, *map(str, words)], capture_output=True, check=True)

    def _run(self, out, start, duration, *more):
        keys = ("position", "initial_velocity", "initial_angular_velocity")
        sets = [f"body.{key}={list(value)}" for key, value in zip(keys, start)]
        sets += [f"duration={duration}", *self.sets, *more]
        # --force: a step above the critical one, which holds for all particles in contact at once
        options = [word for pair in sets for word in ("--set", pair)]
        self._call("run", self.folder / "bouncing.toml", "--force", "--out", out, *options)

    def seconds(self):
        """Seconds in the steps of each phase."""
        spent = []
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "run")
            for end in PHASES.values():
                if spent:
                    self._call("resume", out, "--duration", end)
                else:
                    self._run(out, BOUNCE, end)
                # of the steps since it was resumed
                spent.append(json.loads(out.joinpath("summary.json").read_text())["wall_seconds"])
            return spent

    def states(self, drop=False):
        """Position, orientation, velocity and angular velocity, one row a millisecond."""
        start, end = (DROP, DROP_TIME) if drop else (BOUNCE, max(PHASES.values()))
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "run")
            self._run(out, start, end, "output.interval=1e-3")
            rows = csv.reader(out.joinpath("trajectory.csv").open())
            next(rows)
            return np.array([row[2:15] for row in rows][1:], float), None
