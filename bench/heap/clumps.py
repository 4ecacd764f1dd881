"""Writes the initial state of a heap into a folder, bit-identical for all engines.

clumps.py FOLDER N [SEED] writes `start.csv`, the position and orientation (w, x, y, z) of N clumps, where N is a cube
number; `heap.data` for LAMMPS; and `heap.toml` for tumble.
"""
import csv
import pathlib
import sys

import numpy as np

import heap

LAMMPS_HEADER = """Clumps of eight spheres

{atoms} atoms
1 atom types
0.0 {width!r} xlo xhi
0.0 {width!r} ylo yhi
0.0 {height!r} zlo zhi

Atoms # hybrid

"""

# a dashpot in LAMMPS is the effective mass times a rate; all clumps have the same mass, so it is a constant here
TUMBLE_HEADER = """description = "A heap of {clumps} clumps of eight spheres"
duration = 3.0
dt = {dt!r}
gravity = [0.0, 0.0, {gravity!r}]

# between clumps: the effective mass is half the mass of a clump
[collision]
collision_stiffness = {k!r}
collision_damping = {damping!r}
friction_stiffness = {friction!r}
friction_spring = {k_t!r}
friction_damping = {friction_damping!r}

# at walls: the effective mass is the mass of a clump
[box]
min = [0.0, 0.0, 0.0]
max = [{width!r}, {width!r}, {height!r}]
open = ["+z"]
collision_damping = {wall_damping!r}
friction_damping = {wall_friction_damping!r}

[output]
interval = {interval!r}
"""

TUMBLE_BODY = """
[[body]]
name = "clump {number}"
particles = {particles}
surface = "spheres"
particle_radius = {radius!r}
mass_model = "solid"
mass = {mass!r}
position = {position}
orientation = {orientation}
"""


def initial_state(clumps, seed):
    """Positions (m) and orientations (w, x, y, z) of clumps on a lattice, with random orientations."""
    n = round(clumps ** (1.0 / 3.0))
    if n**3 != clumps:
        raise SystemExit(f"clumps.py: {clumps} is not a cube number")
    z, y, x = np.indices((n, n, n)).reshape(3, -1)
    # layer by layer from the floor up
    position = np.column_stack((x, y, z)) * heap.PITCH
    position += (heap.PITCH / 2.0, heap.PITCH / 2.0, heap.FIRST)
    q = np.random.default_rng(seed).normal(size=(clumps, 4))
    return position, q / np.linalg.norm(q, axis=1)[:, None]


def height(clumps):
    """Height of the box (m), above all clumps at all times: LAMMPS fails if an atom leaves it."""
    return heap.width(clumps) + 1.0


def write_start(path, position, q):
    """Writes `start.csv`."""
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(("px", "py", "pz", "qw", "qx", "qy", "qz"))
        rows.writerows(np.column_stack((position, q)).tolist())


def read_start(path):
    """Reads positions and orientations from `start.csv`."""
    rows = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    return rows[:, :3], rows[:, 3:]


def write_lammps(path, position, q):
    """Writes `heap.data`: atom-ID, type, x, y, z, diameter, density, molecule-ID. A clump is a molecule."""
    centres = heap.spheres(position, q)
    clumps = len(position)
    header = LAMMPS_HEADER.format(atoms=8 * clumps, width=heap.width(clumps), height=height(clumps))
    with path.open("w") as file:
        file.write(header)
        for number, (x, y, z) in enumerate(centres.reshape(-1, 3).tolist()):
            atom = f"{number + 1} 1 {x!r} {y!r} {z!r}"
            file.write(f"{atom} {2.0 * heap.R!r} 1000.0 {number // 8 + 1}\n")


def write_tumble(path, position, q):
    """Writes `heap.toml`; with_tumble.py overrides the duration."""
    clumps = len(position)
    with path.open("w") as file:
        file.write(TUMBLE_HEADER.format(
            clumps=clumps,
            dt=heap.DT,
            gravity=-heap.GRAVITY,
            k=heap.K,
            k_t=heap.K_T,
            friction=heap.FRICTION,
            damping=heap.MASS / 2.0 * heap.GAMMA,
            friction_damping=heap.MASS / 2.0 * heap.GAMMA_T,
            wall_damping=heap.MASS * heap.GAMMA,
            wall_friction_damping=heap.MASS * heap.GAMMA_T,
            width=heap.width(clumps),
            height=height(clumps),
            interval=heap.FRAME,
        ))
        for number, (p, o) in enumerate(zip(position.tolist(), q.tolist())):
            file.write(TUMBLE_BODY.format(
                number=number, particles=heap.CORNERS.tolist(), radius=heap.R, mass=heap.MASS, position=p, orientation=o
            ))


def main():
    folder, clumps, *seed = sys.argv[1:]
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    position, q = initial_state(int(clumps), int(seed[0]) if seed else 1)
    write_start(folder / "start.csv", position, q)
    write_lammps(folder / "heap.data", position, q)
    write_tumble(folder / "heap.toml", position, q)


if __name__ == "__main__":
    main()
