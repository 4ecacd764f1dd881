"""The bouncing body in Rapier, simulated by the program in `rapier/`."""
import subprocess

import numpy as np

from motion import BOUNCE, DROP, DROP_TIME, DT, PHASES

NAMES = {"hull": "convex hull", "parts": "convex decomposition", "trimesh": "triangle mesh"}


class Rapier:
    """One row of the tables: a precision, a collision shape, and optionally the time (s) after which to stop."""

    engine = "Rapier 0.36.1"

    def __init__(self, program, folder, precision, shape, until=None):
        self.command, self.dt, self.folder, self.until = [program], DT, str(folder), until
        self.options = (precision, shape)
        self.settings = f"{precision}; {NAMES[shape]}"
        if until:
            self.settings += f"; first {until:g} s only, once"

    def _run(self, mode, motion, *ends):
        numbers = [str(v) for vector in motion for v in vector]
        arguments = [mode, *self.options, self.folder, *numbers, *map(str, ends)]
        out = subprocess.run(self.command + arguments, capture_output=True, text=True, check=True)
        return out.stdout.splitlines()

    def seconds(self):
        """Wall-clock seconds of the steps of each phase."""
        ends = [self.until] if self.until else PHASES.values()
        return [float(line) for line in self._run("time", BOUNCE, *ends)]

    def states(self, drop=False):
        """Position, orientation, velocity and angular velocity, one row per step, and the number of contacts."""
        motion, end = (DROP, DROP_TIME) if drop else (BOUNCE, max(PHASES.values()))
        rows = np.array([line.split() for line in self._run("states", motion, end)], float)
        return rows[:, :13], rows[:, 13]
