//! The order of convergence of contact in the time step.
//!
//! Every kind of contact is run with dt, dt/2 and dt/4 and compared with an independent solution of its equations of motion:
//! a closed form, or the Runge–Kutta method with far smaller steps. These equations are written for one situation each, without any code of
//! the simulator.

mod plane;
mod spheres;
mod touch;

use tumble::{DVec3, World};

use crate::check::{Check, Error};

pub(crate) use self::plane::CASE as PLANE;
pub(crate) use self::spheres::CASE as SPHERES;
pub(crate) use self::touch::CASE as TOUCH;

/// How far the observed order may be from 2.
const BOUND: f64 = 0.2;

/// A spring of the reference whose stretch is at least this part of the limit slips; less is rounding and the error of a step.
const AT_LIMIT: f64 = 1.0 - 1e-6;

/// Position, velocity, and angular velocity times a length, of one body.
#[derive(Clone, Copy, Debug)]
struct Motion {
    position: DVec3,
    velocity: DVec3,
    rim_velocity: DVec3,
}

impl Motion {
    /// The motion of a body of radius `radius` (m).
    fn of(world: &World, body: usize, radius: f64) -> Self {
        let body = world.body(body);
        Self {
            position: body.position(),
            velocity: body.velocity(),
            rim_velocity: body.angular_velocity() * radius,
        }
    }

    /// The square of the difference to another motion (m²/s²). Positions count by the `rate` (1/s) of contact.
    fn squared_difference(&self, other: &Self, rate: f64) -> f64 {
        ((self.position - other.position) * rate).length_squared()
            + (self.velocity - other.velocity).length_squared()
            + (self.rim_velocity - other.rim_velocity).length_squared()
    }
}

/// The check of the order from the errors (m/s) with `dt`, `dt`/2 and `dt`/4.
fn order_check(
    quantity: String,
    dt: f64,
    error: impl Fn(f64) -> Result<f64, Error>,
) -> Result<Check, Error> {
    let errors = [error(dt)?, error(0.5 * dt)?, error(0.25 * dt)?];
    let order = libm::log2(errors[1] / errors[2]);
    let remark = format!("errors {:.1e}, {:.1e}, {:.1e} m/s", errors[0], errors[1], errors[2]);
    Ok(Check::new(quantity, 2.0, order, BOUND, "").remark(remark))
}

/// Sets the friction springs of a world that has not yet made a step: those of walls and of pairs of bodies, as a function of the
/// particle, to the stretch of the body `index` (m).
fn set_springs(
    world: &mut World,
    index: usize,
    stretch: impl Fn(u32) -> DVec3,
) -> Result<(), Error> {
    // a step lists the contacts in their order
    let mut probe = world.clone();
    probe.step()?;
    let mut state = world.state().clone();
    state.springs.clone_from(&probe.state().springs);
    state.pair_springs.clone_from(&probe.state().pair_springs);
    for spring in &mut state.springs[index] {
        spring.stretch = stretch(spring.particle);
        let particle = world.body(index).particle(spring.particle as usize).0;
        spring.anchor = particle - spring.stretch;
    }
    for spring in &mut state.pair_springs {
        // that of the first body relative to the second
        let sign = if spring.first as usize == index { 1.0 } else { -1.0 };
        spring.stretch = stretch(spring.particle) * sign;
    }
    world.restore(state)?;
    Ok(())
}
