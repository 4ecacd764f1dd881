"""Writes the body into a folder: `body.obj`, its points and triangles, and `setup.txt`, the parameters of the scene.

The body has 40,000 points of equal mass on a bumpy ellipsoid, relative to the centre of mass and in principal axes.
"""
import pathlib
import sys

import numpy as np
from scipy.spatial import ConvexHull

from motion import BOX, DT, FRICTION, GRAVITY, MASS, RESTITUTION

POINTS = 40_000
AXES = (0.35, 0.25, 0.2)  # m
BUMP_HEIGHT = 0.03  # relative to the radius
WAVE_NUMBER = 4.0 * np.pi  # of the bumps in the unit direction; a bump lies at the end of each axis


def surface():
    """Points (m) and triangles between them, counter-clockwise as seen from outside."""
    # Fibonacci sphere: equal areas, successive points rotated by the golden angle
    n = np.arange(POINTS) + 0.5
    z = 1.0 - 2.0 * n / POINTS
    angle = np.pi * (3.0 - np.sqrt(5.0)) * n
    ring = np.sqrt(1.0 - z * z)
    u = np.column_stack((ring * np.cos(angle), ring * np.sin(angle), z))
    hull = ConvexHull(u)
    triangles = hull.simplices.copy()
    a, b, c = (u[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    radius = 1.0 / np.sqrt(((u / AXES) ** 2).sum(axis=1))
    return u * (radius * (1.0 + BUMP_HEIGHT * np.cos(WAVE_NUMBER * u).prod(axis=1)))[:, None], triangles


def to_principal_axes(points):
    """The points relative to their mean and in principal axes, and the principal moments (kg m^2)."""
    points = points - points.mean(axis=0)
    _, axes = np.linalg.eigh(-(points.T @ points))  # the longest axis first
    axes *= np.sign(axes.diagonal())
    points = points @ axes
    squares = MASS / len(points) * (points**2).sum(axis=0)
    return points, squares.sum() - squares


def main():
    folder = pathlib.Path(sys.argv[1])
    points, triangles = surface()
    points, moments = to_principal_axes(points)
    with folder.joinpath("body.obj").open("w") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist())
    setup = {
        "dt": [DT],
        "gravity": [GRAVITY],
        "box": [BOX],
        "mass": [MASS],
        "moments": moments.tolist(),
        "restitution": [RESTITUTION],
        "friction": [FRICTION],
    }
    lines = (f"{key} {' '.join(map(repr, values))}\n" for key, values in setup.items())
    folder.joinpath("setup.txt").write_text("".join(lines))


main()
