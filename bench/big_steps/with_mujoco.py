"""Simulates a heap with MuJoCo: eight sphere geometries per body, and five planes.

with_mujoco.py FOLDER SECONDS [KEY=VALUE…]: FOLDER holds the output of clumps.py; SECONDS is the simulated time.
Keys: dt (s), solver (Newton, CG or PGS), time_constant (s, of contacts).
"""
import json
import os
import pathlib
import sys
import tempfile
import time

import mujoco
import numpy as np

import heap
from clumps import read_start
from frames import FRAME, result_of, steps_per_frame

# MuJoCo's defaults
SETTINGS = {"dt": "0.002", "solver": "Newton", "time_constant": "0.02"}

# the elliptic cone is Coulomb's law; with the pyramid, the default, clumps slide more easily and the heap is lower
MODEL = """
<mujoco>
  <size memory="4G"/>
  <option gravity="0 0 {gravity!r}" timestep="{dt}" cone="elliptic" solver="{solver}">
    <!-- do not reset a diverging simulation without notice -->
    <flag autoreset="disable"/>
  </option>
  <default>
    <geom condim="3" friction="{friction!r}" density="1000" solref="{time_constant} 1"/>
  </default>
  <worldbody>
    {walls}
    {bodies}
  </worldbody>
</mujoco>
"""
PLANE = '<geom type="plane" size="0 0 1" pos="{position}" zaxis="{normal}"/>'
BODY = '<body pos="{position}" quat="{orientation}"><freejoint/>{geometries}</body>'
SPHERE = '<geom type="sphere" size="{radius!r}" pos="{position}"/>'


def words(values):
    """The numbers, separated by spaces."""
    return " ".join(map(repr, np.ravel(values).tolist()))


def model(position, q, settings):
    """The compiled model."""
    far = heap.width(len(position))
    normals = np.vstack((np.eye(3), -np.eye(3)[:2]))
    points = np.vstack((np.zeros((3, 3)), np.full((2, 3), far)))
    geometries = "".join(SPHERE.format(radius=heap.R, position=words(corner)) for corner in heap.CORNERS)
    bodies = (
        BODY.format(position=words(x), orientation=words(orientation), geometries=geometries)
        for x, orientation in zip(position, q)
    )
    text = MODEL.format(
        gravity=-heap.GRAVITY,
        friction=heap.FRICTION,
        walls="".join(PLANE.format(position=words(x), normal=words(n)) for x, n in zip(points, normals)),
        bodies="\n    ".join(bodies),
        **settings,
    )
    return mujoco.MjModel.from_xml_string(text)


def state_of(data):
    """Position, orientation and velocities of each clump, one row per clump."""
    # the moments of a clump are equal, so that the axes of the angular velocity do not matter
    return np.hstack((data.qpos.reshape(-1, 7), data.qvel.reshape(-1, 6)))


def main():
    folder, seconds, *settings = sys.argv[1:]
    settings = SETTINGS | dict(word.split("=", 1) for word in settings)
    position, q = read_start(pathlib.Path(folder) / "start.csv")
    # MuJoCo writes warnings to a file in the working directory
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        compiled = model(position, q, settings)
        data = mujoco.MjData(compiled)
        states, times, steps = [state_of(data)], [0.0], steps_per_frame(float(settings["dt"]))
        for frame in range(1, round(float(seconds) / FRAME) + 1):
            clock = time.perf_counter()
            mujoco.mj_step(compiled, data, steps)
            times.append(times[-1] + time.perf_counter() - clock)
            states.append(state_of(data))
            print(f"{frame * FRAME:.1f} s: {times[-1]:.1f} s of wall-clock time", file=sys.stderr)
    result = result_of(f"MuJoCo {mujoco.__version__}", (position, q), np.array(states), times)
    print(json.dumps(result | {"settings": settings}))


if __name__ == "__main__":
    main()
