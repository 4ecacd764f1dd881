"""Prints settings of tumble, KEY=VALUE, one per line, for springs that are stiffer by a factor, with the same restitution.

stiffer.py FACTOR
"""
import sys

import heap


def main():
    factor = float(sys.argv[1])
    root = factor**0.5
    for key, value in {
        "collision.collision_stiffness": factor * heap.K,
        "collision.friction_spring": factor * heap.K_T,
        "collision.collision_damping": root * heap.MASS / 2.0 * heap.GAMMA,
        "collision.friction_damping": root * heap.MASS / 2.0 * heap.GAMMA_T,
        "box.collision_damping": root * heap.MASS * heap.GAMMA,
        "box.friction_damping": root * heap.MASS * heap.GAMMA_T,
    }.items():
        print(f"{key}={value!r}")


main()
