"""The scenes in MuJoCo: mesh geometries of eight vertices, which MuJoCo treats as their convex hull."""
import os
import tempfile
import time

import mujoco
import numpy as np

from common import rotations
from scenes import DURATION, FRICTION, GRAVITY, INTERVAL, MASS

MODEL = """
<mujoco>
  <option gravity="0 {gravity} 0" timestep="{dt}">
    <!-- do not reset a diverging simulation without notice -->
    <flag autoreset="disable"/>
  </option>
  <default>
    <geom friction="{friction}"/>
  </default>
  <asset>
    {meshes}
  </asset>
  <worldbody>
    <geom type="plane" size="0 0 1" zaxis="0 1 0"/>
    {bodies}
  </worldbody>
</mujoco>
"""
BODY = """
    <body pos="{position}" quat="{orientation}">
      <freejoint/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{moments}"/>
      <geom type="mesh" mesh="{mesh}"/>
    </body>"""


def words(values):
    """The numbers, separated by spaces."""
    return " ".join(repr(float(value)) for value in np.ravel(values))


def model(boxes, dt):
    """The compiled model."""
    meshes = (f'<mesh name="{n}" vertex="{words(box.corners)}"/>' for n, box in enumerate(boxes))
    bodies = (
        BODY.format(
            position=words(box.position),
            orientation=words(box.orientation),
            mass=MASS,
            moments=words(box.moments),
            mesh=n,
        )
        for n, box in enumerate(boxes)
    )
    text = MODEL.format(
        gravity=-GRAVITY, dt=dt, friction=FRICTION, meshes="\n    ".join(meshes), bodies="".join(bodies)
    )
    return mujoco.MjModel.from_xml_string(text)


class MuJoCo:
    """One row of each table."""

    engine = f"MuJoCo {mujoco.__version__}"
    settings = "convex hull"
    dt = 0.002

    def __init__(self):
        os.chdir(tempfile.mkdtemp())  # MuJoCo writes warnings to a file in the working directory

    def run(self, boxes):
        """The state of each body in each frame, and the wall-clock seconds of the steps."""
        compiled = model(boxes, self.dt)
        data = mujoco.MjData(compiled)
        states, seconds = [], 0.0
        for frame in range(round(DURATION / INTERVAL) + 1):
            if frame > 0:
                clock = time.perf_counter()
                mujoco.mj_step(compiled, data, round(INTERVAL / self.dt))
                seconds += time.perf_counter() - clock
            states.append(np.hstack((data.qpos.reshape(-1, 7), data.qvel.reshape(-1, 6))))
        frames = np.array(states)
        # angular velocity from the body frame to the world frame
        frames[:, :, 10:] = np.einsum("tnij,tnj->tni", rotations(frames[:, :, 3:7]), frames[:, :, 10:])
        return frames, seconds
