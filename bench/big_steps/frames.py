"""From the states of an engine in each frame to the result of a run, as heap.py computes it.

A frame is longer than in bench/heap, so that steps of 1/60 s and of 0.001 s both end with it.
"""
import numpy as np

import heap

FRAME = 0.1  # s
INERTIA = 2.4 * heap.MASS * heap.R**2  # kg m^2, about every axis


def steps_per_frame(dt):
    """The number of steps in a frame."""
    steps = round(FRAME / dt)
    if abs(steps * dt - FRAME) > 1e-9:
        raise SystemExit(f"dt = {dt} s does not divide {FRAME} s")
    return steps


def kinetic(states):
    """Kinetic energy (J) of all clumps in each frame; the last six columns are velocity and angular velocity."""
    squares = np.square(states[:, :, 7:])
    return 0.5 * (heap.MASS * squares[:, :, :3] + INERTIA * squares[:, :, 3:]).sum(axis=(1, 2))


def result_of(engine, start, states, times):
    """The result of a run. `states` has the position, orientation (w, x, y, z) and velocities of each clump in each
    frame, `times` the wall-clock time of the steps up to each frame (s)."""
    if not np.isfinite(states).all():
        raise SystemExit("the state is not finite")
    centres = [heap.spheres(state[:, :3], state[:, 3:7]) for state in states]
    difference = np.abs(centres[0] - heap.spheres(*start)).max()
    if difference > 1e-12:
        raise SystemExit(f"the first frame and start.csv differ by {difference} m")
    last = round(heap.LAST / FRAME)
    if len(times) <= last:
        raise SystemExit(f"the simulated time must be longer than {heap.LAST} s")
    seconds = {"wall": (times[-1], times[-1] - times[-1 - last])}
    samples = [heap.heap_statistics(frame) for frame in centres]
    return heap.summarise(engine, len(states[0]), kinetic(states).tolist(), seconds, samples, FRAME)
