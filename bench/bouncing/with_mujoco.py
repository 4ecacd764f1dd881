"""The bouncing body in MuJoCo: a mesh geometry, which it takes as its convex hull, between six planes."""
import math
import os
import tempfile
import time

import mujoco
import numpy as np

from motion import BOUNCE, BOX, DROP, DROP_TIME, DT, FRICTION, GRAVITY, MASS, PHASES, rotations, setup

# a spring of MuJoCo's default time constant (s), with the damping ratio that throws back at 0.7
TIME_CONSTANT, DAMPING_RATIO = 0.02, 0.113

MODEL = """
<mujoco>
  <option gravity="0 0 {gravity}" timestep="{dt}" integrator="{integrator}">
    <!-- a run that blows up is not to start anew unseen -->
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
    """Six planes that look inwards."""
    faces = [np.array(n) for axis in np.eye(3) for n in (axis, -axis)]
    plane = '<geom type="plane" size="0 0 1" pos="{}" zaxis="{}"/>'
    words = (" ".join(map(str, v)) for n in faces for v in (-BOX * n, n))
    return "\n    ".join(plane.format(pos, n) for pos, n in zip(words, words))


class MuJoCo:
    """One row: an integrator, and the most vertices that the hull may have (-1: all)."""

    engine = f"MuJoCo {mujoco.__version__}"
    until = None  # all of it

    def __init__(self, folder, integrator="Euler", hull=-1, damping_ratio=DAMPING_RATIO):
        self.dt = DT
        os.chdir(tempfile.mkdtemp())  # MuJoCo writes its warnings into a file where it runs
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
        data.qvel[3:] = spin  # along the body's axes, which start along the world's
        return data

    def seconds(self):
        """Seconds in the steps of each phase."""
        data, spent, done = self._start(BOUNCE), [], 0
        for end in PHASES.values():
            steps = round(end / DT) - done
            clock = time.perf_counter()
            mujoco.mj_step(self.model, data, steps)
            spent.append(time.perf_counter() - clock)
            done += steps
        return spent

    def states(self, drop=False):
        """Position, orientation, velocity and angular velocity, one row a step, and its contacts."""
        data = self._start(DROP if drop else BOUNCE)
        rows, contacts = [], []
        for _ in range(round((DROP_TIME if drop else max(PHASES.values())) / DT)):
            mujoco.mj_step(self.model, data)
            rows.append(np.concatenate((data.qpos, data.qvel)))
            contacts.append(data.ncon)
        states = np.array(rows)
        # the angular velocity along the world's axes
        states[:, 10:] = np.einsum("nij,nj->ni", rotations(states[:, 3:7]), states[:, 10:])
        return states, np.array(contacts)
