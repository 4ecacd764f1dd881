"""Definitions shared by all engines: the body, the initial state, the reference, and the errors of a run."""
import math

MOMENTS = (1.0, 2.0, 3.0)  # kg m^2; 1 kg
OMEGA = (0.01, 5.0, 0.01)  # rad/s
TIME = 20.0  # s
STEPS = (1e-3, 0.02, 0.1)  # s

# orientation (w, x, y, z) after 20 s, printed by reference.py
REFERENCE = (
    -0.709562695226128508718648441383,
    -0.000671189134824091121868436563671,
    -0.704637374307752197465902093928,
    -0.00254985828121570024836252148386,
)


def multiply(a, b):
    """Product of two quaternions (w, x, y, z)."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
    )


def conjugate(q):
    return (q[0], -q[1], -q[2], -q[3])


def to_body(q, omega):
    """Transforms an angular velocity from the world frame to the body frame."""
    return multiply(multiply(conjugate(q), (0.0, *omega)), q)[1:]


def energy_and_momentum(omega):
    """Rotational energy and |L| from the angular velocity in the body frame."""
    energy = 0.5 * sum(i * w * w for i, w in zip(MOMENTS, omega))
    return energy, math.sqrt(sum((i * w) ** 2 for i, w in zip(MOMENTS, omega)))


def orientation_error(q):
    """Angle between an orientation and the reference (rad). q and -q are the same orientation."""
    norm = math.sqrt(sum(c * c for c in q))
    distance = min(math.dist([s * c / norm for c in q], REFERENCE) for s in (1, -1))
    return 4.0 * math.asin(min(1.0, distance / 2.0))


def format_row(engine, integrator, dt, energy, momentum, error):
    """A row of the table, from the relative drifts of energy and |L| at the end and the orientation error (rad)."""
    drift = [f"{d:+.1e}" if d else "0" for d in (energy, momentum)]
    return f"| {engine} | {integrator} | {dt:g} | {drift[0]} | {drift[1]} | {error:.1e} |"


def print_row(engine, integrator, dt, q, omega_body):
    """Prints the row of a run from its state after 20 s."""
    if not all(map(math.isfinite, (*q, *omega_body))):
        print(f"| {engine} | {integrator} | {dt:g} | blows up | blows up | – |", flush=True)
        return
    start, end = energy_and_momentum(OMEGA), energy_and_momentum(omega_body)
    drift = [b / a - 1.0 for a, b in zip(start, end)]
    print(format_row(engine, integrator, dt, *drift, orientation_error(q)), flush=True)
