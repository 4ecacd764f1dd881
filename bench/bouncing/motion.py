"""Definitions shared by all engines: the box, the initial states, the phases, and the analysis of a motion."""
import pathlib

import numpy as np

from common import rotations

DT = 1e-3  # s
GRAVITY = 9.81  # m/s^2, along -z
BOX = 0.75  # m, half an edge of the closed box about the origin
MASS = 10.0  # kg
RESTITUTION = 0.7
FRICTION = 0.1

# initial state: position (m), velocity (m/s), angular velocity (rad/s)
BOUNCE = ((0.0, 0.0, 0.2), (2.0, 1.0, 0.0), (3.0, 4.0, 2.0))
# a flat drop onto the floor without spin, to measure the restitution
DROP = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
DROP_TIME = 0.6  # s, at least until the top of the first rebound

# end of each timed phase (s)
PHASES = {"bouncing": 2.0, "settling": 9.0, "at rest": 10.0}


def points(folder):
    """The points of the body (m)."""
    text = pathlib.Path(folder, "body.obj").read_text()
    return np.array([line.split()[1:] for line in text.splitlines() if line[0] == "v"], float)


def setup(folder):
    """The values of setup.txt, a list of numbers for each key."""
    text = pathlib.Path(folder, "setup.txt").read_text()
    return {key: [float(v) for v in values] for key, *values in map(str.split, text.splitlines())}


def wall_contacts(states, body, hull):
    """Greatest depth behind a wall (m; 0 in flight) and number of points behind a wall, for each state.

    The deepest point is a vertex of the hull, so all points are transformed only for states in contact.
    """
    deepest, count = np.zeros(len(states)), np.zeros(len(states), int)
    for i, (state, rotation) in enumerate(zip(states, rotations(states[:, 3:7]))):
        deepest[i] = max(0.0, np.abs(hull @ rotation.T + state[:3]).max() - BOX)
        if deepest[i] > 0.0:
            count[i] = (np.abs(body @ rotation.T + state[:3]).max(axis=1) > BOX).sum()
    return deepest, count


def energies(states, moments):
    """Kinetic energy and mechanical energy (J) of each state, from the velocities that the engine reports.

    The potential energy is zero at the floor.
    """
    rotation = rotations(states[:, 3:7])
    spin = np.einsum("nij,ni->nj", rotation, states[:, 10:13])  # in the body frame
    kinetic = 0.5 * MASS * (states[:, 7:10] ** 2).sum(axis=1) + 0.5 * (spin**2 @ moments)
    return kinetic, kinetic + MASS * GRAVITY * (states[:, 2] + BOX)


def first_state(motion):
    """The initial state as a row: position, orientation, velocity, angular velocity."""
    position, velocity, spin = motion
    return np.array([[*position, 1.0, 0.0, 0.0, 0.0, *velocity, *spin]])


def rebound(states):
    """Ratio of the vertical speeds after and before the first bounce."""
    vz = states[:, 9]
    impact = vz.argmin()
    return vz[impact:].max() / -vz[impact]
