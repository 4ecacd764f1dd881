"""Definitions shared by all engines: the scenes, and the measures computed from the poses."""
import itertools
from dataclasses import dataclass

import numpy as np

from common import rotations

GRAVITY = 9.81  # m/s^2, along -y
FRICTION = 0.5
MASS = 1.0  # kg, of every body
DURATION = 60.0  # s
INTERVAL = 0.1  # s, between recorded frames
SETTLED = 1.0  # s, time from which the motion is measured; also the length of the window for the kinetic energy


@dataclass(frozen=True)
class Box:
    """A box with 12 triangles: its edges (m), position of the centre (m), and rotation about y (degrees)."""

    size: tuple
    position: tuple
    yaw: float = 0.0

    @property
    def orientation(self):
        """Quaternion (w, x, y, z)."""
        half = np.radians(self.yaw) / 2.0
        return (float(np.cos(half)), 0.0, float(np.sin(half)), 0.0)

    @property
    def moments(self):
        """Moments of inertia of the solid box about its axes (kg m^2)."""
        squares = MASS / 12.0 * np.square(self.size)
        return squares.sum() - squares

    @property
    def corners(self):
        """The eight vertices in the body frame (m)."""
        return np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * self.size


SLAB = (0.4, 0.2, 0.4)
CUBE = (0.2, 0.2, 0.2)
UPRIGHT = (0.02, 0.2, 0.2)
ROOF = (0.3, 0.02, 0.2)

# the bodies of each scene, on the plane y = 0; the last body is the topmost
SCENES = {
    "two boxes, flush": [Box(SLAB, (0.0, 0.1, 0.0)), Box(SLAB, (0.0, 0.3, 0.0))],
    "two boxes, turned by 45°": [Box(SLAB, (0.0, 0.1, 0.0)), Box(SLAB, (0.0, 0.3, 0.0), 45.0)],
    "stack of ten cubes": [Box(CUBE, (0.0, 0.1 + 0.2 * n, 0.0)) for n in range(10)],
    "crossed sticks": [Box((0.6, 0.04, 0.04), (0.0, 0.02, 0.0)), Box((0.04, 0.04, 0.6), (0.0, 0.06, 0.0))],
    "bridge": [Box(CUBE, (-0.2, 0.1, 0.0)), Box(CUBE, (0.2, 0.1, 0.0)), Box((0.4, 0.02, 0.4), (0.0, 0.21, 0.0))],
    "card house": [
        Box(UPRIGHT, (-0.11, 0.1, 0.0)),
        Box(UPRIGHT, (0.11, 0.1, 0.0)),
        Box(ROOF, (0.0, 0.21, 0.0)),
        Box(ROOF, (0.0, 0.23, 0.0)),
    ],
}


def depth(boxes, pose):
    """Greatest penetration depth (m) of two bodies or of a body and the plane; negative if nothing touches.

    Two boxes are separated by the smallest translation along a face normal of either or a cross product of edges.
    """
    axes = rotations(pose[:, 3:7])
    points = [box.corners @ a.T + x for box, a, x in zip(boxes, axes, pose[:, :3])]
    depths = [-p[:, 1].min() for p in points]
    for (a, p), (b, q) in itertools.combinations(zip(axes, points), 2):
        crosses = [np.cross(u, v) for u in a.T for v in b.T]
        normals = [*a.T, *b.T, *(n / np.linalg.norm(n) for n in crosses if np.linalg.norm(n) > 1e-6)]
        projections = [(p @ n, q @ n) for n in normals]
        depths.append(min(min(s.max() - t.min(), t.max() - s.min()) for s, t in projections))
    return max(depths)


def measures(boxes, frames):
    """Figures of a run in SI units, angles in rad. `frames` has the state of each body at 0, INTERVAL, …: position,
    orientation (w, x, y, z), velocity and angular velocity in world axes."""
    first = np.array([[*box.position, *box.orientation] for box in boxes])
    if not np.allclose(frames[0, :, :7], first, rtol=0.0, atol=1e-6):
        raise ValueError("the run does not start from the initial poses")
    if not np.isfinite(frames).all():
        raise ValueError("the state is not finite")
    settled = frames[round(SETTLED / INTERVAL) :]
    moved = settled[:, :, :3] - first[:, :3]
    axes, start = rotations(settled[:, :, 3:7]), rotations(first[:, 3:7])
    # angle from the vector part of R - R^T and the trace of the relative rotation R, accurate for small angles
    turn = axes @ np.swapaxes(start, -1, -2)
    sine = 0.5 * np.linalg.norm((turn - np.swapaxes(turn, -1, -2)), axis=(-2, -1)) / np.sqrt(2.0)
    angle = np.arctan2(sine, 0.5 * (np.trace(turn, axis1=-2, axis2=-1) - 1.0))
    last = settled[-round(SETTLED / INTERVAL) :]
    spin = np.einsum("tnij,tni->tnj", rotations(last[:, :, 3:7]), last[:, :, 10:13])  # in the body frame
    moments = np.array([box.moments for box in boxes])
    kinetic = 0.5 * (MASS * (last[:, :, 7:10] ** 2).sum(axis=-1) + (moments * spin**2).sum(axis=-1)).sum(axis=-1)
    return {
        "depth": depth(boxes, frames[-1, :, :7]),
        "sink": -moved[-1, -1, 1],
        "drift": np.hypot(moved[:, :, 0], moved[:, :, 2]).max(),
        "rotation": angle.max(),
        "creep": np.linalg.norm(settled[-1, :, :3] - settled[0, :, :3], axis=-1).max(),
        "kinetic": kinetic.max(),
    }
