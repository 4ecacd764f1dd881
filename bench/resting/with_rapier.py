"""The scenes in Rapier, simulated by the program in `rapier/`."""
import subprocess

import numpy as np

from scenes import DURATION, FRICTION, GRAVITY, INTERVAL, MASS

NAMES = {"cuboid": "box primitive", "hull": "convex hull", "trimesh": "triangle mesh"}


class Rapier:
    """One row of each table: a collision shape."""

    engine = "Rapier 0.36.1"
    dt = 1.0 / 60.0  # Rapier's default

    def __init__(self, program, shape):
        self.settings = NAMES[shape]
        frames, steps = round(DURATION / INTERVAL) + 1, round(INTERVAL / self.dt)
        self.command = [program, shape, *map(str, (MASS, FRICTION, GRAVITY, self.dt, steps, frames))]

    def run(self, boxes):
        """The state of each body in each frame, and the wall-clock seconds of the steps."""
        rows = ([*box.size, *box.moments, *box.position, *box.orientation] for box in boxes)
        lines = "".join(" ".join(str(float(v)) for v in row) + "\n" for row in rows)
        out = subprocess.run(self.command, input=lines, capture_output=True, text=True, check=True)
        *states, seconds = out.stdout.splitlines()
        frames = np.array([line.split() for line in states], float).reshape(-1, len(boxes), 13)
        return frames, float(seconds)
