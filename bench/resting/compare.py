"""Runs every scene in all engines and prints a table for each scene.

compare.py [tumble=PATH] [mujoco=yes] [rapier=PATH]
An engine that is not named is left out.
"""
import sys
from functools import partial

import numpy as np

from common import FAILURES, attempt, print_table, processor_time, three_digits
from scenes import DURATION, SCENES, measures
from with_rapier import Rapier
from with_tumble import Tumble

HEADINGS = [
    "engine",
    "shape",
    "dt (s)",
    "depth (mm)",
    "sink (mm)",
    "drift (mm)",
    "rotation (°)",
    "creep (mm)",
    "kinetic energy (J)",
    "ms per simulated s",
    "ms of processor time per simulated s",
]


def engine_factories(tumble=None, rapier=None, mujoco=None):
    """Yields the name of an engine, and a function that creates it, for each row of a table."""
    if tumble:
        yield "tumble", partial(Tumble, tumble)
    if mujoco:
        yield "MuJoCo", mujoco_engine
    if rapier:
        for shape in ("cuboid", "hull", "trimesh"):
            yield "Rapier", partial(Rapier, rapier, shape)


def mujoco_engine():
    """Creates the MuJoCo engine. The import is local because MuJoCo may be missing."""
    from with_mujoco import MuJoCo

    return MuJoCo()


def row(engine, boxes):
    """The cells of a run."""
    start = processor_time()
    frames, seconds = engine.run(boxes)
    processor = processor_time() - start
    m = measures(boxes, frames)
    return [
        engine.engine,
        engine.settings,
        f"{engine.dt:.3g}",
        f"{1e3 * m['depth']:.2g}",
        f"{1e3 * m['sink']:.2g}",
        f"{1e3 * m['drift']:.1g}",
        f"{np.degrees(m['rotation']):.1g}",
        f"{1e3 * m['creep']:.1g}",
        f"{m['kinetic']:.1g}",
        three_digits(1e3 * seconds / DURATION),
        three_digits(1e3 * processor / DURATION),
    ]


def rows(engines, scene, boxes):
    """The rows of a scene."""
    for engine in engines:
        name = f"{engine.engine}, {engine.settings}"
        print(f"{scene}: {name}", file=sys.stderr)
        if cells := attempt(f"{scene}: {name}", partial(row, engine, boxes)):
            yield cells


def main():
    options = dict(option.split("=", 1) for option in sys.argv[1:])
    made = [attempt(name, make) for name, make in engine_factories(**options)]
    engines = [engine for engine in made if engine]
    for scene, boxes in SCENES.items():
        print(f"**{scene[0].upper()}{scene[1:]}**\n")
        print_table(HEADINGS, rows(engines, scene, boxes))
    for message in FAILURES:
        print("Failed:", message)


main()
