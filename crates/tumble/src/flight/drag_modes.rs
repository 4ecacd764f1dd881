//! Drag on a body whose mass is not carried by equal particles.

use glam::{DMat3, DVec3};

use super::Glide;
use crate::shape::{ParticleMoments, PrincipalAxes, Shape, diagonalise};

/// The six motions of a body that drag only slows down, each at its own rate.
///
/// Drag alone changes the velocities linearly: M v' = −c (N v + ω × S), I ω' = −c (S × v + G ω). With the
/// velocities scaled by √M and √I the matrix is symmetric and constant in the body's principal axes;
/// its eigenvectors are these motions.
#[derive(Clone, Debug)]
pub struct DragModes {
    /// √M.
    root_mass: f64,
    /// √I by principal axis, 0 where there is no inertia.
    root_inertia: DVec3,
    /// Its inverse, 0 where there is no inertia.
    inverse_root_inertia: DVec3,
    /// Rates for c = 1 (1/(N·s/m) · 1/s).
    rates: [f64; 6],
    /// One mode a row.
    modes: [[f64; 6]; 6],
}

impl DragModes {
    /// Of a body of `mass` (kg); `None` where equal particles carry the mass and both momenta
    /// decay at one rate.
    pub fn of(shape: &Shape, mass: f64) -> Option<Self> {
        let moments = shape.moments();
        (!moments.carry_mass).then(|| Self::of_moments(moments, shape.principal(), mass))
    }

    /// Of a body of `mass` (kg) whose particles feel drag as `moments` say.
    pub(crate) fn of_moments(
        moments: &ParticleMoments,
        principal: &PrincipalAxes,
        mass: f64,
    ) -> Self {
        let axes = principal.axes;
        let inertia = principal.moments * mass;
        let root_inertia = DVec3::new(inertia.x.sqrt(), inertia.y.sqrt(), inertia.z.sqrt());
        let inverse = root_inertia.to_array().map(|r| if r > 0.0 { 1.0 / r } else { 0.0 });
        let root_mass = mass.sqrt();
        let s = axes.transpose() * moments.first;
        let g = axes.transpose() * moments.second * axes;
        let cross = DMat3::from_cols(
            DVec3::new(0.0, s.z, -s.y),
            DVec3::new(-s.z, 0.0, s.x),
            DVec3::new(s.y, -s.x, 0.0),
        );
        let mut matrix = [[0.0; 6]; 6];
        for i in 0..3 {
            matrix[i][i] = moments.count / mass;
            for j in 0..3 {
                matrix[3 + i][3 + j] = g.col(j)[i] * inverse[i] * inverse[j];
                matrix[3 + i][j] = cross.col(j)[i] * inverse[i] / root_mass;
                matrix[j][3 + i] = matrix[3 + i][j];
            }
        }
        let (rates, modes) = diagonalise(matrix);
        let inverse_root_inertia = DVec3::from_array(inverse);
        Self { root_mass, root_inertia, inverse_root_inertia, rates, modes }
    }

    /// The fastest rate for c = 1 (1/kg).
    pub fn fastest(&self) -> f64 {
        self.rates.iter().fold(0.0, |m, &rate| m.max(rate))
    }

    /// Lets gravity and drag with coefficient `c` act for `time` on velocity (m/s) and angular
    /// momentum (kg·m²/s), with `gravity` (m/s²), all in principal axes and none of them turning;
    /// returns the energy that drag takes (J).
    ///
    /// Each mode is a glide of its own: a' = b − c λ a, with b its share of gravity.
    pub fn fall(
        &self,
        velocity: &mut DVec3,
        momentum: &mut DVec3,
        gravity: DVec3,
        c: f64,
        time: f64,
    ) -> f64 {
        let w = *momentum * self.inverse_root_inertia;
        let (v, pull) = (*velocity * self.root_mass, gravity * self.root_mass);
        let motion = [v.x, v.y, v.z, w.x, w.y, w.z];
        let pull = [pull.x, pull.y, pull.z, 0.0, 0.0, 0.0];
        let mut change = [0.0; 6];
        let mut loss = 0.0;
        for (rate, mode) in self.rates.iter().zip(&self.modes) {
            let along =
                |vector: &[f64; 6]| -> f64 { mode.iter().zip(vector).map(|(m, y)| m * y).sum() };
            let (a, b) = (DVec3::X * along(&motion), DVec3::X * along(&pull));
            let glide = Glide::new(time, c * rate);
            loss += glide.loss(a, b);
            let (_, end) = glide.advance(a, b);
            for (sum, m) in change.iter_mut().zip(mode) {
                *sum += m * (end.x - a.x);
            }
        }
        *velocity += DVec3::new(change[0], change[1], change[2]) / self.root_mass;
        *momentum += DVec3::new(change[3], change[4], change[5]) * self.root_inertia;
        loss
    }
}
