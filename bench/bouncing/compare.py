"""Times the engines in turns, checks their motions, and prints a table of each.

compare.py FOLDER ROUNDS [tumble=PATH] [mujoco=yes] [rapier=PATH]
FOLDER holds the output of body.py. An engine that is not named is left out.
"""
import statistics
import sys
from functools import partial

from scipy.spatial import ConvexHull

import motion
from common import FAILURES, attempt, print_table, three_digits
from with_rapier import Rapier
from with_tumble import Tumble

# dt (s), stiffness (N/m) and dashpot (N·s/m) per particle; with that dashpot a flat drop rebounds at about 0.7 of its speed
TUMBLE = (
    (1e-3, 8e3, 4.0),
    (2.5e-4, 4e4, 15.0),
)
# precision, shape, and simulated time (s), limited for the triangle mesh because its steps take tens of milliseconds
RAPIER = (
    ("f32", "hull", None),
    ("f64", "hull", None),
    ("f32", "parts", None),
    ("f32", "trimesh", 0.3),
)


def engine_factories(folder, tumble=None, rapier=None, mujoco=None):
    """Yields the name of an engine, and a function that creates it, for each row of the tables."""
    if tumble:
        for dt, k, c in TUMBLE:
            sets = [f"collision.collision_stiffness={k!r}", f"collision.collision_damping={c!r}"]
            settings = f"splitting; {k:g} N/m, {c:g} N·s/m per particle"
            yield "tumble", partial(Tumble, tumble, folder, dt, settings, sets)
    if mujoco:
        for settings in ({}, {"integrator": "implicitfast"}, {"hull": 64}):
            yield "MuJoCo", partial(mujoco_engine, folder, **settings)
    if rapier:
        for settings in RAPIER:
            yield "Rapier", partial(Rapier, rapier, folder, *settings)


def mujoco_engine(*arguments, **settings):
    """Creates a MuJoCo engine. The import is local because MuJoCo may be missing."""
    from with_mujoco import MuJoCo

    return MuJoCo(*arguments, **settings)


def median_times(engines, rounds):
    """Times the engines in turns; returns each engine that runs with the median seconds of its phases."""
    all_runs = [[] for _ in engines]
    for number in range(rounds):
        for engine, runs in zip(engines, all_runs):
            if number > 0 and (engine.until or not runs):
                continue
            name = f"{engine.engine}, {engine.settings}"
            print(f"round {number + 1}: {name}", file=sys.stderr)
            if seconds := attempt(name, engine.seconds):
                runs.append(seconds)
    return [
        (engine, [statistics.median(phase) for phase in zip(*runs)])
        for engine, runs in zip(engines, all_runs)
        if runs
    ]


def first_cells(engine):
    """The first cells of a row: engine, settings, dt."""
    return [engine.engine, engine.settings, f"{engine.dt:g}"]


def time_rows(medians):
    """Rows of times. The last column is relative to the first row."""
    ends = [0.0, *motion.PHASES.values()]
    first = sum(medians[0][1])
    for engine, seconds in medians:
        if engine.until:
            yield [*first_cells(engine), three_digits(1e6 * seconds[0] * engine.dt / engine.until), *["–"] * 5]
            continue
        whole = sum(seconds)
        steps = [(b - a) / engine.dt for a, b in zip(ends, ends[1:])]
        micros = [1e6 * s / n for s, n in zip([*seconds, whole], [*steps, sum(steps)])]
        per_second = three_digits(1e3 * whole / ends[-1])
        yield [*first_cells(engine), *map(three_digits, micros), per_second, f"{whole / first:.3g}"]


def motion_rows(engines, folder):
    """Rows of properties of the motion, from separate runs that are not timed."""
    body, moments = motion.points(folder), motion.setup(folder)["moments"]
    hull = body[ConvexHull(body).vertices]
    bouncing = slice(round(motion.PHASES["bouncing"] / motion.DT))
    rest = slice(round(motion.PHASES["settling"] / motion.DT), None, 10)
    start = motion.energies(motion.first_state(motion.BOUNCE), moments)[1][0]
    for engine in engines:
        if engine.until:
            continue
        print(f"motion: {engine.engine}, {engine.settings}", file=sys.stderr)
        name = f"motion of {engine.engine}"
        runs = attempt(name, lambda: (engine.states(drop=True)[0], engine.states()))
        if not runs:
            continue
        drop, (states, contacts) = runs
        kinetic, energy = motion.energies(states, moments)
        parts = (drop, states[bouncing], states[rest])
        depths, counts = zip(*(motion.wall_contacts(part, body, hull) for part in parts))
        # for an engine that does not report contacts, count the particles behind a wall
        most, mean = counts[1].max(), counts[2].mean()
        if contacts is not None:
            most, mean = contacts[bouncing].max(), contacts[rest].mean()
        yield [
            *first_cells(engine),
            f"{motion.rebound(drop):.2f}",
            *(f"{1e3 * part.max():.2g}" for part in depths),
            f"{most:.0f}, {mean:.3g}",
            f"{start:.0f}, {energy[bouncing][-1]:.0f}, {energy[-1]:.1f}",
            f"{kinetic[rest].max():.1g}",
        ]


def main():
    folder, rounds, *engine_options = sys.argv[1:]
    options = dict(option.split("=", 1) for option in engine_options)
    engines = [attempt(name, make) for name, make in engine_factories(folder, **options)]
    medians = median_times([engine for engine in engines if engine], int(rounds))
    common = ["engine", "settings", "dt (s)"]
    micros = [f"{name}, µs/step" for name in (*motion.PHASES, "whole run")]
    if medians:
        print_table([*common, *micros, "whole run, ms per simulated s", "relative to the first row"], time_rows(medians))
    properties = [
        "rebound, flat drop",
        "greatest depth: flat drop (mm)",
        "bouncing (mm)",
        "at rest (mm)",
        "contacts: maximum bouncing, mean at rest",
        "energy at 0, 2, 10 s (J)",
        "kinetic energy at rest (J)",
    ]
    print_table([*common, *properties], motion_rows([engine for engine, _ in medians], folder))
    for message in FAILURES:
        print("Failed:", message)


main()
