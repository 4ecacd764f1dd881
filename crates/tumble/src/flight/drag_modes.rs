//! Drag on a body whose mass is not carried by equal particles.

use glam::DVec3;

use super::linear_drag::LinearDrag;
use crate::shape::{MassScaledForm, Shape, diagonalise};

/// The six modes of motion that drag damps independently, each at its own rate.
///
/// Drag alone changes the velocities linearly: M v' = −c (N v + ω × S), I ω' = −c (S × v + G ω). With the
/// velocities scaled by √M and √I the matrix is symmetric, and it is constant in the body's principal axes.
/// Its eigenvectors are the modes.
#[derive(Clone, Debug)]
pub struct DragModes {
    /// √M.
    root_mass: f64,
    /// √I by principal axis, 0 where there is no inertia.
    root_inertia: DVec3,
    /// 1/√I by principal axis, 0 where there is no inertia.
    inverse_root_inertia: DVec3,
    /// Rates for c = 1 N·s/m (1/s).
    rates: [f64; 6],
    /// The modes, one per row.
    modes: [[f64; 6]; 6],
}

impl DragModes {
    /// The modes of a body of `mass` (kg); `None` where equal particles carry the mass, so that both
    /// momenta decay at one rate.
    pub fn new(shape: &Shape, mass: f64) -> Option<Self> {
        let moments = shape.moments();
        if moments.carries_mass {
            return None;
        }
        let form = MassScaledForm::new(moments, shape.principal(), mass);
        let (rates, modes) = diagonalise(form.matrix);
        let MassScaledForm { root_mass, root_inertia, inverse_root_inertia, .. } = form;
        Some(Self { root_mass, root_inertia, inverse_root_inertia, rates, modes })
    }

    /// The largest rate for c = 1 N·s/m, over all modes (1/kg).
    pub fn fastest(&self) -> f64 {
        self.rates.iter().fold(0.0, |m, &rate| m.max(rate))
    }

    /// Advances velocity (m/s) and angular momentum (kg·m²/s) by `time` (s) under gravity (m/s²) and drag
    /// with coefficient `c` (N·s/m), all in principal axes, at a fixed orientation. Returns the energy lost
    /// to drag (J).
    ///
    /// The amplitude a of each mode obeys a' = b − c λ a, with b the component of gravity along the mode.
    pub fn fall(
        &self,
        velocity: &mut DVec3,
        momentum: &mut DVec3,
        gravity: DVec3,
        c: f64,
        time: f64,
    ) -> f64 {
        let w = *momentum * self.inverse_root_inertia;
        let (v, weight) = (*velocity * self.root_mass, gravity * self.root_mass);
        let motion = [v.x, v.y, v.z, w.x, w.y, w.z];
        let weight = [weight.x, weight.y, weight.z, 0.0, 0.0, 0.0];
        let mut change = [0.0; 6];
        let mut loss = 0.0;
        for (rate, mode) in self.rates.iter().zip(&self.modes) {
            let component =
                |vector: &[f64; 6]| -> f64 { mode.iter().zip(vector).map(|(m, y)| m * y).sum() };
            let (a, b) = (DVec3::X * component(&motion), DVec3::X * component(&weight));
            let drag = LinearDrag::new(time, c * rate);
            loss += drag.loss(a, b);
            let (_, end) = drag.advance(a, b);
            for (sum, m) in change.iter_mut().zip(mode) {
                *sum += m * (end.x - a.x);
            }
        }
        *velocity += DVec3::new(change[0], change[1], change[2]) / self.root_mass;
        *momentum += DVec3::new(change[3], change[4], change[5]) * self.root_inertia;
        loss
    }
}
