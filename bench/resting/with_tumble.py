"""The scenes in tumble: closed triangle meshes of solid boxes, with the material of resting.toml."""
import csv
import json
import pathlib
import subprocess
import tempfile

import numpy as np

from scenes import DURATION, FRICTION, GRAVITY, INTERVAL, MASS

SCENE = f"""\
duration = {DURATION}
dt = 1e-4
gravity = [0.0, {-GRAVITY}, 0.0]

[collision]
collision_stiffness = 1e5
restitution = 0.3
friction_stiffness = {FRICTION}

[[wall]]
normal = [0.0, 1.0, 0.0]

[output]
interval = {INTERVAL}
"""
BODY = """
[[body]]
shape = "box"
size = {size}
mass = {mass}
mass_model = "solid"
surface = "mesh"
position = {position}
orientation = {orientation}
"""


def scene(boxes):
    """The scene file."""
    bodies = (
        BODY.format(
            size=list(box.size), mass=MASS, position=list(box.position), orientation=list(box.orientation)
        )
        for box in boxes
    )
    return SCENE + "".join(bodies)


class Tumble:
    """One row of each table."""

    settings = "triangle mesh"
    dt = 1e-4

    def __init__(self, command):
        self.command = command
        version = subprocess.run([command, "--version"], capture_output=True, text=True, check=True)
        self.engine = f"tumble {version.stdout.split()[-1]}"

    def run(self, boxes):
        """The state of each body in each frame, and the wall-clock seconds of the steps."""
        with tempfile.TemporaryDirectory() as folder:
            file, out = pathlib.Path(folder, "scene.toml"), pathlib.Path(folder, "run")
            file.write_text(scene(boxes))
            command = [self.command, "run", str(file), "--out", str(out)]
            subprocess.run(command, capture_output=True, text=True, check=True)
            rows = csv.reader(out.joinpath("trajectory.csv").open())
            next(rows)
            frames = np.array([row[2:15] for row in rows], float).reshape(-1, len(boxes), 13)
            return frames, json.loads(out.joinpath("summary.json").read_text())["wall_seconds"]
