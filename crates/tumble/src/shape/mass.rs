//! Mass properties (line 1 of the basic system) and principal axes.

use glam::{DMat3, DVec3};

/// Mass, centre of mass and inertia tensor of a set of particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass M (kg).
    pub mass: f64,
    /// Centre of mass x, in the frame of the input (m).
    pub centre: DVec3,
    /// Inertia tensor I₀ about the centre of mass, in the axes of the input (kg·m²).
    pub inertia: DMat3,
}

impl MassProperties {
    /// Line 1: M = Σ mᵢ, x = Σ mᵢ xᵢ / M, I₀ = Σ mᵢ (rᵢ·rᵢ 1 − rᵢ rᵢᵀ).
    ///
    /// The particles have equal masses `particle_mass` (kg) at `positions` (m). Without particles all
    /// results are zero.
    pub fn from_particles(positions: &[DVec3], particle_mass: f64) -> Self {
        let count = positions.len().max(1) as f64;
        // an estimate of the centre and its correction keep the sums accurate far from the origin
        let estimate = positions.iter().copied().sum::<DVec3>() / count;
        let centre = estimate + positions.iter().map(|&p| p - estimate).sum::<DVec3>() / count;
        let second =
            positions.iter().fold(DMat3::ZERO, |sum, &p| sum + outer(p - centre, p - centre));
        Self {
            mass: particle_mass * positions.len() as f64,
            centre,
            inertia: inertia_from_second_moment(second) * particle_mass,
        }
    }
}

/// a bᵀ.
pub(crate) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// ∫ (r·r 1 − r rᵀ) from ∫ r rᵀ.
pub(crate) fn inertia_from_second_moment(second: DMat3) -> DMat3 {
    let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
    DMat3::from_diagonal(DVec3::splat(trace)) - second
}

/// Moments that are negative by more than this fraction of the largest are no rounding errors.
const IMPOSSIBLE: f64 = 1e-6;

/// Whether ∫ r rᵀ is that of some body: it has no negative eigenvalue, up to rounding.
pub(crate) fn is_possible_second_moment(second: DMat3) -> bool {
    let (values, _) = diagonalise(second.to_cols_array_2d());
    let largest = values.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    values.iter().all(|&x| x >= -IMPOSSIBLE * largest)
}

/// Whether an inertia tensor is that of some body: no moment is negative, and none is larger than the sum of the others, up to
/// rounding.
pub(crate) fn is_possible_inertia(inertia: DMat3) -> bool {
    let trace = inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z;
    is_possible_second_moment(DMat3::from_diagonal(DVec3::splat(0.5 * trace)) - inertia)
}

/// The principal moments and axes of an inertia tensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes {
    /// Principal moments in ascending order. A moment that is zero up to rounding is exactly 0.
    pub moments: DVec3,
    /// The axes as columns, right-handed: I₀ = A diag(moments) Aᵀ.
    pub axes: DMat3,
}

impl PrincipalAxes {
    /// Diagonalises a symmetric tensor by cyclic Jacobi rotations (Golub & Van Loan, *Matrix
    /// Computations*, 8.5), which keep small eigenvalues accurate relative to the largest.
    ///
    /// Moments below `1e-12` of the largest, or below `floor`, become exactly zero. `floor` has the unit
    /// of the tensor and is the inertia that rounding of the particles' coordinates can produce. Particles
    /// on a line therefore have exactly no inertia about it, and no torque can spin them up.
    pub fn new(tensor: DMat3, floor: f64) -> Self {
        let (values, vectors) = diagonalise(tensor.to_cols_array_2d());
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let threshold = (RELATIVE_ZERO * values[order[2]]).max(floor);
        let moments = order.map(|i| if values[i] > threshold { values[i] } else { 0.0 });
        let mut axes = DMat3::from_cols_array_2d(&order.map(|i| vectors[i]));
        if axes.determinant() < 0.0 {
            axes.z_axis = -axes.z_axis;
        }
        Self { moments: DVec3::from_array(moments), axes }
    }

    /// The pseudo-inverse of the tensor: zero along axes without inertia.
    pub fn inverse(&self) -> DMat3 {
        let inverse = self.moments.to_array().map(|m| if m > 0.0 { 1.0 / m } else { 0.0 });
        self.axes * DMat3::from_diagonal(DVec3::from_array(inverse)) * self.axes.transpose()
    }

    /// The number of rotational degrees of freedom: 3, 2 for particles on a line, 0 for a point.
    pub fn rotation_count(&self) -> usize {
        self.moments.to_array().iter().filter(|&&m| m > 0.0).count()
    }
}

/// A principal moment below this fraction of the largest counts as zero.
const RELATIVE_ZERO: f64 = 1e-12;

/// Eigenvalues and eigenvectors (one per row) of a symmetric matrix, by cyclic Jacobi rotations.
pub(crate) fn diagonalise<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    let mut v = [[0.0; N]; N];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    // convergence is quadratic, so a few sweeps suffice; the limit is for NaN
    for _sweep in 0..16 {
        let mut done = true;
        for p in 0..N {
            for q in p + 1..N {
                done &= a[p][q] == 0.0;
                rotate(&mut a, &mut v, p, q);
            }
        }
        if done {
            break;
        }
    }
    (std::array::from_fn(|i| a[i][i]), v)
}

/// The Jacobi rotation in the plane (p, q) that makes `a[p][q]` zero; the rows of `v` are the vectors.
fn rotate<const N: usize>(a: &mut [[f64; N]; N], v: &mut [[f64; N]; N], p: usize, q: usize) {
    let off = a[p][q];
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    // negligible beside both diagonal entries
    if a[p][p] + off == a[p][p] && a[q][q] + off == a[q][q] {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * off);
    let t = 1f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    a[p][p] -= t * off;
    a[q][q] += t * off;
    for r in (0..N).filter(|&r| r != p && r != q) {
        let (arp, arq) = (a[r][p], a[r][q]);
        a[r][p] = c * arp - s * arq;
        a[p][r] = a[r][p];
        a[r][q] = s * arp + c * arq;
        a[q][r] = a[r][q];
    }
    let (vp, vq) = (v[p], v[q]);
    v[p] = std::array::from_fn(|k| c * vp[k] - s * vq[k]);
    v[q] = std::array::from_fn(|k| s * vp[k] + c * vq[k]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(a: DMat3, b: DMat3, bound: f64) -> bool {
        a.abs_diff_eq(b, bound)
    }

    #[test]
    fn two_particles_have_the_inertia_of_a_dumbbell() {
        let points = [DVec3::new(11.0, 5.0, 5.0), DVec3::new(9.0, 5.0, 5.0)];
        let mass = MassProperties::from_particles(&points, 3.0);
        assert_eq!(mass.mass, 6.0);
        assert_eq!(mass.centre, DVec3::new(10.0, 5.0, 5.0));
        assert_eq!(mass.inertia, DMat3::from_diagonal(DVec3::new(0.0, 6.0, 6.0)));
    }

    #[test]
    fn particles_on_a_line_have_no_inertia_about_it() {
        let points: Vec<_> = (0..7).map(|i| DVec3::splat(0.1 * f64::from(i) + 3.0)).collect();
        let mass = MassProperties::from_particles(&points, 1.0);
        let axes = PrincipalAxes::new(mass.inertia, 0.0);
        assert_eq!(axes.rotation_count(), 2);
        let spin = axes.inverse() * DVec3::splat(1.0);
        assert!(spin.length() < 1e-12, "{spin}");
    }

    #[test]
    fn the_inertia_does_not_depend_on_the_distance_from_the_origin() {
        let corners = |at: f64| -> Vec<DVec3> {
            (0..8)
                .map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) + at)
                .collect()
        };
        let near = MassProperties::from_particles(&corners(0.0), 1.0).inertia;
        let far = MassProperties::from_particles(&corners(1e6), 1.0).inertia;
        assert!(close(near, far, 1e-9));
    }

    proptest! {
        #[test]
        fn principal_axes_and_moments_reproduce_the_tensor(
            points in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 4..20),
            scale in -8..8i32,
        ) {
            let scale = 10f64.powi(scale);
            let points: Vec<_> = points.into_iter().map(|p| DVec3::from_array(p) * scale).collect();
            let inertia = MassProperties::from_particles(&points, 1.0).inertia;
            let axes = PrincipalAxes::new(inertia, 0.0);
            let rebuilt = axes.axes * DMat3::from_diagonal(axes.moments) * axes.axes.transpose();
            let bound = 1e-12 * axes.moments.z;
            prop_assert!(close(rebuilt, inertia, bound.max(f64::MIN_POSITIVE)));
            prop_assert!(close(axes.axes * axes.axes.transpose(), DMat3::IDENTITY, 1e-14));
            prop_assert!((axes.axes.determinant() - 1.0).abs() < 1e-13);
            let identity = axes.inverse() * inertia;
            if axes.moments.x > 1e-6 * axes.moments.z {
                prop_assert!(close(identity, DMat3::IDENTITY, 1e-8));
            }
        }
    }
}
