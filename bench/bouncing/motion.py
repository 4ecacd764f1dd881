"""What all engines share: the box, the motion, its phases, and how a motion is looked at."""
import pathlib

import numpy as np

DT = 1e-3  # s
GRAVITY = 9.81  # m/s^2, along -z
BOX = 0.75  # m, half an edge of the closed box about the origin
MASS = 10.0  # kg
RESTITUTION = 0.7
FRICTION = 0.1

# where it starts: position (m), velocity (m/s), angular velocity (rad/s)
BOUNCE = ((0.0, 0.0, 0.2), (2.0, 1.0, 0.0), (3.0, 4.0, 2.0))
# flat onto the floor, for the restitution alone: no wall, no spin
DROP = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
DROP_TIME = 0.6  # s, up to the top of the first rebound or beyond

# the ends of the timed phases (s)
PHASES = {"bouncing": 2.0, "settling": 9.0, "at rest": 10.0}


def points(folder):
    """The points of the body (m)."""
    text = pathlib.Path(folder, "body.obj").read_text()
    return np.array([line.split()[1:] for line in text.splitlines() if line[0] == "v"], float)


def setup(folder):
    """Key to numbers, as body.py wrote them."""
    text = pathlib.Path(folder, "setup.txt").read_text()
    return {key: [float(v) for v in values] for key, *values in map(str.split, text.splitlines())}


def rotations(q):
    """Rotation matrices of quaternions (w, x, y, z), one a row."""
    w, x, y, z = (q / np.linalg.norm(q, axis=1)[:, None]).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def behind(states, body, hull):
    """For each state how deep the deepest point is behind a wall (m; 0 in flight), and how many are.

    The deepest is a corner of the hull, so the whole body is looked at in contact only.
    """
    deepest, count = np.zeros(len(states)), np.zeros(len(states), int)
    for at, (state, turn) in enumerate(zip(states, rotations(states[:, 3:7]))):
        deepest[at] = max(0.0, np.abs(hull @ turn.T + state[:3]).max() - BOX)
        if deepest[at] > 0.0:
            count[at] = (np.abs(body @ turn.T + state[:3]).max(axis=1) > BOX).sum()
    return deepest, count


def energies(states, moments):
    """Kinetic energy at each state, and with the height above the floor (J), from the velocities
    that the engine reports."""
    turn = rotations(states[:, 3:7])
    spin = np.einsum("nij,ni->nj", turn, states[:, 10:13])  # along the body's axes
    kinetic = 0.5 * MASS * (states[:, 7:10] ** 2).sum(axis=1) + 0.5 * (spin**2 @ moments)
    return kinetic, kinetic + MASS * GRAVITY * (states[:, 2] + BOX)


def first_state(motion):
    """A start as a state: position, orientation, velocity, angular velocity."""
    position, velocity, spin = motion
    return np.array([[*position, 1.0, 0.0, 0.0, 0.0, *velocity, *spin]])


def rebound(states):
    """Speed after the first bounce over the speed before it, along z."""
    vz = states[:, 9]
    down = vz.argmin()
    return vz[down:].max() / -vz[down]
