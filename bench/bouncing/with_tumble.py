"""The bouncing body in tumble: the scene bouncing.toml with some values overridden."""
import csv
import json
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

from motion import BOUNCE, DROP, DROP_TIME, PHASES


class Tumble:
    """One row of the tables. `sets` are KEY=VALUE pairs for `--set`."""

    until = None  # runs all phases

    def __init__(self, command, folder, dt, label, sets):
        self.command, self.folder, self.dt, self.settings = command, pathlib.Path(folder), dt, label
        self.sets = [f"dt={dt!r}", *sets]
        version = subprocess.run([command, "--version"], capture_output=True, text=True, check=True)
        self.engine = f"tumble {version.stdout.split()[-1]}"
        shutil.copy(pathlib.Path(__file__).with_name("bouncing.toml"), self.folder)

    def _call(self, *arguments):
        subprocess.run([self.command, *map(str, arguments)], capture_output=True, check=True)

    def _run(self, out, start, duration, *more):
        keys = ("position", "initial_velocity", "initial_angular_velocity")
        sets = [f"body.{key}={list(value)}" for key, value in zip(keys, start)]
        sets += [f"duration={duration}", *self.sets, *more]
        # --force: dt exceeds the critical time step, which assumes that all particles are in contact at once
        options = [word for pair in sets for word in ("--set", pair)]
        self._call("run", self.folder / "bouncing.toml", "--force", "--out", out, *options)

    def seconds(self):
        """Wall-clock seconds of the steps of each phase."""
        seconds = []
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "run")
            for end in PHASES.values():
                if seconds:
                    self._call("resume", out, "--duration", end)
                else:
                    self._run(out, BOUNCE, end)
                # wall_seconds covers the steps since the run resumed
                seconds.append(json.loads(out.joinpath("summary.json").read_text())["wall_seconds"])
            return seconds

    def states(self, drop=False):
        """Position, orientation, velocity and angular velocity, one row per millisecond; no contacts."""
        start, end = (DROP, DROP_TIME) if drop else (BOUNCE, max(PHASES.values()))
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "run")
            self._run(out, start, end, "output.interval=1e-3")
            rows = csv.reader(out.joinpath("trajectory.csv").open())
            next(rows)
            return np.array([row[2:15] for row in rows][1:], float), None
