"""Times the engines in turns and prints two tables.

compare.py FOLDER ROUNDS tumble=PATH mujoco=yes rapier=PATH
FOLDER holds what body.py wrote; an engine that is not named is left out.
"""
import statistics
import sys
from functools import partial

from scipy.spatial import ConvexHull

import motion
from with_rapier import Rapier
from with_tumble import Tumble

# dt (s), and the contact of a particle that throws the body back at 0.7 with that step
TUMBLE = (
    (1e-3, 8e3, 4.0),
    (2.5e-4, 4e4, 15.0),
)
# precision, shape, and how far it is run (s); a step of the triangle mesh takes tens of milliseconds
RAPIER = (
    ("f32", "hull", None),
    ("f64", "hull", None),
    ("f32", "parts", None),
    ("f32", "trimesh", 0.3),
)


FAILED = []  # notes


def rows(folder, tumble=None, rapier=None, mujoco=None):
    """What makes one engine with one group of settings each, after a name for it."""
    if tumble:
        for dt, k, c in TUMBLE:
            sets = [f"collision.collision_stiffness={k!r}", f"collision.collision_damping={c!r}"]
            settings = f"splitting; {k:g} N/m, {c:g} N·s/m a particle"
            yield "tumble", partial(Tumble, tumble, folder, dt, settings, sets)
    if mujoco:
        for settings in ({}, {"integrator": "implicitfast"}, {"hull": 64}):
            yield "MuJoCo", partial(mujoco_engine, folder, **settings)
    if rapier:
        for settings in RAPIER:
            yield "Rapier", partial(Rapier, rapier, folder, *settings)


def mujoco_engine(*words, **settings):
    """MuJoCo is imported only where it is wanted."""
    from with_mujoco import MuJoCo

    return MuJoCo(*words, **settings)


def attempt(name, what):
    """The result of `what`; if it fails, None, and a note for the last lines."""
    try:
        return what()
    except Exception as error:  # whatever is wrong with one engine, the others are still compared
        said = getattr(error, "stderr", None) or str(error)
        if isinstance(said, bytes):
            said = said.decode(errors="replace")
        lines = [line for line in said.splitlines() if line.strip()] or [repr(error)]
        FAILED.append(f"{name}: {lines[0]}")
        return None


def timed(engines, rounds):
    """Each engine that runs, and the median seconds of its phases; all of them take turns."""
    found = [[] for _ in engines]
    for number in range(rounds):
        for engine, runs in zip(engines, found):
            if number > 0 and (engine.until or not runs):
                continue
            name = f"{engine.engine}, {engine.settings}"
            print(f"round {number + 1}: {name}", file=sys.stderr)
            if seconds := attempt(name, engine.seconds):
                runs.append(seconds)
    return [
        (engine, [statistics.median(phase) for phase in zip(*runs)])
        for engine, runs in zip(engines, found)
        if runs
    ]


def table(head, rows):
    """A Markdown table."""
    for words in (head, ["---"] * len(head), *rows):
        print("|", " | ".join(words), "|", flush=True)
    print()


def names(engine):
    """What a row begins with."""
    return [engine.engine, engine.settings, f"{engine.dt:g}"]


def figure(value):
    """Three digits, never as a power of ten."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def times(medians):
    """Rows of times. The last column compares with the first engine."""
    ends = [0.0, *motion.PHASES.values()]
    first = sum(medians[0][1])
    for engine, spent in medians:
        if engine.until:
            yield [*names(engine), figure(1e6 * spent[0] * engine.dt / engine.until), *["–"] * 5]
            continue
        whole = sum(spent)
        steps = [(b - a) / engine.dt for a, b in zip(ends, ends[1:])]
        micros = [1e6 * s / n for s, n in zip([*spent, whole], [*steps, sum(steps)])]
        per_second = figure(1e3 * whole / ends[-1])
        yield [*names(engine), *map(figure, micros), per_second, f"{whole / first:.3g}"]


def looks(engines, folder):
    """Rows of what the motions are like, from runs of their own."""
    body, moments = motion.points(folder), motion.setup(folder)["moments"]
    hull = body[ConvexHull(body).vertices]
    bouncing = slice(round(motion.PHASES["bouncing"] / motion.DT))
    rest = slice(round(motion.PHASES["settling"] / motion.DT), None, 10)
    start = motion.energies(motion.first_state(motion.BOUNCE), moments)[1][0]
    for engine in engines:
        if engine.until:
            continue
        print(f"look: {engine.engine}, {engine.settings}", file=sys.stderr)
        found = attempt(f"look at {engine.engine}", lambda: (engine.states(drop=True)[0], engine.states()))
        if not found:
            continue
        drop, (states, contacts) = found
        kinetic, energy = motion.energies(states, moments)
        parts = (drop, states[bouncing], states[rest])
        depth, points = zip(*(motion.behind(part, body, hull) for part in parts))
        # every particle behind a wall is a contact, unless the engine has its own
        most, mean = points[1].max(), points[2].mean()
        if contacts is not None:
            most, mean = contacts[bouncing].max(), contacts[rest].mean()
        yield [
            *names(engine),
            f"{motion.rebound(drop):.2f}",
            *(f"{1e3 * part.max():.2g}" for part in depth),
            f"{most:.0f}, {mean:.3g}",
            f"{start:.0f}, {energy[bouncing][-1]:.0f}, {energy[-1]:.1f}",
            f"{kinetic[rest].max():.1g}",
        ]


def main():
    folder, rounds, *programs = sys.argv[1:]
    chosen = dict(word.split("=", 1) for word in programs)
    engines = [attempt(name, make) for name, make in rows(folder, **chosen)]
    medians = timed([engine for engine in engines if engine], int(rounds))
    begin = ["engine", "settings", "dt (s)"]
    micros = [f"{name}, µs/step" for name in (*motion.PHASES, "whole")]
    if medians:
        table([*begin, *micros, "whole, ms per simulated s", "× the first row"], times(medians))
    looked = [
        "rebound, flat drop",
        "deepest: flat drop (mm)",
        "bouncing (mm)",
        "at rest (mm)",
        "contacts: most bouncing, mean at rest",
        "energy at 0, 2, 10 s (J)",
        "kinetic at rest (J)",
    ]
    table([*begin, *looked], looks([engine for engine, _ in medians], folder))
    for note in FAILED:
        print("Failed:", note)


main()
