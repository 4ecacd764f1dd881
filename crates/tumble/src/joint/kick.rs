//! The kick of joined bodies: the impulses of joints that act together with those of contacts and loads.
//!
//! Poses are fixed. The impulses of constraints keep their rates at zero; the impulse of each coordinate follows its
//! [law](super::law). Each piece of a law is linear, so all of them are one set of linear equations as long as no coordinate
//! leaves its piece; one that does goes on to the next piece, and the equations are solved again.

use super::law::{AtLimit, CoordinateLaw, Piece};
use super::rows::{MAX_ROWS, RowValues};
use super::system::{System, Twist, add_to_twist};
use crate::{Model, RunTotals, State, Wrench};

use super::work::set_twists;

/// Changes of pieces in a kick in which all coordinates may take part; then one at a time does.
const MAX_CHANGES: usize = 16;
/// All changes.
const MOST_CHANGES: usize = 400;

/// The coordinate of a joint that forces act along.
#[derive(Clone, Debug)]
struct Coordinate {
    joint: usize,
    row: usize,
    law: CoordinateLaw,
    /// The index of its present piece.
    piece: usize,
    /// u⁻, and u⁻ − u₀: what the flight before the kick changed.
    before: f64,
    change: f64,
}

/// The joints in one kick.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointKick {
    system: System,
    /// The time at the beginning of the step (s).
    time: f64,
    coordinates: Vec<Coordinate>,
    /// Velocities before the kick, and with all impulses so far.
    pub before: Vec<Twist>,
    pub twists: Vec<Twist>,
    /// Impulses of the joints.
    impulses: Vec<RowValues>,
    residuals: Vec<RowValues>,
    softness: Vec<RowValues>,
    changes: usize,
}

impl JointKick {
    /// Begins a kick over the time `h` (s) of bodies in these states, in a step that began at the coordinates `start` with the rates `rates`;
    /// without them at the present rates. No impulse acts so far.
    pub fn begin(&mut self, model: &Model, state: &State, [start, rates]: [&[f64]; 2], h: f64) {
        self.system.set_states(model, &state.bodies);
        set_twists(model, &state.bodies, &mut self.before);
        self.twists.clone_from(&self.before);
        let count = model.joints.list.len();
        self.impulses.clear();
        self.impulses.resize(count, RowValues::default());
        self.residuals.resize(count, RowValues::default());
        self.time = state.time;
        self.coordinates.clear();
        for (index, joint) in model.joints.list.iter().enumerate() {
            let acts = joint.acts_at(state.time);
            let Some(row) = joint.coordinate_row().filter(|_| acts) else { continue };
            let at_limit = match state.joints[index].force[row] {
                force if force > 0.0 => AtLimit::Lower,
                force if force < 0.0 => AtLimit::Upper,
                _ => AtLimit::None,
            };
            if at_limit == AtLimit::None && !joint.acts_along_coordinate() {
                continue;
            }
            let before = self.system.rates(model, index, &self.before)[row];
            let rate = rates.get(index).copied().unwrap_or(before);
            let law = CoordinateLaw::new(joint, (start[index], rate), h, at_limit);
            let (piece, change) = (law.piece_at(before), before - rate);
            self.coordinates.push(Coordinate { joint: index, row, law, piece, before, change });
        }
        self.factor(model);
    }

    /// Adds an impulse on a body that is not one of joints.
    pub fn push(&mut self, model: &Model, body: usize, impulse: Wrench) {
        if model.joints.acts_on(body) && model.bodies[body].is_free() {
            let place = &self.system.places[body];
            add_to_twist(&model.bodies[body], place, impulse, &mut self.twists[body]);
        }
    }

    /// Sets the velocities of the joined free bodies so that their means over the kick would be these without joints.
    pub fn set_mean_twists(&mut self, model: &Model, mean: impl Fn(usize) -> Twist) {
        for &body in &model.joints.bodies {
            let body = body as usize;
            if model.bodies[body].is_free() {
                let ((v, omega), before) = (mean(body), self.before[body]);
                self.twists[body] = (2.0 * v - before.0, 2.0 * omega - before.1);
            }
        }
    }

    /// Finds the impulses of joints for the velocities that the bodies have now, and applies them to these.
    pub fn solve(&mut self, model: &Model) {
        self.changes = 0;
        loop {
            // the second time for the digits that the first one lacks
            self.refine(model);
            self.refine(model);
            if !self.change_pieces(model) {
                return;
            }
        }
    }

    /// The matrix of the present pieces.
    fn factor(&mut self, model: &Model) {
        self.softness.clear();
        self.softness.extend(model.joints.list.iter().map(|joint| {
            let mut softness = [f64::NAN; MAX_ROWS];
            softness[..joint.constraint_count_at(self.time)].fill(0.0);
            softness
        }));
        for Coordinate { joint, row, law, piece, .. } in &self.coordinates {
            self.softness[*joint][*row] = match law.piece(*piece) {
                Piece::Vertical { .. } => 0.0,
                Piece::Sloped { a: 0.0, .. } => f64::NAN,
                Piece::Sloped { a, .. } => 1.0 / a,
            };
        }
        self.system.factor(model, &self.softness);
    }

    /// One correction of the impulses and velocities.
    fn refine(&mut self, model: &Model) {
        self.apply_given(model);
        for (joint, residual) in self.residuals.iter_mut().enumerate() {
            *residual = self.system.rates(model, joint, &self.twists).map(|rate| -rate);
        }
        for Coordinate { joint, row, law, piece, change, .. } in &self.coordinates {
            let residual = &mut self.residuals[*joint][*row];
            match law.piece(*piece) {
                Piece::Vertical { velocity, .. } => *residual += velocity - change,
                Piece::Sloped { a: 0.0, .. } => {}
                Piece::Sloped { a, b, .. } => {
                    let impulse = self.impulses[*joint][*row];
                    *residual += (b - impulse) / a - change;
                }
            }
        }
        self.system.solve(model, &mut self.residuals);
        self.add(model);
    }

    /// Applies the impulses of coordinates on pieces without slope, which do not depend on velocities.
    fn apply_given(&mut self, model: &Model) {
        let mut any = false;
        self.residuals.fill(RowValues::default());
        for Coordinate { joint, row, law, piece, .. } in &self.coordinates {
            if let Piece::Sloped { a: 0.0, b, .. } = law.piece(*piece) {
                let change = b - self.impulses[*joint][*row];
                self.residuals[*joint][*row] = change;
                any |= change != 0.0;
            }
        }
        if any {
            self.add(model);
        }
    }

    /// Adds the changes in `residuals` to impulses and velocities.
    fn add(&mut self, model: &Model) {
        for (impulses, changes) in self.impulses.iter_mut().zip(&self.residuals) {
            impulses.iter_mut().zip(changes).for_each(|(impulse, change)| *impulse += change);
        }
        self.system.add_to_twists(model, &self.residuals, &mut self.twists);
    }

    /// The rate of a coordinate at the end of the step, and its mean in the kick.
    fn end_and_mean(&self, model: &Model, coordinate: &Coordinate) -> [f64; 2] {
        let after = self.system.rates(model, coordinate.joint, &self.twists)[coordinate.row];
        [after + coordinate.change, 0.5 * (coordinate.before + after)]
    }

    /// Lets coordinates that have left their pieces go on to the next; returns whether there are any.
    fn change_pieces(&mut self, model: &Model) -> bool {
        if self.changes >= MOST_CHANGES {
            return false;
        }
        let mut has_changed = false;
        for index in 0..self.coordinates.len() {
            let coordinate = &self.coordinates[index];
            let impulse = self.impulses[coordinate.joint][coordinate.row];
            let (is_lower, is_higher) = match coordinate.law.piece(coordinate.piece) {
                Piece::Vertical { impulses: [low, high], .. } => (impulse > high, impulse < low),
                Piece::Sloped { between: [low, high], .. } => {
                    let [end, _] = self.end_and_mean(model, coordinate);
                    (end < low, end > high)
                }
            };
            let piece = &mut self.coordinates[index].piece;
            if is_lower {
                *piece -= 1;
            } else if is_higher {
                *piece += 1;
            } else {
                continue;
            }
            has_changed = true;
            // the least index alone ends every cycle (K. G. Murty, Opsearch 11 (1974) 87)
            if self.changes > MAX_CHANGES {
                break;
            }
        }
        if has_changed {
            self.changes += 1;
            self.factor(model);
        }
        has_changed
    }

    /// The impulses on each body that joints exert, and what they take or add.
    pub fn account(
        &self,
        model: &Model,
        step_impulses: &mut [Wrench],
        mut apply: impl FnMut(usize, Wrench),
    ) -> RunTotals {
        self.system.for_each_wrench(model, &self.impulses, &mut apply);
        for (joint, (sum, impulses)) in step_impulses.iter_mut().zip(&self.impulses).enumerate() {
            *sum += self.system.wrench_at_joint(joint, impulses);
        }
        let mut totals = RunTotals::default();
        for coordinate in &self.coordinates {
            let rates = self.end_and_mean(model, coordinate);
            let impulse = self.impulses[coordinate.joint][coordinate.row];
            let parts = coordinate.law.parts(coordinate.piece, rates, impulse);
            totals.motor += parts.motor * rates[1];
            totals.joint_friction -= parts.losses * rates[1];
        }
        totals
    }

    /// The velocities in the middle of the kick.
    pub fn mean_twist(&self, body: usize) -> Twist {
        let (before, after) = (self.before[body], self.twists[body]);
        (0.5 * (before.0 + after.0), 0.5 * (before.1 + after.1))
    }
}

/// Energy in the springs of joints (J).
pub(crate) fn spring_energy(model: &Model, state: &State) -> f64 {
    let mut energy = 0.0;
    let mut system = System::default();
    if model.joints.list.iter().any(|joint| joint.stiffness > 0.0) {
        system.set_states(model, &state.bodies);
    }
    let joints = model.joints.list.iter().zip(&system.rows).zip(&state.joints);
    for ((joint, rows), joint_state) in joints {
        if let Some(row) = joint.coordinate_row().filter(|_| joint.stiffness > 0.0) {
            let x = joint.near(rows.rows[row].value, joint_state.coordinate) - joint.natural;
            energy += 0.5 * joint.stiffness * x * x;
        }
    }
    energy
}
