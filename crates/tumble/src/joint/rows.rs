//! Rows: the constraints and the coordinate of a joint, with their gradients.
//!
//! Let p be the points of both bodies at which the joint acts, r = p − x the arms, and d a direction. All rows have the form u = d·(v₁ − v₂) + a₁·ω₁ − a₂·ω₂ of a
//! rate, where u is exactly the derivative of the row's value along any motion:
//!
//! - d·(p₁ − p₂) with d fixed in the world (ball, hinge, weld): aₖ = rₖ × d;
//! - d·(p₁ − p₂) with d fixed in the second body (slider): a₁ = r₁ × d, a₂ = (p₁ − x₂) × d;
//! - |p₁ − p₂|: d = (p₁ − p₂)/|p₁ − p₂|, aₖ = rₖ × d;
//! - e₁·e₂ of two axes, one of each body (hinge, slider, weld): d = 0, a₁ = a₂ = e₁ × e₂;
//! - the angle of a hinge: d = 0, a₁ = a₂ = the axis.

use glam::DVec3;

use super::definition::JointKind;
use super::model::{JointModel, Place};

/// The largest number of rows of a joint.
pub(crate) const MAX_ROWS: usize = 6;

/// One number for each row of a joint: impulses, residuals.
pub(crate) type RowValues = [f64; MAX_ROWS];

/// One row.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Row {
    /// d.
    pub linear: DVec3,
    /// a₁ and a₂.
    pub angular: [DVec3; 2],
    /// Its value (m, or dimensionless).
    pub value: f64,
}

/// The rows of a joint: its constraints, then its coordinate if it has one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct JointRows {
    pub count: usize,
    pub rows: [Row; MAX_ROWS],
    /// r₁, about whose end the torque of the joint is given (m).
    pub arm: DVec3,
}

impl Row {
    /// u at these velocities and angular velocities.
    pub fn rate(&self, [first, second]: [(DVec3, DVec3); 2]) -> f64 {
        self.linear.dot(first.0 - second.0) + self.angular[0].dot(first.1)
            - self.angular[1].dot(second.1)
    }

    fn point(direction: DVec3, arms: [DVec3; 2], separation: DVec3) -> Self {
        Self {
            linear: direction,
            angular: arms.map(|arm| arm.cross(direction)),
            value: direction.dot(separation),
        }
    }

    fn axes(first: DVec3, second: DVec3) -> Self {
        let normal = first.cross(second);
        Self { linear: DVec3::ZERO, angular: [normal; 2], value: first.dot(second) }
    }
}

impl JointRows {
    /// The rows with the bodies at these places.
    pub fn new(joint: &JointModel, places: [Place; 2]) -> Self {
        let [a, b] = places;
        let arms = [a.rotation * joint.anchors[0], b.rotation * joint.anchors[1]];
        let separation =
            (a.position - b.position) + ((a.compensation - b.compensation) + (arms[0] - arms[1]));
        let [first, second] = [a.rotation * joint.axes[0], b.rotation * joint.axes[1]];
        let mut rows = Self { arm: arms[0], ..Self::default() };
        if joint.kind.has_length() {
            let distance = separation.length();
            let row = Row::point(separation / distance, arms, separation);
            rows.push(Row { value: distance - joint.start_length, ..row });
            return rows;
        }
        if joint.kind == JointKind::Slider {
            let arms = [arms[0], arms[1] + separation];
            for direction in [second.y_axis, second.z_axis] {
                rows.push(Row::point(direction, arms, separation));
            }
        } else {
            for direction in [DVec3::X, DVec3::Y, DVec3::Z] {
                rows.push(Row::point(direction, arms, separation));
            }
        }
        match joint.kind {
            JointKind::Hinge => {
                rows.push(Row::axes(first.x_axis, second.y_axis));
                rows.push(Row::axes(first.x_axis, second.z_axis));
                rows.push(Row {
                    linear: DVec3::ZERO,
                    angular: [second.x_axis; 2],
                    value: libm::atan2(
                        first.y_axis.dot(second.z_axis),
                        first.y_axis.dot(second.y_axis),
                    ),
                });
            }
            JointKind::Slider | JointKind::Weld => {
                rows.push(Row::axes(first.x_axis, second.y_axis));
                rows.push(Row::axes(first.y_axis, second.z_axis));
                rows.push(Row::axes(first.z_axis, second.x_axis));
            }
            _ => {}
        }
        if joint.kind == JointKind::Slider {
            let arms = [arms[0], arms[1] + separation];
            rows.push(Row::point(second.x_axis, arms, separation));
        }
        rows
    }

    fn push(&mut self, row: Row) {
        self.rows[self.count] = row;
        self.count += 1;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use glam::{DMat3, DQuat};

    use super::*;
    use crate::joint::Joint;

    fn place(seed: f64) -> Place {
        let position = DVec3::new(seed.sin(), (2.0 * seed).cos(), (3.0 * seed).sin());
        let rotation = DMat3::from_quat(DQuat::from_scaled_axis(0.7 * position + DVec3::X * seed));
        Place { position, rotation, ..Place::WORLD }
    }

    fn moved(place: Place, (v, omega): (DVec3, DVec3), h: f64) -> Place {
        let turn = DMat3::from_quat(DQuat::from_scaled_axis(omega * h));
        Place { position: place.position + v * h, rotation: turn * place.rotation, ..place }
    }

    /// Of joints with the bodies anywhere, not only where the constraints hold.
    #[test]
    fn rates_are_the_derivatives_of_values() {
        let at = [DVec3::new(0.2, 0.3, -0.1), DVec3::new(-0.4, 0.1, 0.3)];
        let velocities = [
            (DVec3::new(0.3, -0.2, 0.5), DVec3::new(1.0, 0.4, -0.7)),
            (DVec3::new(-0.1, 0.6, 0.2), DVec3::new(-0.3, 0.8, 0.9)),
        ];
        for kind in JointKind::ALL {
            let second = if kind.has_length() { at[1] } else { at[0] };
            let axis = DVec3::new(0.2, 1.0, -0.5);
            let joint = Joint { at: [at[0], second], axis, ..Joint::new(kind, ["a", "b"], at[0]) };
            let start = [place(0.3), place(1.1)];
            let model = JointModel::new(&joint, String::new(), [Some(0), Some(1)], start);
            // the axis of a hinge is not that of both bodies elsewhere, where its angle is not defined
            let away = if kind == JointKind::Hinge { start } else { [place(0.35), place(1.0)] };
            let h = 1e-5;
            let at_time = |h: f64| {
                let [a, b] = [0, 1].map(|k| moved(away[k], velocities[k], h));
                JointRows::new(&model, [a, b])
            };
            let (before, rows, after) = (at_time(-h), at_time(0.0), at_time(h));
            for index in 0..rows.count {
                let found = (after.rows[index].value - before.rows[index].value) / (2.0 * h);
                let expected = rows.rows[index].rate(velocities);
                assert!((found - expected).abs() < 1e-8, "{kind:?} {index}: {found} {expected}");
            }
            let start = JointRows::new(&model, start);
            assert!(
                start.rows[..start.count].iter().all(|row| row.value.abs() < 1e-14),
                "{kind:?}"
            );
        }
    }
}
