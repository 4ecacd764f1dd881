"""Writes the body into a folder: `body.obj`, its points and triangles, and `setup.txt`, the numbers
that engines need.

40,000 points of equal mass on a bumpy ellipsoid, about its centre of mass and along its principal axes.
"""
import pathlib
import sys

import numpy as np
from scipy.spatial import ConvexHull

from motion import BOX, DT, FRICTION, GRAVITY, MASS, RESTITUTION

POINTS = 40_000
AXES = (0.35, 0.25, 0.2)  # m
BUMP = 0.03  # of the radius
WAVES = 4.0 * np.pi  # radians of bump over one unit of direction: a bump at the end of each axis


def surface():
    """Points (m), and the corners of the triangles between them, counter-clockwise from outside."""
    # a Fibonacci sphere: equal areas, turned on by the golden angle
    n = np.arange(POINTS) + 0.5
    z = 1.0 - 2.0 * n / POINTS
    angle = np.pi * (3.0 - np.sqrt(5.0)) * n
    ring = np.sqrt(1.0 - z * z)
    u = np.column_stack((ring * np.cos(angle), ring * np.sin(angle), z))
    hull = ConvexHull(u)
    corners = hull.simplices.copy()
    a, b, c = (u[corners[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0.0
    corners[inward] = corners[inward][:, ::-1]
    radius = 1.0 / np.sqrt(((u / AXES) ** 2).sum(axis=1))
    return u * (radius * (1.0 + BUMP * np.cos(WAVES * u).prod(axis=1)))[:, None], corners


def principal(points):
    """The points about their mean and along their principal axes, and their moments (kg m^2)."""
    points = points - points.mean(axis=0)
    _, turn = np.linalg.eigh(-(points.T @ points))  # the longest axis first
    turn *= np.sign(turn.diagonal())
    points = points @ turn
    squares = MASS / len(points) * (points**2).sum(axis=0)
    return points, squares.sum() - squares


def main():
    folder = pathlib.Path(sys.argv[1])
    points, corners = surface()
    points, moments = principal(points)
    with folder.joinpath("body.obj").open("w") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (corners + 1).tolist())
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
