"""Free tumbling in MuJoCo.

`implicit` is left out: for this body it gives the very numbers of `implicitfast`.
"""
import os
import tempfile

import mujoco
from score import MOMENTS, OMEGA, STEPS, TIME, row

# no geometry and so no contact; exact moments
MODEL = """
<mujoco>
  <option gravity="0 0 0" timestep="{dt}" integrator="{integrator}">
    <!-- a run that blows up is not to start anew unseen -->
    <flag autoreset="disable"/>
  </option>
  <worldbody>
    <body>
      <freejoint/>
      <inertial pos="0 0 0" mass="1" diaginertia="{moments}"/>
    </body>
  </worldbody>
</mujoco>
"""

os.chdir(tempfile.mkdtemp())  # MuJoCo writes its warnings into a file where it runs
for integrator in ("Euler", "implicitfast", "RK4"):
    for dt in STEPS:
        moments = " ".join(map(str, MOMENTS))
        model = mujoco.MjModel.from_xml_string(
            MODEL.format(dt=dt, integrator=integrator, moments=moments)
        )
        data = mujoco.MjData(model)
        data.qvel[3:] = OMEGA  # MuJoCo keeps it along the body's axes
        mujoco.mj_step(model, data, round(TIME / dt))
        row(f"MuJoCo {mujoco.__version__}", integrator, dt, data.qpos[3:], data.qvel[3:])
