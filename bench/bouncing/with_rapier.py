"""The bouncing body in Rapier, whose program is given."""
import subprocess

import numpy as np

from motion import BOUNCE, DROP, DROP_TIME, DT, PHASES


class Rapier:
    """One row: a precision and a shape of the body, `trimesh` or `hull`."""

    engine = "Rapier 0.36.1"

    def __init__(self, program, folder, precision, shape):
        self.command, self.dt, self.folder = [program], DT, str(folder)
        self.words = (precision, shape)
        self.settings = f"{precision}; {shape}"

    def _call(self, what, motion, *ends):
        numbers = [str(v) for vector in motion for v in vector]
        words = [what, *self.words, self.folder, *numbers, *map(str, ends)]
        out = subprocess.run(self.command + words, capture_output=True, text=True, check=True)
        return out.stdout.splitlines()

    def seconds(self):
        """Seconds in the steps of each phase."""
        return [float(line) for line in self._call("time", BOUNCE, *PHASES.values())]

    def states(self, drop=False):
        """Position, orientation, velocity and angular velocity, one row a step, and its contacts."""
        motion, end = (DROP, DROP_TIME) if drop else (BOUNCE, max(PHASES.values()))
        rows = np.array([line.split() for line in self._call("look", motion, end)], float)
        return rows[:, :13], rows[:, 13]
