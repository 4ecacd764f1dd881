"""What all engines share: the clump, its start, the box, the law of contact, and how a heap is looked at.

SI units; z points up.
"""
import numpy as np
from scipy.spatial import cKDTree

# the clump: eight spheres on the corners of a cube, each touching three others
R = 0.05  # m, radius of a sphere
CORNERS = R * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
SPHERE_MASS = 1000.0 * 4.0 / 3.0 * np.pi * R**3  # kg, at 1000 kg/m^3
MASS = 8 * SPHERE_MASS  # 4.18879 kg
# kg m^2, the same about every axis: 2 R^2 for where a sphere is, 2/5 R^2 for the sphere itself
INERTIA = MASS * (2.0 + 2.0 / 5.0) * R**2
POINT_INERTIA = MASS * 2.0 * R**2  # of points in the place of the spheres

GRAVITY = 9.81  # m/s^2, along -z
DT = 1e-4  # s

# contact of two spheres, or of a sphere with a wall: overlap d, normal n, slip s, velocities v
#   F_n = max(0, K d - m g v_n), F_t = -(K_T s + m g_t v_t), |F_t| <= FRICTION F_n
# where m is MASS / 2 between clumps and MASS at a wall, g GAMMA and g_t GAMMA_T
K = 1e6  # N/m
K_T = 2.0 / 7.0 * K  # N/m
GAMMA = 300.0  # 1/s
GAMMA_T = GAMMA / 2.0  # 1/s
FRICTION = 0.5

# the lattice at the start: n^3 clumps at rest, turned at random; the box is as wide as the lattice
PITCH = 0.28  # m; a clump and its corners fit into a ball of 0.2732 m
FIRST = 0.18  # m, height of the lowest layer
FRAME = 0.02  # s between two values of the energy
LOOK = 5  # frames from one look at the heap to the next
LAST = 0.5  # s at the end of a run that are timed on their own: the heap is dense and hardly moves

# at rest: from the first frame on after which the kinetic energy never again exceeds this part of the
# energy that lifts every clump by its own edge of 4 R
AT_REST = 1e-6


def width(clumps):
    """Edge of the box (m) for so many clumps, a cube number."""
    return PITCH * round(clumps ** (1.0 / 3.0))


def rotations(q):
    """Rotation matrices of unit quaternions (w, x, y, z), one a row."""
    w, x, y, z = q.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def spheres(position, q):
    """Centres of all spheres (m), by clump, sphere, axis."""
    return position[:, None, :] + np.einsum("nij,kj->nki", rotations(q), CORNERS)


def look(centres):
    """The heap as it is: mean height of the clumps, contacts and overlaps.

    A contact is a pair of spheres of different clumps, or a sphere and a wall, that overlap.
    """
    flat = centres.reshape(-1, 3)
    pairs = cKDTree(flat).query_pairs(2.0 * R, output_type="ndarray")
    pairs = pairs[pairs[:, 0] // 8 != pairs[:, 1] // 8]
    overlap = 2.0 * R - np.linalg.norm(flat[pairs[:, 0]] - flat[pairs[:, 1]], axis=1)
    edge = width(len(centres))
    above = np.column_stack((flat, edge - flat[:, :2]))  # the distance from the floor and the four walls
    behind = R - above
    return {
        "mean height (m)": centres[:, :, 2].mean(),
        "highest sphere (m)": flat[:, 2].max() + R,
        "pairs in contact": int((overlap > 0.0).sum()),
        "wall contacts": int((behind > 0.0).sum()),
        "contacts a clump": 2.0 * (overlap > 0.0).sum() / len(centres),
        "wall contacts a clump": (behind > 0.0).sum() / len(centres),
        "deepest overlap (m)": overlap.max(initial=0.0),
        "deepest at a wall (m)": max(0.0, behind.max()),
        "spheres outside": int((above < 0.0).any(axis=1).sum()),
    }


def time_to_rest(energies, clumps):
    """When it came to rest (s), or None; `energies` (J) are those of the frames, the first at the start."""
    limit = AT_REST * clumps * MASS * GRAVITY * 4.0 * R
    # at the start nothing moves yet
    moving = [frame for frame, energy in enumerate(energies) if energy > limit]
    after = moving[-1] + 1 if moving else 0
    return after * FRAME if after < len(energies) else None


def result(engine, clumps, energies, seconds, looks):
    """What is known of one run. `seconds` are those of the whole run and of its last part, for each clock;
    the last of `looks` is the state at the end."""
    duration = (len(energies) - 1) * FRAME
    found = {"engine": engine, "clumps": clumps, "simulated (s)": duration}
    for clock, (whole, last) in seconds.items():
        found[f"{clock} seconds"] = whole
        found[f"body-steps a {clock} second"] = clumps * duration / DT / whole
        found[f"body-steps a {clock} second, last"] = clumps * LAST / DT / last
    deepest = max(max(at["deepest overlap (m)"], at["deepest at a wall (m)"]) for at in looks)
    found |= looks[-1] | {"deepest of all looks (m)": deepest}
    found["time to rest (s)"] = time_to_rest(energies, clumps)
    found["kinetic a clump at the end (J)"] = energies[-1] / clumps
    found["kinetic a clump (J)"] = [energy / clumps for energy in energies]
    return found
