//! A tube along a trefoil knot.
//!
//! The knot lies on a torus. The normal of the torus and its cross product with the tangent form a frame along the
//! tube that closes without twist.

use super::error::{PrimitiveError, check_vertex_count};
use crate::shape::mesh::Mesh;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_3, TAU};

/// Minor radius of the torus on which the knot lies, in units of its major radius.
const COIL: f64 = 0.5;

/// Largest radius of the tube, in units of the major radius of the torus. Measured: strands of the curve come within
/// 2 · 0.4158 of each other, and its smallest radius of curvature is 0.715.
pub(super) const MAX_TUBE: f64 = 0.41;

/// Integration steps per ring.
const STEPS: u32 = 16;

/// |dc/dt| of the knot with R = 1.
fn speed(t: f64) -> f64 {
    let q = 1.0 + COIL * libm::cos(3.0 * t);
    (4.0 * q * q + 9.0 * COIL * COIL).sqrt()
}

/// Length of the knot with R = 1. The trapezoidal rule is exact to rounding for a smooth periodic function.
fn length() -> f64 {
    let n = 64;
    let lobe = TAU / 3.0;
    TAU * (0..n).map(|i| speed(lobe * f64::from(i) / f64::from(n))).sum::<f64>() / f64::from(n)
}

/// Parameters that divide one of the three lobes, t from 0 to 2π/3, into `n` parts of equal length.
///
/// The second half mirrors the first, so that the mesh has the symmetry of the knot.
fn lobe_parameters(n: u32) -> Vec<f64> {
    let step = length() / 3.0 / f64::from(n) / f64::from(STEPS);
    let mut t = 0.0;
    let mut half = vec![0.0];
    for _ in 0..n / 2 {
        // dt/ds = 1/|c'|, by the classical Runge-Kutta method
        for _ in 0..STEPS {
            let k1 = 1.0 / speed(t);
            let k2 = 1.0 / speed(t + 0.5 * step * k1);
            let k3 = 1.0 / speed(t + 0.5 * step * k2);
            let k4 = 1.0 / speed(t + step * k3);
            t += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        half.push(t);
    }
    if n.is_multiple_of(2) {
        half[n as usize / 2] = FRAC_PI_3;
    }
    let mirrored = |k: u32| {
        if k <= n / 2 { half[k as usize] } else { 2.0 * FRAC_PI_3 - half[(n - k) as usize] }
    };
    (0..n).map(mirrored).collect()
}

/// Point of the knot, normal of the torus, and unit cross product of tangent and normal, with R = 1.
fn frame(t: f64) -> (DVec3, DVec3, DVec3) {
    let (sin3, cos3) = libm::sincos(3.0 * t);
    let (sin2, cos2) = libm::sincos(2.0 * t);
    let q = 1.0 + COIL * cos3;
    let point = DVec3::new(q * cos2, COIL * sin3, q * sin2);
    let normal = DVec3::new(cos3 * cos2, sin3, cos3 * sin2);
    let tangent = DVec3::new(
        -3.0 * COIL * sin3 * cos2 - 2.0 * q * sin2,
        3.0 * COIL * cos3,
        -3.0 * COIL * sin3 * sin2 + 2.0 * q * cos2,
    );
    let across = tangent.cross(normal);
    (point, normal, across / across.length())
}

/// The tube, with `segments` vertices around it and the same spacing along it.
pub(super) fn trefoil(
    radius: f64,
    tube_radius: f64,
    segments: u32,
) -> Result<Mesh, PrimitiveError> {
    let around = f64::from(segments);
    let spacing = TAU * tube_radius / around;
    let per_lobe = (length() * radius / (3.0 * spacing)).round().max(8.0);
    check_vertex_count("knot", 3.0 * per_lobe * around)?;
    let per_lobe = per_lobe as u32;

    let lobe = lobe_parameters(per_lobe);
    let mut mesh = Mesh::default();
    for turn in 0..3u32 {
        for &t in &lobe {
            let (point, normal, across) = frame(t + TAU / 3.0 * f64::from(turn));
            for k in 0..segments {
                let (sin, cos) = libm::sincos(TAU * f64::from(k) / around);
                mesh.vertices.push(radius * point + tube_radius * (cos * normal + sin * across));
            }
        }
    }

    let rings = 3 * per_lobe;
    for ring in 0..rings {
        let next = (ring + 1) % rings;
        for k in 0..segments {
            let l = (k + 1) % segments;
            let [a, b] = [ring, next].map(|r| r * segments + k);
            let [c, d] = [ring, next].map(|r| r * segments + l);
            // (around) × (along) points outwards, so the neighbour around comes first
            mesh.triangles.extend([[a, c, d], [a, d, b]]);
        }
    }
    Ok(mesh)
}
