"""The bouncing body in MuJoCo: a mesh geometry, which MuJoCo replaces by its convex hull, between six planes."""
import os
import tempfile
import time

import mujoco
import numpy as np

from common import rotations
from motion import BOUNCE, BOX, DROP, DROP_TIME, DT, FRICTION, GRAVITY, MASS, PHASES, setup

# MuJoCo's default time constant (s), and the damping ratio for which a flat drop rebounds at 0.7 of its speed
TIME_CONSTANT, DAMPING_RATIO = 0.02, 0.113

MODEL = """
<mujoco>
  <option gravity="0 0 {gravity}" timestep="{dt}" integrator="{integrator}">
    <!-- do not reset a diverging simulation without notice -->
    <flag autoreset="disable"/>
  </option>
  <default>
    <geom condim="3" friction="{friction} 0 0" solref="{time_constant} {damping_ratio}"/>
  </default>
  <asset>
    <mesh name="body" file="{folder}/body.obj" maxhullvert="{hull}"/>
  </asset>
  <worldbody>
    {walls}
    <body>
      <freejoint/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{moments}"/>
      <geom type="mesh" mesh="body"/>
    </body>
  </worldbody>
</mujoco>
"""


def walls():
    """Six planes with inward normals."""
    faces = [np.array(n) for axis in np.eye(3) for n in (axis, -axis)]
    plane = '<geom type="plane" size="0 0 1" pos="{}" zaxis="{}"/>'
    vectors = (" ".join(map(str, v)) for n in faces for v in (-BOX * n, n))
    return "\n    ".join(plane.format(pos, n) for pos, n in zip(vectors, vectors))


class MuJoCo:
    """One row of the tables: an integrator, and the maximum number of hull vertices (-1: no limit)."""

    engine = f"MuJoCo {mujoco.__version__}"
    until = None  # runs all phases

    def __init__(self, folder, integrator="Euler", hull=-1, damping_ratio=DAMPING_RATIO):
        self.dt = DT
        os.chdir(tempfile.mkdtemp())  # MuJoCo writes warnings to a file in the working directory
        self.model = mujoco.MjModel.from_xml_string(
            MODEL.format(
                gravity=-GRAVITY,
                dt=DT,
                integrator=integrator,
                friction=FRICTION,
                time_constant=TIME_CONSTANT,
                damping_ratio=damping_ratio,
                folder=os.path.abspath(folder),
                hull=hull,
                walls=walls(),
                mass=MASS,
                moments=" ".join(map(repr, setup(folder)["moments"])),
            )
        )
        graph = self.model.mesh_graph[self.model.mesh_graphadr[0] :]
        self.settings = f"{integrator}; hull of {graph[0]:,} points"

    def _start(self, motion):
        data = mujoco.MjData(self.model)
        position, velocity, spin = motion
        data.qpos[:3], data.qvel[:3] = position, velocity
        data.qvel[3:] = spin  # in the body frame, which is initially aligned with the world frame
        return data

    def seconds(self):
        """Wall-clock seconds of the steps of each phase."""
        data, seconds, done = self._start(BOUNCE), [], 0
        for end in PHASES.values():
            steps = round(end / DT) - done
            clock = time.perf_counter()
            mujoco.mj_step(self.model, data, steps)
            seconds.append(time.perf_counter() - clock)
            done += steps
        return seconds

    def states(self, drop=False):
        """Position, orientation, velocity and angular velocity, one row per step, and the number of contacts."""
        data = self._start(DROP if drop else BOUNCE)
        rows, contacts = [], []
        for _ in range(round((DROP_TIME if drop else max(PHASES.values())) / DT)):
            mujoco.mj_step(self.model, data)
            rows.append(np.concatenate((data.qpos, data.qvel)))
            contacts.append(data.ncon)
        states = np.array(rows)
        # angular velocity from the body frame to the world frame
        states[:, 10:] = np.einsum("nij,nj->ni", rotations(states[:, 3:7]), states[:, 10:])
        return states, np.array(contacts)
