"""What all engines share: the body, its start, the reference, and how a run is scored."""
import math

MOMENTS = (1.0, 2.0, 3.0)  # kg m^2; 1 kg
OMEGA = (0.01, 5.0, 0.01)  # rad/s
TIME = 20.0  # s
STEPS = (1e-3, 0.02, 0.1)  # s

# w, x, y, z after 20 s, printed by reference.py
REFERENCE = (
    -0.709562695226128508718648441383,
    -0.000671189134824091121868436563671,
    -0.704637374307752197465902093928,
    -0.00254985828121570024836252148386,
)


def times(a, b):
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
    """An angular velocity along the world's axes, along the body's."""
    return times(times(conjugate(q), (0.0, *omega)), q)[1:]


def energy_and_momentum(omega):
    """Rotational energy and |L| from the angular velocity along the body's axes."""
    energy = 0.5 * sum(i * w * w for i, w in zip(MOMENTS, omega))
    return energy, math.sqrt(sum((i * w) ** 2 for i, w in zip(MOMENTS, omega)))


def angle(q):
    """Angle to the reference (rad); q and -q are one orientation."""
    size = math.sqrt(sum(c * c for c in q))
    apart = min(math.dist([s * c / size for c in q], REFERENCE) for s in (1, -1))
    return 4.0 * math.asin(min(1.0, apart / 2.0))


def line(engine, integrator, dt, energy, momentum, error):
    """One row of the table: relative drifts of energy and |L| at the end, error (rad)."""
    drift = [f"{d:+.1e}" if d else "0" for d in (energy, momentum)]
    return f"| {engine} | {integrator} | {dt:g} | {drift[0]} | {drift[1]} | {error:.1e} |"


def row(engine, integrator, dt, q, omega_body):
    """Scores the state after 20 s and prints its row."""
    if not all(map(math.isfinite, (*q, *omega_body))):
        print(f"| {engine} | {integrator} | {dt:g} | blows up | blows up | – |", flush=True)
        return
    start, end = energy_and_momentum(OMEGA), energy_and_momentum(omega_body)
    drift = [b / a - 1.0 for a, b in zip(start, end)]
    print(line(engine, integrator, dt, *drift, angle(q)), flush=True)
