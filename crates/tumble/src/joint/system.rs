//! The equations of all joints: velocities of the bodies, rows, and the matrix that couples the rows.

use glam::DVec3;

use super::elimination::{Block, Coupling, Matrix};
use super::model::{JointModel, Place};
use super::rows::{JointRows, MAX_ROWS, RowValues};
use crate::{BodyModel, BodyState, Model, Wrench};

/// Velocity and angular velocity (m/s, rad/s).
pub(crate) type Twist = (DVec3, DVec3);

/// The rows of all joints with the bodies at given places.
#[derive(Clone, Debug, Default)]
pub(crate) struct System {
    /// Where the bodies are, by body; valid for joined ones.
    pub places: Vec<Place>,
    /// The rows, by joint.
    pub rows: Vec<JointRows>,
    /// I⁻¹ a of each row and body.
    turned: Vec<[[DVec3; MAX_ROWS]; 2]>,
    pub matrix: Matrix,
}

impl System {
    /// Sets places and rows.
    pub fn set_places(&mut self, model: &Model, place: impl Fn(usize) -> Place) {
        self.places.resize(model.bodies.len(), Place::WORLD);
        for &body in &model.joints.bodies {
            self.places[body as usize] = place(body as usize);
        }
        let places = &self.places;
        let of = |body: Option<u32>| body.map_or(Place::WORLD, |body| places[body as usize]);
        self.rows.clear();
        let joints = model.joints.list.iter();
        self.rows.extend(joints.map(|joint| JointRows::new(joint, joint.bodies.map(of))));
    }

    /// Sets the places to those of states.
    pub fn set_states(&mut self, model: &Model, states: &[BodyState]) {
        self.set_places(model, |body| Place::new(&states[body]));
    }

    /// Assembles S = G M⁻¹ Gᵀ of the rows for which `softness` is not NaN, adds the softness to their diagonal elements, and eliminates.
    pub fn factor(&mut self, model: &Model, softness: &[RowValues]) {
        let joints = &model.joints;
        self.turned.clear();
        for (joint, rows) in joints.list.iter().zip(&self.rows) {
            let mut turned = [[DVec3::ZERO; MAX_ROWS]; 2];
            for (side, body) in free_bodies(model, joint) {
                let place = &self.places[body];
                for (turned, row) in turned[side].iter_mut().zip(&rows.rows[..rows.count]) {
                    *turned =
                        model.bodies[body].angular_velocity(place.rotation, row.angular[side]);
                }
            }
            self.turned.push(turned);
        }
        let elimination = &joints.elimination;
        let Matrix { diagonal, blocks, .. } = &mut self.matrix;
        diagonal.clear();
        for &joint in &elimination.order {
            let index = joint as usize;
            diagonal.push(own_block(model, index, (&self.rows, &self.turned), &softness[index]));
        }
        blocks.clear();
        blocks.resize(elimination.block_count(), Block::default());
        for coupling in &elimination.couplings {
            let block = &mut blocks[coupling.block as usize];
            couple(model, coupling, (&self.rows, &self.turned), (softness, block));
        }
        elimination.factor(&mut self.matrix);
    }

    /// Sets the softness of rows without a pivot to NaN.
    pub fn leave_out_dependent(&self, model: &Model, softness: &mut [RowValues]) {
        let order = &model.joints.elimination.order;
        for (&joint, pivots) in order.iter().zip(&self.matrix.pivots) {
            let softness = &mut softness[joint as usize];
            for (softness, pivot) in softness.iter_mut().zip(pivots.diagonal) {
                if pivot == 0.0 {
                    *softness = f64::NAN;
                }
            }
        }
    }

    /// Solves for the impulses, in place.
    pub fn solve(&self, model: &Model, values: &mut [RowValues]) {
        model.joints.elimination.solve(&self.matrix, values);
    }

    /// The rates of all rows of a joint.
    pub fn rates(&self, model: &Model, joint: usize, twists: &[Twist]) -> RowValues {
        let of = |body: Option<u32>| body.map_or_else(Twist::default, |body| twists[body as usize]);
        let of_joint = model.joints.list[joint].bodies.map(of);
        let rows = &self.rows[joint];
        let mut rates = RowValues::default();
        for (rate, row) in rates.iter_mut().zip(&rows.rows[..rows.count]) {
            *rate = row.rate(of_joint);
        }
        rates
    }

    /// The impulse that a joint exerts on its first or second body, with the torque impulse about the centre of mass.
    pub fn wrench(&self, joint: usize, side: usize, impulses: &RowValues) -> Wrench {
        let mut wrench = Wrench::default();
        let rows = &self.rows[joint];
        for (row, &impulse) in rows.rows[..rows.count].iter().zip(impulses) {
            wrench.force += row.linear * impulse;
            wrench.torque += row.angular[side] * impulse;
        }
        if side == 0 { wrench } else { Wrench::default() - wrench }
    }

    /// The same on the first body, with the torque about its point of the joint.
    pub fn wrench_at_joint(&self, joint: usize, impulses: &RowValues) -> Wrench {
        let Wrench { force, torque } = self.wrench(joint, 0, impulses);
        Wrench { force, torque: torque - self.rows[joint].arm.cross(force) }
    }

    /// Calls `apply` with each body of each joint, and the impulse on it.
    pub fn for_each_wrench(
        &self,
        model: &Model,
        impulses: &[RowValues],
        mut apply: impl FnMut(usize, Wrench),
    ) {
        for (index, joint) in model.joints.list.iter().enumerate() {
            for (side, body) in joint.bodies.iter().enumerate() {
                if let Some(body) = body {
                    apply(*body as usize, self.wrench(index, side, &impulses[index]));
                }
            }
        }
    }

    /// Adds impulses to the velocities of the free bodies.
    pub fn add_to_twists(&self, model: &Model, impulses: &[RowValues], twists: &mut [Twist]) {
        self.for_each_wrench(model, impulses, |index, wrench| {
            let body = &model.bodies[index];
            if body.is_free() {
                add_to_twist(body, &self.places[index], wrench, &mut twists[index]);
            }
        });
    }

    /// Adds impulses to the momenta of the free bodies.
    pub fn add_to_states(&self, model: &Model, impulses: &[RowValues], states: &mut [BodyState]) {
        self.for_each_wrench(model, impulses, |index, Wrench { force, torque }| {
            let body = &model.bodies[index];
            if body.is_free() {
                states[index].velocity += force / body.mass;
                states[index].angular_momentum += torque;
            }
        });
    }

    /// The work that prescribed motions do against impulses (J).
    pub fn work(&self, model: &Model, impulses: &[RowValues], twists: &[Twist]) -> f64 {
        let mut work = 0.0;
        self.for_each_wrench(model, impulses, |index, Wrench { force, torque }| {
            if !model.bodies[index].is_free() {
                let (v, omega) = twists[index];
                work -= force.dot(v) + torque.dot(omega);
            }
        });
        work
    }
}

/// Adds an impulse to the velocities of a body.
pub(crate) fn add_to_twist(body: &BodyModel, place: &Place, impulse: Wrench, twist: &mut Twist) {
    twist.0 += impulse.force / body.mass;
    twist.1 += body.angular_velocity(place.rotation, impulse.torque);
}

/// The sides of a joint with free bodies, and these.
fn free_bodies<'a>(
    model: &'a Model,
    joint: &'a JointModel,
) -> impl Iterator<Item = (usize, usize)> + 'a {
    let bodies = joint.bodies.iter().enumerate();
    let bodies = bodies.filter_map(|(side, body)| Some((side, (*body)? as usize)));
    bodies.filter(|&(_, body)| model.bodies[body].is_free())
}

type Coefficients<'a> = (&'a [JointRows], &'a [[[DVec3; MAX_ROWS]; 2]]);

fn own_block(
    model: &Model,
    joint: usize,
    (rows, turned): Coefficients,
    softness: &RowValues,
) -> Block {
    let (rows, turned) = (&rows[joint], &turned[joint]);
    let mut block = Block::default();
    for (side, body) in free_bodies(model, &model.joints.list[joint]) {
        let inverse_mass = 1.0 / model.bodies[body].mass;
        for i in (0..rows.count).filter(|&i| !softness[i].is_nan()) {
            for j in (0..rows.count).filter(|&j| !softness[j].is_nan()) {
                let (a, b) = (&rows.rows[i], &rows.rows[j]);
                block[i][j] +=
                    inverse_mass * a.linear.dot(b.linear) + a.angular[side].dot(turned[side][j]);
            }
        }
    }
    for (i, softness) in softness.iter().enumerate().filter(|(_, softness)| !softness.is_nan()) {
        block[i][i] += softness;
    }
    block
}

fn couple(
    model: &Model,
    coupling: &Coupling,
    (rows, turned): Coefficients,
    (softness, block): (&[RowValues], &mut Block),
) {
    let Coupling { later, earlier, sides: [side, other_side], .. } = *coupling;
    let (later, earlier) = (later as usize, earlier as usize);
    let (side, other_side) = (side as usize, other_side as usize);
    let Some(body) = model.joints.list[later].bodies[side] else { return };
    let inverse_mass = 1.0 / model.bodies[body as usize].mass;
    let sign = if side == other_side { 1.0 } else { -1.0 };
    for i in (0..rows[later].count).filter(|&i| !softness[later][i].is_nan()) {
        for j in (0..rows[earlier].count).filter(|&j| !softness[earlier][j].is_nan()) {
            let (a, b) = (&rows[later].rows[i], &rows[earlier].rows[j]);
            block[i][j] += sign
                * (inverse_mass * a.linear.dot(b.linear)
                    + a.angular[side].dot(turned[earlier][other_side][j]));
        }
    }
}
