//! The basic system of docs/theory.md, as plain loops over particles, beside the library.
//!
//! Eight particles at the corners of a brick are thrown into a box with an open top, with drag. The loops follow the
//! numbered lines of the theory one by one; the library takes the same steps with [`Integrator::Euler`]. Both give the
//! same numbers but for rounding, which grows with every bounce.

use tumble::{Body, DMat3, DQuat, DVec3, Integrator, Shape, WallBox, World};

const M: f64 = 1.0; // mass of a particle (kg)
const G: DVec3 = DVec3::new(0.0, -9.8, 0.0); // gravity (m/s²)
const K: f64 = 1e4; // stiffness of a particle's contact spring (N/m)
const C: f64 = 1.0; // drag on a particle (N·s/m)
const H: f64 = 1e-3; // time step (s)

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let r: Vec<DVec3> = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5)
        .map(|corner| corner * DVec3::new(0.3, 0.2, 0.1))
        .collect();
    let body = Body::new(Shape::from_particles(&r)?)
        .particle_mass(M)
        .velocity(DVec3::new(4.0, 2.0, 3.0))
        .angular_velocity(DVec3::new(1.0, 20.0, 2.0));
    let mut world = World::builder()
        .gravity(G)
        .velocity_damping_stiffness(C)
        .dt(H)
        .integrator(Integrator::Euler)
        .box_walls(&WallBox::arena()) // springs of 1e4 N/m, no dashpots, no friction
        .body(body)
        .build()?;

    // line 1: total mass, inertia tensor about the centre of mass, and its inverse
    let mass = M * r.len() as f64;
    let mut inertia = DMat3::ZERO;
    for r in &r {
        let outer = DMat3::from_cols(*r * r.x, *r * r.y, *r * r.z);
        inertia += M * (DMat3::from_diagonal(DVec3::splat(r.dot(*r))) - outer);
    }
    let inverse = inertia.inverse();

    let (mut x, mut v, mut q) = (DVec3::ZERO, DVec3::new(4.0, 2.0, 3.0), DQuat::IDENTITY);
    let mut l = inertia * DVec3::new(1.0, 20.0, 2.0);
    println!("time (s)   height by loops (m)   height by World (m)   difference (m)");
    for step in 1..=1500 {
        // line 7: rotation matrix and angular velocity
        let rotation = DMat3::from_quat(q);
        let omega = rotation * inverse * rotation.transpose() * l;
        let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        for r in &r {
            // line 7: position and velocity of the particle
            let arm = rotation * *r;
            let (xi, vi) = (x + arm, v + omega.cross(arm));
            // lines 2 and 8: gravity and drag
            let mut f = M * G - C * vi;
            // line 9: a spring for each wall that the particle penetrates
            for wall in WallBox::arena().planes() {
                f += K * wall.depth(xi).max(0.0) * wall.normal;
            }
            // lines 3 and 4: total force, and total torque about the centre of mass
            force += f;
            torque += arm.cross(f);
        }
        // line 5: velocity, then position with the new velocity
        v += force / mass * H;
        x += v * H;
        // line 6: orientation, with the angular velocity of the start of the step
        q = (q + DQuat::from_xyzw(omega.x, omega.y, omega.z, 0.0) * q * (0.5 * H)).normalize();
        // line 7: angular momentum
        l += torque * H;

        world.step()?;
        let difference = (world.body(0).position() - x).length();
        assert!(difference < 1e-9, "the loops and the library differ by {difference} m");
        if step % 250 == 0 {
            let height = world.body(0).position().y;
            println!("{:8.2}   {:19.12}   {height:19.12}   {difference:14.1e}", world.time(), x.y);
        }
    }
    Ok(())
}
