"""The bouncing body in Rapier, whose program is given."""
import subprocess

import numpy as np

from motion import BOUNCE, DROP, DROP_TIME, DT, PHASES


NAMES = {"hull": "convex hull", "parts": "convex decomposition", "trimesh": "triangle mesh"}


class Rapier:
    """One row: a precision, a shape of the body, and how far it is run (s) where all would take too long."""

    engine = "Rapier 0.36.1"

    def __init__(self, program, folder, precision, shape, until=None):
        self.command, self.dt, self.folder, self.until = [program], DT, str(folder), until
        self.words = (precision, shape)
        self.settings = f"{precision}; {NAMES[shape]}"
        if until:
            self.settings += f"; first {until:g} s only, once"

    def _call(self, what, motion, *ends):
        numbers = [str(v) for vector in motion for v in vector]
        words = [what, *self.words, self.folder, *numbers, *map(str, ends)]
        out = subprocess.run(self.command + words, capture_output=True, text=True, check=True)
        return out.stdout.splitlines()

    def seconds(self):
        """Seconds in the steps of each phase."""
        ends = [self.until] if self.until else PHASES.values()
        return [float(line) for line in self._call("time", BOUNCE, *ends)]

    def states(self, drop=False):
        """Position, orientation, velocity and angular velocity, one row a step, and its contacts."""
        motion, end = (DROP, DROP_TIME) if drop else (BOUNCE, max(PHASES.values()))
        rows = np.array([line.split() for line in self._call("look", motion, end)], float)
        return rows[:, :13], rows[:, 13]
