"""Prints the orientation (w, x, y, z) of the tumbling body after 20 s, to 30 digits.

Euler's equations and q' = q (0, w)/2, both polynomial of degree two, are integrated by Taylor series
of order 40 with 40 digits, in steps of 0.05 s. Takes under a minute.
"""
from mpmath import mp, mpf

mp.dps = 40
ORDER, STEP, STEPS = 40, mpf(1) / 20, 400
MOMENTS = [mpf(1), mpf(2), mpf(3)]


def product(a, b, n):
    """Coefficient n of the product of two power series."""
    return mp.fsum(a[k] * b[n - k] for k in range(n + 1))


def step(omega, q):
    i1, i2, i3 = MOMENTS
    w = [[c] for c in omega]
    p = [[c] for c in q]
    for n in range(ORDER):
        rates = [
            (i2 - i3) / i1 * product(w[1], w[2], n),
            (i3 - i1) / i2 * product(w[2], w[0], n),
            (i1 - i2) / i3 * product(w[0], w[1], n),
        ]
        # q' = q (0, omega)/2, with omega in the body frame
        turns = [
            [(-1, 1, 0), (-1, 2, 1), (-1, 3, 2)],
            [(1, 0, 0), (1, 2, 2), (-1, 3, 1)],
            [(1, 0, 1), (1, 3, 0), (-1, 1, 2)],
            [(1, 0, 2), (1, 1, 1), (-1, 2, 0)],
        ]
        spins = [sum(s * product(p[a], w[b], n) for s, a, b in row) / 2 for row in turns]
        for series, rate in zip(w + p, rates + spins):
            series.append(rate / (n + 1))
    end = [mp.polyval(series[::-1], STEP) for series in w + p]
    return end[:3], end[3:]


# the double closest to 0.01, as in the engines
omega, q = [mpf(0.01), mpf(5), mpf(0.01)], [mpf(1), mpf(0), mpf(0), mpf(0)]
for _ in range(STEPS):
    omega, q = step(omega, q)
print(*(mp.nstr(c, 30) for c in q), sep="\n")
