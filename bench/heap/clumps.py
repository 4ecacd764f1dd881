"""Writes the start of a heap into a folder, for every engine the same to the last bit.

clumps.py FOLDER N [SEED]: `start.csv`, position and orientation (w, x, y, z) of N clumps, N a cube number;
`heap.data` for LAMMPS; `heap.toml` for tumble.
"""
import csv
import pathlib
import sys

import numpy as np

import heap

LAMMPS_HEAD = """Clumps of eight spheres

{atoms} atoms
1 atom types
0.0 {width!r} xlo xhi
0.0 {width!r} ylo yhi
0.0 {height!r} zlo zhi

Atoms # hybrid

"""

# a dashpot in LAMMPS is the mass in motion times a rate; here all clumps are alike, so it is a number
TUMBLE_HEAD = """description = "A heap of {clumps} clumps of eight spheres"
duration = 3.0
dt = {dt!r}
gravity = [0.0, 0.0, {gravity!r}]

# clump on clump: half a clump's mass is in motion
[collision]
collision_stiffness = {k!r}
collision_damping = {damping!r}
friction_stiffness = {friction!r}
friction_spring = {k_t!r}
friction_damping = {friction_damping!r}

# clump on wall: a whole clump is
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


def start(clumps, seed):
    """Positions (m) and orientations (w, x, y, z): a lattice, each clump turned at random."""
    n = round(clumps ** (1.0 / 3.0))
    if n**3 != clumps:
        raise SystemExit(f"clumps.py: {clumps} is not a cube number")
    z, y, x = np.indices((n, n, n)).reshape(3, -1)
    # layer by layer from the floor
    position = np.column_stack((x, y, z)) * heap.PITCH
    position += (heap.PITCH / 2.0, heap.PITCH / 2.0, heap.FIRST)
    q = np.random.default_rng(seed).normal(size=(clumps, 4))
    return position, q / np.linalg.norm(q, axis=1)[:, None]


def height(clumps):
    """Where the box ends above (m): nothing gets there, and LAMMPS complains if something does."""
    return heap.width(clumps) + 1.0


def write_start(path, position, q):
    """`start.csv`."""
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(("px", "py", "pz", "qw", "qx", "qy", "qz"))
        rows.writerows(np.column_stack((position, q)).tolist())


def read_start(path):
    """Positions and orientations of `start.csv`."""
    rows = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    return rows[:, :3], rows[:, 3:]


def write_lammps(path, position, q):
    """`heap.data`: atom-ID, type, x, y, z, diameter, density, molecule-ID; spheres of a clump are a molecule."""
    centres = heap.spheres(position, q)
    clumps = len(position)
    head = LAMMPS_HEAD.format(atoms=8 * clumps, width=heap.width(clumps), height=height(clumps))
    with path.open("w") as file:
        file.write(head)
        for number, (x, y, z) in enumerate(centres.reshape(-1, 3).tolist()):
            place = f"{number + 1} 1 {x!r} {y!r} {z!r}"
            file.write(f"{place} {2.0 * heap.R!r} 1000.0 {number // 8 + 1}\n")


def write_tumble(path, position, q):
    """`heap.toml`; with_tumble.py says how long it runs."""
    clumps = len(position)
    with path.open("w") as file:
        file.write(TUMBLE_HEAD.format(
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
    position, q = start(int(clumps), int(seed[0]) if seed else 1)
    write_start(folder / "start.csv", position, q)
    write_lammps(folder / "heap.data", position, q)
    write_tumble(folder / "heap.toml", position, q)


if __name__ == "__main__":
    main()
