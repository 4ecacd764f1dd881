"""Times the engines in turns and prints two tables: compare.py FOLDER ROUNDS tumble=PATH mujoco=yes rapier=PATH

FOLDER holds what body.py wrote; an engine that is not named is left out.
"""
import statistics
import sys

import motion
from with_rapier import Rapier
from with_tumble import Tumble

# dt (s), and the contact of a particle that throws the body back at 0.7 with that step
TUMBLE = (
    (1e-3, 8e3, 4.0),
    (2.5e-4, 4e4, 15.0),
)
RAPIER = (("f32", "trimesh"), ("f32", "hull"), ("f64", "trimesh"), ("f64", "hull"))


def rows(folder, tumble=None, rapier=None, mujoco=None):
    """One engine with one group of settings each."""
    if tumble:
        for dt, k, c in TUMBLE:
            sets = [f"collision.collision_stiffness={k!r}", f"collision.collision_damping={c!r}"]
            yield Tumble(tumble, folder, dt, f"splitting; {k:g} N/m, {c:g} N·s/m a particle", sets)
    if mujoco:
        from with_mujoco import MuJoCo

        yield MuJoCo(folder)
        yield MuJoCo(folder, integrator="implicitfast")
        yield MuJoCo(folder, hull=64)
    if rapier:
        for precision, shape in RAPIER:
            yield Rapier(rapier, folder, precision, shape)


def timed(engines, rounds):
    """Median seconds of each phase for each engine; all of them take turns."""
    found = [[] for _ in engines]
    for number in range(rounds):
        for engine, runs in zip(engines, found):
            print(f"round {number + 1}: {engine.engine}, {engine.settings}", file=sys.stderr)
            runs.append(engine.seconds())
    return [[statistics.median(phase) for phase in zip(*runs)] for runs in found]


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


def times(engines, medians):
    """Rows of times. The last column compares with the first engine."""
    whole = [sum(spent) for spent in medians]
    for engine, spent, total in zip(engines, medians, whole):
        ends = [0.0, *motion.PHASES.values()]
        steps = [(b - a) / engine.dt for a, b in zip(ends, ends[1:])]
        micros = [1e6 * s / n for s, n in zip([*spent, total], [*steps, sum(steps)])]
        yield [
            *names(engine),
            *map(figure, micros),
            figure(1e3 * total / ends[-1]),
            f"{total / whole[0]:.3g}",
        ]


def looks(engines, folder):
    """Rows of what the motions are like, from runs of their own."""
    body, moments = motion.points(folder), motion.setup(folder)["moments"]
    bouncing = slice(round(motion.PHASES["bouncing"] / motion.DT))
    rest = slice(round(motion.PHASES["settling"] / motion.DT), None, 10)
    start = motion.energies(motion.first_state(motion.BOUNCE), moments)[1][0]
    for engine in engines:
        print(f"look: {engine.engine}, {engine.settings}", file=sys.stderr)
        drop, _ = engine.states(drop=True)
        states, contacts = engine.states()
        kinetic, energy = motion.energies(states, moments)
        depth, points = zip(*(motion.behind(part, body) for part in (drop, states[bouncing], states[rest])))
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
    engines = list(rows(folder, **dict(word.split("=", 1) for word in programs)))
    begin = ["engine", "settings", "dt (s)"]
    micros = [f"{name}, µs/step" for name in (*motion.PHASES, "whole")]
    medians = timed(engines, int(rounds))
    table([*begin, *micros, "whole, ms per simulated s", "× the first row"], times(engines, medians))
    table(
        [
            *begin,
            "rebound, flat drop",
            "deepest: flat drop (mm)",
            "bouncing (mm)",
            "at rest (mm)",
            "contacts: most bouncing, mean at rest",
            "energy at 0, 2, 10 s (J)",
            "kinetic at rest (J)",
        ],
        looks(engines, folder),
    )


main()
