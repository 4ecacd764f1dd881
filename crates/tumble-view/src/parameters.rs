//! The sliders of the page: key, value, unit and range of each number that can be changed.

use tumble::{DVec3, Damping, MaterialOverride};
use tumble_io::page::Parameter;
use tumble_io::scene::{BodyScene, MassScene, Scene};

use crate::scene_edit::applies_at_once;

/// Only the first few bodies and walls of a scene have sliders.
const MAX_TABLES: usize = 8;

/// The sliders for a scene, in the order in which the page shows them.
pub fn parameters(scene: &Scene) -> Vec<Parameter> {
    let mut list = ParameterList(Vec::new());
    // up to about the longest step of the integrator `implicit`
    list.log("dt", scene.dt, "s", (1e-5, 0.016));
    list.vector("gravity", scene.gravity, "m/s²", 20.0);
    list.linear(
        "velocity_damping_stiffness",
        scene.velocity_damping_stiffness,
        "N·s/m",
        (0.0, 5.0),
    );
    if let Some(tolerance) = scene.energy_tolerance {
        list.log("energy_tolerance", tolerance, "", (1e-12, 1e-2));
    }
    list.material("collision", &scene.collision.into());
    if let Some(walls) = &scene.box_walls {
        list.material("box", &walls.material);
    }
    for (index, wall) in scene.walls.iter().enumerate().take(MAX_TABLES) {
        let table = format!("wall.{index}");
        list.linear(&format!("{table}.offset"), wall.plane.offset, "m", (-2.0, 2.0));
        list.material(&table, &wall.material);
    }
    for (index, body) in scene.bodies.iter().enumerate().take(MAX_TABLES) {
        list.body(&format!("body.{index}"), body, !scene.joints.is_empty());
    }
    list.0
}

struct ParameterList(Vec<Parameter>);

impl ParameterList {
    /// Adds a logarithmic slider. The range is extended to include the value.
    fn log(&mut self, key: &str, value: f64, unit: &'static str, (min, max): (f64, f64)) {
        // zero has no place on a logarithmic scale
        if value <= 0.0 {
            return self.linear(key, value, unit, (0.0, max));
        }
        self.push(key, value, unit, true, (min.min(value), max.max(value)));
    }

    /// Adds a linear slider. The range is extended to include the value.
    fn linear(&mut self, key: &str, value: f64, unit: &'static str, (min, max): (f64, f64)) {
        self.push(key, value, unit, false, (min.min(value), max.max(value)));
    }

    fn push(
        &mut self,
        key: &str,
        value: f64,
        unit: &'static str,
        log: bool,
        (min, max): (f64, f64),
    ) {
        let applies = if applies_at_once(key) { "at once" } else { "at reset" };
        let (key, unit, applies) = (key.to_owned(), unit.to_owned(), applies.to_owned());
        self.0.push(Parameter { key, value, unit, applies, log, min, max });
    }

    /// Adds the components of a vector as `key.0`, `key.1` and `key.2`, each from -max to max.
    fn vector(&mut self, key: &str, value: DVec3, unit: &'static str, max: f64) {
        for (axis, component) in value.to_array().into_iter().enumerate() {
            self.linear(&format!("{key}.{axis}"), component, unit, (-max, max));
        }
    }

    /// Adds the contact parameters that a table of the scene sets.
    fn material(&mut self, table: &str, material: &MaterialOverride) {
        if let Some(k) = material.collision_stiffness {
            self.log(&format!("{table}.collision_stiffness"), k, "N/m", (1e2, 1e7));
        }
        if let Some(k) = material.collision_stiffness_per_area {
            self.log(&format!("{table}.collision_stiffness_per_area"), k, "N/m³", (1e4, 1e10));
        }
        match material.damping {
            Some(Damping::Restitution(e)) => {
                self.linear(&format!("{table}.restitution"), e, "", (0.01, 1.0));
            }
            Some(Damping::Dashpot(c)) => {
                self.linear(&format!("{table}.collision_damping"), c, "N·s/m", (0.0, 100.0));
            }
            None => {}
        }
        if let Some(mu) = material.friction_stiffness {
            self.linear(&format!("{table}.friction_stiffness"), mu, "", (0.0, 2.0));
        }
        if let Some(k) = material.friction_spring {
            self.log(&format!("{table}.friction_spring"), k, "N/m", (1e2, 1e7));
        }
        if let Some(c) = material.friction_damping {
            self.linear(&format!("{table}.friction_damping"), c, "N·s/m", (0.0, 100.0));
        }
    }

    /// Adds the initial state, scale, mass and contact parameters of a body.
    fn body(&mut self, table: &str, body: &BodyScene, is_joined: bool) {
        let key = |name: &str| format!("{table}.{name}");
        // what is left out follows from the joints
        let default = (!is_joined).then_some(DVec3::ZERO);
        if let Some(velocity) = body.initial_velocity.or(default) {
            self.vector(&key("initial_velocity"), velocity, "m/s", 20.0);
        }
        if let Some(spin) = body.initial_angular_velocity.or(default) {
            self.vector(&key("initial_angular_velocity"), spin, "rad/s", 200.0);
        }
        if let Some(position) = body.position {
            self.vector(&key("position"), position, "m", 2.0);
        }
        self.log(&key("scale"), body.scale, "", (0.05, 5.0));
        match body.mass {
            MassScene::Particle(mass) => {
                self.log(&key("particle_mass"), mass, "kg", (1e-3, 1e2));
            }
            MassScene::Total(mass) => self.log(&key("mass"), mass, "kg", (1e-3, 1e3)),
            MassScene::Density(density) => {
                self.log(&key("density"), density, "kg/m³", (1.0, 1e5));
            }
        }
        self.material(table, &body.material);
    }
}
