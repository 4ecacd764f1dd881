"""Definitions shared by all engines: the clump, the start, the box, the contact law and the statistics of a heap.

SI units; z points up.
"""
import numpy as np
from scipy.spatial import cKDTree

# the clump: eight spheres on the corners of a cube, each touching three others
R = 0.05  # m, radius of a sphere
CORNERS = R * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
SPHERE_MASS = 1000.0 * 4.0 / 3.0 * np.pi * R**3  # kg, at 1000 kg/m^3
MASS = 8 * SPHERE_MASS  # 4.18879 kg

GRAVITY = 9.81  # m/s^2, along -z
DT = 1e-4  # s

# contact of two spheres, or of a sphere and a wall: overlap d, stretch s of the friction spring, velocities v_n and v_t
#   F_n = max(0, K d - m g v_n), F_t = -(K_T s + m g_t v_t), |F_t| <= FRICTION F_n
# where m is MASS / 2 between clumps and MASS at a wall, g GAMMA and g_t GAMMA_T
K = 1e6  # N/m
K_T = 2.0 / 7.0 * K  # N/m
GAMMA = 300.0  # 1/s
GAMMA_T = GAMMA / 2.0  # 1/s
FRICTION = 0.5

# initial lattice: n^3 clumps at rest with random orientations; the box is as wide as the lattice
PITCH = 0.28  # m; the bounding sphere of a clump has a diameter of 0.2732 m
FIRST = 0.18  # m, height of the lowest layer
FRAME = 0.02  # s, interval of the energy samples
FRAMES_PER_SAMPLE = 5  # frames between two samples of the heap's statistics
LAST = 0.5  # s at the end of a run that are timed separately, when the heap is dense and nearly at rest

# a heap is at rest once the kinetic energy stays below this fraction of the energy that
# lifts every clump by its own edge of 4 R
AT_REST = 1e-6


def width(clumps):
    """Width of the box (m) for a number of clumps, which is a cube number."""
    return PITCH * round(clumps ** (1.0 / 3.0))


def rotations(q):
    """Rotation matrices of unit quaternions (w, x, y, z), one per row."""
    w, x, y, z = q.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def spheres(position, q):
    """Centres of all spheres (m), indexed by clump, sphere and axis."""
    return position[:, None, :] + np.einsum("nij,kj->nki", rotations(q), CORNERS)


def heap_statistics(centres):
    """Heights, contacts and overlaps of a heap, from the centres of its spheres.

    A contact is an overlap of two spheres of different clumps, or of a sphere and a wall.
    """
    flat = centres.reshape(-1, 3)
    pairs = cKDTree(flat).query_pairs(2.0 * R, output_type="ndarray")
    pairs = pairs[pairs[:, 0] // 8 != pairs[:, 1] // 8]
    overlap = 2.0 * R - np.linalg.norm(flat[pairs[:, 0]] - flat[pairs[:, 1]], axis=1)
    edge = width(len(centres))
    distance = np.column_stack((flat, edge - flat[:, :2]))  # from the floor and the four walls
    depth = R - distance
    return {
        "mean height (m)": centres[:, :, 2].mean(),
        "highest sphere (m)": flat[:, 2].max() + R,
        "pairs in contact": int((overlap > 0.0).sum()),
        "wall contacts": int((depth > 0.0).sum()),
        "contacts per clump": 2.0 * (overlap > 0.0).sum() / len(centres),
        "wall contacts per clump": (depth > 0.0).sum() / len(centres),
        "mean overlap (m)": mean_overlap(np.concatenate((overlap, depth.ravel()))),
        "deepest overlap of clumps (m)": overlap.max(initial=0.0),
        "deepest overlap with a wall (m)": max(0.0, depth.max()),
        "spheres outside": int((distance < 0.0).any(axis=1).sum()),
    }


def mean_overlap(overlaps):
    """Mean of the positive overlaps (m), 0 without any."""
    positive = overlaps[overlaps > 0.0]
    return positive.mean() if len(positive) else 0.0


def time_to_rest(energies, clumps, frame_time=FRAME):
    """Time at which the heap comes to rest (s), or None. `energies` (J) has one value per frame, from the start on."""
    limit = AT_REST * clumps * MASS * GRAVITY * 4.0 * R
    # the clumps start at rest, so earlier frames below the limit do not count
    moving = [frame for frame, energy in enumerate(energies) if energy > limit]
    after = moving[-1] + 1 if moving else 0
    return after * frame_time if after < len(energies) else None


def summarise(engine, clumps, energies, seconds, samples, frame_time=FRAME):
    """The result of a run, a dictionary. `seconds` has the times of the whole run and of its last part for each clock;
    the last of `samples`, which are heap statistics, is taken at the end."""
    duration = (len(energies) - 1) * frame_time
    result = {"engine": engine, "clumps": clumps, "simulated (s)": duration}
    for clock, (whole, last) in seconds.items():
        result[f"{clock} seconds"] = whole
        result[f"{clock} seconds, last"] = last
        result[f"body-steps per {clock} second"] = clumps * duration / DT / whole
        result[f"body-steps per {clock} second, last"] = clumps * LAST / DT / last
    deepest = max(max(sample["deepest overlap of clumps (m)"], sample["deepest overlap with a wall (m)"]) for sample in samples)
    result |= samples[-1] | {"deepest overlap of all samples (m)": deepest}
    result["time to rest (s)"] = time_to_rest(energies, clumps, frame_time)
    result["kinetic energy per clump at the end (J)"] = energies[-1] / clumps
    result["kinetic energy per clump (J)"] = [energy / clumps for energy in energies]
    return result
