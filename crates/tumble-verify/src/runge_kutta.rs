//! The classical Runge–Kutta method.

/// Advances `y` from the time `from` to `until` (s) in `steps` steps; `project` puts each new state back onto its constraints.
pub(crate) fn integrate<const N: usize>(
    y: &mut [f64; N],
    (from, until): (f64, f64),
    steps: usize,
    rate: impl Fn(f64, &[f64; N]) -> [f64; N],
    project: impl Fn(&mut [f64; N]),
) {
    let h = (until - from) / steps as f64;
    let moved = |y: &[f64; N], k: &[f64; N], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    for step in 0..steps {
        let t = from + step as f64 * h;
        let a = rate(t, y);
        let b = rate(t + 0.5 * h, &moved(y, &a, 0.5 * h));
        let c = rate(t + 0.5 * h, &moved(y, &b, 0.5 * h));
        let d = rate(t + h, &moved(y, &c, h));
        for i in 0..N {
            y[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
        }
        project(y);
    }
}
