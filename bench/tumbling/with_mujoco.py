"""Free tumbling in MuJoCo.

`implicit` is left out because it gives the same numbers as `implicitfast` for this body.
"""
import os
import tempfile

import mujoco
from score import MOMENTS, OMEGA, STEPS, TIME, print_row

# no geometry, hence no contact; exact moments
MODEL = """
<mujoco>
  <option gravity="0 0 0" timestep="{dt}" integrator="{integrator}">
    <!-- do not reset a diverging simulation without notice -->
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

os.chdir(tempfile.mkdtemp())  # MuJoCo writes warnings to a file in the working directory
for integrator in ("Euler", "implicitfast", "RK4"):
    for dt in STEPS:
        moments = " ".join(map(str, MOMENTS))
        model = mujoco.MjModel.from_xml_string(
            MODEL.format(dt=dt, integrator=integrator, moments=moments)
        )
        data = mujoco.MjData(model)
        data.qvel[3:] = OMEGA  # in the body frame
        mujoco.mj_step(model, data, round(TIME / dt))
        print_row(f"MuJoCo {mujoco.__version__}", integrator, dt, data.qpos[3:], data.qvel[3:])
