//! From a description to a world: every value is checked here, once.

mod kinds;
mod twins;

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use self::kinds::Kinds;
use self::twins::Twins;
use crate::surface::Solids;
use crate::{
    BodyModel, BodyState, BuildError, BuildErrors, ContactLaw, Damping, DragModes, Integrator,
    Material, MaterialOverride, Model, Motion, Overlaps, PairMaterial, Prescribed, Shape, State,
    Surface, WallBox, WallPlane, World, critical_dt,
};

/// A body as a user describes it.
#[derive(Clone, Debug)]
pub struct Body {
    name: Option<String>,
    shape: Arc<Shape>,
    mass: Mass,
    position: Option<DVec3>,
    orientation: DQuat,
    velocity: DVec3,
    angular_velocity: DVec3,
    material: MaterialOverride,
    surface: Surface,
    motion: Motion,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mass {
    Total(f64),
    Particle(f64),
}

impl Body {
    /// A body of this shape, at rest where its particles were given, with 1 kg in each particle.
    pub fn new(shape: impl Into<Arc<Shape>>) -> Self {
        Self {
            name: None,
            shape: shape.into(),
            mass: Mass::Particle(1.0),
            position: None,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            material: MaterialOverride::default(),
            surface: Surface::None,
            motion: Motion::Free,
        }
    }

    /// Its name; without one it is called `body` and its number.
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// Mass m of each particle (kg): M = N m.
    pub fn particle_mass(mut self, mass: f64) -> Self {
        self.mass = Mass::Particle(mass);
        self
    }

    /// Total mass M (kg).
    pub fn mass(mut self, mass: f64) -> Self {
        self.mass = Mass::Total(mass);
        self
    }

    /// Where its centre of mass starts (m).
    pub fn position(mut self, position: DVec3) -> Self {
        self.position = Some(position);
        self
    }

    /// How it is turned at the start, about its centre of mass. Need not be of unit length.
    pub fn orientation(mut self, orientation: DQuat) -> Self {
        self.orientation = orientation;
        self
    }

    /// Velocity v of its centre of mass at the start (m/s).
    pub fn velocity(mut self, velocity: DVec3) -> Self {
        self.velocity = velocity;
        self
    }

    /// Angular velocity ω at the start, world axes (rad/s).
    pub fn angular_velocity(mut self, angular_velocity: DVec3) -> Self {
        self.angular_velocity = angular_velocity;
        self
    }

    /// The material of its contacts, where it is not the world's.
    pub fn material(mut self, material: MaterialOverride) -> Self {
        self.material = material;
        self
    }

    /// What other bodies meet of it; nothing unless said.
    pub fn surface(mut self, surface: Surface) -> Self {
        self.surface = surface;
        self
    }

    /// What moves it; forces unless said.
    pub fn motion(mut self, motion: Motion) -> Self {
        self.motion = motion;
        self
    }
}

/// What bodies share.
#[derive(Default)]
struct Shared<'a> {
    solids: Solids,
    twins: Twins,
    kinds: Kinds<'a>,
}

/// A world as a user describes it; [`WorldBuilder::build`] checks it.
#[derive(Clone, Debug)]
pub struct WorldBuilder {
    gravity: DVec3,
    velocity_damping_stiffness: f64,
    dt: f64,
    integrator: Integrator,
    energy_tolerance: Option<f64>,
    force: bool,
    material: Material,
    overlaps: Overlaps,
    walls: Vec<(WallPlane, MaterialOverride)>,
    bodies: Vec<Body>,
}

impl Default for WorldBuilder {
    /// The basic system's gravity and step, in free space.
    fn default() -> Self {
        Self {
            gravity: DVec3::new(0.0, -9.8, 0.0),
            velocity_damping_stiffness: 0.0,
            dt: 1e-3,
            integrator: Integrator::default(),
            energy_tolerance: None,
            force: false,
            material: Material::default(),
            overlaps: Overlaps::default(),
            walls: Vec::new(),
            bodies: Vec::new(),
        }
    }
}

impl WorldBuilder {
    /// Gravity g (m/s²); (0, −9.8, 0) unless said.
    pub fn gravity(mut self, gravity: DVec3) -> Self {
        self.gravity = gravity;
        self
    }

    /// Drag c of the medium on every particle, F = −c v (N·s/m); 0 unless said.
    pub fn velocity_damping_stiffness(mut self, c: f64) -> Self {
        self.velocity_damping_stiffness = c;
        self
    }

    /// Time step h (s); 1e-3 unless said.
    pub fn dt(mut self, dt: f64) -> Self {
        self.dt = dt;
        self
    }

    /// How a step advances time.
    pub fn integrator(mut self, integrator: Integrator) -> Self {
        self.integrator = integrator;
        self
    }

    /// Refine steps in contact until the energy that a part of them leaves unaccounted for is below
    /// this part of the energy in play. Costs more the smaller it is; `None` refines nothing.
    pub fn energy_tolerance(mut self, tolerance: impl Into<Option<f64>>) -> Self {
        self.energy_tolerance = tolerance.into();
        self
    }

    /// Builds even with a step above the critical one.
    pub fn force(mut self, force: bool) -> Self {
        self.force = force;
        self
    }

    /// The material of contacts for which neither wall nor body has its own.
    pub fn material(mut self, material: Material) -> Self {
        self.material = material;
        self
    }

    /// What is done about bodies that start in each other; they are refused unless said.
    pub fn overlaps(mut self, overlaps: Overlaps) -> Self {
        self.overlaps = overlaps;
        self
    }

    /// Adds a wall.
    pub fn wall(self, wall: WallPlane) -> Self {
        self.wall_of(wall, MaterialOverride::default())
    }

    /// Adds a wall of its own material.
    pub fn wall_of(mut self, wall: WallPlane, material: MaterialOverride) -> Self {
        self.walls.push((wall, material));
        self
    }

    /// Adds the walls of a box.
    pub fn walls_of_box(self, walls: &WallBox) -> Self {
        walls.planes().into_iter().fold(self, Self::wall)
    }

    /// Adds a body.
    pub fn body(mut self, body: Body) -> Self {
        self.bodies.push(body);
        self
    }

    /// Checks everything and starts the world at t = 0.
    ///
    /// # Errors
    /// [`BuildErrors`] names every quantity that cannot work and says what is allowed.
    pub fn build(self) -> Result<World, BuildErrors> {
        let mut errors = Vec::new();
        self.check_world(&mut errors);
        let mut model = Model {
            gravity: self.gravity,
            velocity_damping_stiffness: self.velocity_damping_stiffness,
            dt: self.dt,
            integrator: self.integrator,
            energy_tolerance: self.energy_tolerance,
            walls: self.walls.iter().map(|(wall, _)| *wall).collect(),
            wall_gap: smallest_gap(&self.walls),
            has_body_contact: self.bodies.iter().any(|body| body.surface != Surface::None),
            bodies: Vec::with_capacity(self.bodies.len()),
            names: Vec::with_capacity(self.bodies.len()),
        };
        let (mut state, mut shared) = (State::default(), Shared::default());
        for (index, body) in self.bodies.iter().enumerate() {
            let name = body.name.clone().unwrap_or_else(|| format!("body {index}"));
            match self.start(&model, &name, body, &mut shared) {
                Ok((body_model, body_state)) => {
                    model.bodies.push(body_model);
                    model.names.push(name);
                    state.bodies.push(body_state);
                    state.springs.push(Vec::new());
                }
                Err(error) => errors.push(error),
            }
        }
        errors.extend(same_names(&model));
        if errors.is_empty() && model.has_body_contact && self.overlaps == Overlaps::Push {
            crate::contact::initial_overlap::separate(&model, &mut state);
        }
        errors.extend(overlaps(&model, &state));
        errors.extend(critical_dt(&model).filter(|c| self.dt > c.dt && !self.force).map(
            |critical| BuildError::Unstable {
                dt: self.dt,
                critical: critical.dt,
                body: critical.body,
            },
        ));
        if errors.is_empty() { Ok(World::of(model, state)) } else { Err(BuildErrors(errors)) }
    }

    fn check_world(&self, errors: &mut Vec<BuildError>) {
        let mut check = |quantity, ok: bool, value: &dyn std::fmt::Display, allowed| {
            if !ok {
                errors.push(BuildError::World { quantity, value: value.to_string(), allowed });
            }
        };
        let c = self.velocity_damping_stiffness;
        check("dt", self.dt > 0.0 && self.dt.is_finite(), &self.dt, "a number of seconds above 0");
        check("gravity", self.gravity.is_finite(), &self.gravity, "three finite numbers (m/s²)");
        let allowed = "a number of N·s/m, 0 or more";
        check("velocity_damping_stiffness", c >= 0.0 && c.is_finite(), &c, allowed);
        let overrides = self.walls.iter().map(|(_, material)| *material);
        let overrides = overrides.chain(self.bodies.iter().map(|body| body.material));
        let materials = overrides.map(|own| own.over(self.material)).chain([self.material]);
        for material in materials {
            check_material(&material, &mut check);
        }
        if let Some(tolerance) = self.energy_tolerance {
            let ok = tolerance > 0.0 && tolerance < 1.0;
            check("energy_tolerance", ok, &tolerance, "above 0 and below 1");
            let refines = self.integrator == Integrator::Splitting;
            let allowed =
                "left out with the integrator \"euler\": only \"splitting\" refines its steps";
            check("energy_tolerance", refines, &tolerance, allowed);
            let alone = self.bodies.iter().all(|body| body.surface == Surface::None);
            let allowed = "left out where bodies meet each other: it refines the steps of each body by itself";
            check("energy_tolerance", alone, &tolerance, allowed);
        }
    }

    /// One body at t = 0, checked.
    fn start<'a>(
        &self,
        model: &Model,
        name: &str,
        body: &'a Body,
        shared: &mut Shared<'a>,
    ) -> Result<(Arc<BodyModel>, BodyState), BuildError> {
        let body_model = match shared.kinds.find(body) {
            Some(known) => known,
            None => {
                let made = Arc::new(self.body_model(name, body, shared)?);
                shared.kinds.keep(body, &made);
                made
            }
        };
        let body_state = body_state(&body_model, name, body)?;
        check_inside(model, &body_model, name, &body_state)?;
        Ok((body_model, body_state))
    }

    /// The materials of all that a body may touch, walls first.
    fn materials(&self, body: &Body) -> (Vec<Material>, Option<Material>) {
        let wall = |(_, wall): &(_, MaterialOverride)| self.material.between(*wall, body.material);
        // what other bodies bring along is not known yet
        let meets = body.surface != Surface::None;
        let own = meets.then(|| body.material.over(self.material));
        (self.walls.iter().map(wall).collect(), own)
    }

    fn body_model(
        &self,
        name: &str,
        body: &Body,
        shared: &mut Shared,
    ) -> Result<BodyModel, BuildError> {
        let refuse = |quantity, value, allowed| BuildError::Body {
            body: name.to_owned(),
            quantity,
            value,
            allowed,
        };
        if let Some((quantity, value, allowed)) = check_body(body, self.dt) {
            return Err(refuse(quantity, value, allowed));
        }
        let (quantity, value, mass) = match body.mass {
            Mass::Total(mass) => ("mass", mass, mass),
            Mass::Particle(mass) => {
                ("particle_mass", mass, mass * body.shape.particles().len() as f64)
            }
        };
        let signed_distance = shared.solids.of(name, &body.shape, body.surface)?;
        let inertia = body.shape.gyration() * mass;
        let inverse_inertia = body.shape.principal().inverse() * (1.0 / mass);
        let fits = inertia.is_finite() && inverse_inertia.is_finite();
        if !(mass > 0.0 && mass.is_finite() && value.is_finite() && fits) {
            let allowed = "a number of kg above 0, such that the inertia is finite";
            return Err(refuse(quantity, value.to_string(), allowed));
        }
        let (is_free, has_spheres) =
            (body.motion == Motion::Free, matches!(body.surface, Surface::Spheres { .. }));
        // a body of spheres touches with one of them at a time
        let particle_mass = if has_spheres { mass } else { mass / body.shape.moments().count };
        let (walls, own) = self.materials(body);
        let per_area = |material: &Material| material.collision_stiffness_per_area;
        let shape = match walls.iter().chain(&own).find_map(per_area) {
            Some(stiffness) if has_spheres => {
                let allowed = "left out where a body has spheres, which touch at points: give it a \
                               `collision_stiffness` of its own";
                return Err(refuse("collision_stiffness_per_area", stiffness.to_string(), allowed));
            }
            Some(stiffness) => shared.twins.of(&body.shape).map_err(|error| {
                refuse("collision_stiffness_per_area", stiffness.to_string(), error.allowed())
            })?,
            None => Arc::clone(&body.shape),
        };
        let area = shape.mean_area().unwrap_or_default();
        let law = |material: Material| material.at_area(area).law(particle_mass);
        let contacts: Vec<_> = walls.into_iter().map(law).collect();
        let moments = body.shape.principal().moments * mass;
        let inverse_moments = moments.to_array().map(|m| if m > 0.0 { 1.0 / m } else { 0.0 });
        Ok(BodyModel {
            shape,
            mass,
            inertia,
            inverse_inertia,
            inverse_moments: DVec3::from_array(inverse_moments),
            drag_modes: DragModes::of(&body.shape, mass).map(Box::new),
            pair_material: PairMaterial::new(
                &body.material.over(self.material).at_area(area),
                if is_free { 1.0 / mass } else { 0.0 },
                if has_spheres { 1.0 } else { body.shape.moments().count },
            ),
            extent: extent(&body.shape, body.surface),
            has_friction: contacts.iter().any(|law| law.friction > 0.0),
            is_damped: contacts.iter().any(ContactLaw::is_damped),
            contacts,
            surface: body.surface,
            signed_distance,
            motion: body.motion,
        })
    }
}

/// How far particles, spheres and mesh reach from the centre of mass (m), whatever rounding does.
fn extent(shape: &Shape, surface: Surface) -> f64 {
    let reach = match surface {
        Surface::None => shape.radius(),
        Surface::Spheres { radius } => shape.radius() + radius,
        Surface::Mesh => {
            let vertices = shape.surface().vertices.iter();
            vertices.fold(shape.radius(), |reach, vertex| reach.max(vertex.length()))
        }
    };
    reach * (1.0 + 1e-9)
}

/// Bodies that start in each other, deeper than contact alone could press them.
fn overlaps(model: &Model, state: &State) -> Vec<BuildError> {
    let name = |index: u32| model.names[index as usize].clone();
    let pairs = crate::contact::initial_overlap::overlaps(model, state).into_iter();
    pairs
        .map(|(first, second, depth)| BuildError::Overlap {
            first: name(first),
            second: name(second),
            depth,
        })
        .collect()
}

/// The smallest distance between two walls that face each other with room between them (m).
fn smallest_gap(walls: &[(WallPlane, MaterialOverride)]) -> Option<f64> {
    let pairs = walls.iter().flat_map(|(a, _)| walls.iter().map(move |(b, _)| (a, b)));
    let facing = pairs.filter(|(a, b)| a.normal.dot(b.normal) < -1.0 + 1e-9);
    facing.map(|(a, b)| -(a.offset + b.offset)).filter(|&gap| gap > 0.0).min_by(f64::total_cmp)
}

/// Numbers of the bodies' surfaces and motions.
fn check_body(body: &Body, dt: f64) -> Option<(&'static str, String, &'static str)> {
    if let Surface::Spheres { radius } = body.surface
        && !(radius > 0.0 && radius.is_finite())
    {
        return Some(("particle_radius", radius.to_string(), "a number of m above 0"));
    }
    let Motion::Prescribed(given) = &body.motion else { return None };
    let three = "three finite numbers";
    if !given.surface_velocity.is_finite() {
        return Some(("surface_velocity", given.surface_velocity.to_string(), three));
    }
    let swing = given.oscillation.as_ref()?;
    if !(swing.amplitude.is_finite() && swing.frequency.is_finite() && swing.phase.is_finite()) {
        let allowed = "a finite amplitude (m), frequency (Hz) and phase (rad)";
        return Some(("oscillation", format!("{swing:?}"), allowed));
    }
    if swing.frequency.abs() * dt > 0.1 {
        let allowed = "of a frequency that gives a swing at least ten steps of `dt`";
        return Some(("oscillation", format!("of {} Hz", swing.frequency), allowed));
    }
    None
}

fn check_material(
    material: &Material,
    check: &mut impl FnMut(&'static str, bool, &dyn std::fmt::Display, &'static str),
) {
    let mut number = |name, value: f64, allowed| {
        check(name, value >= 0.0 && value.is_finite(), &value, allowed);
    };
    number("collision_stiffness", material.collision_stiffness, "a number of N/m, 0 or more");
    if let Some(stiffness) = material.collision_stiffness_per_area {
        number("collision_stiffness_per_area", stiffness, "a number of N/m³, 0 or more");
    }
    number("friction_stiffness", material.friction_stiffness, "a number, 0 or more");
    if let Some(spring) = material.friction_spring {
        number("friction_spring", spring, "a number of N/m, 0 or more");
    }
    if let Some(damping) = material.friction_damping {
        number("friction_damping", damping, "a number of N·s/m, 0 or more");
    }
    match material.damping {
        Damping::Dashpot(c) => number("collision_damping", c, "a number of N·s/m, 0 or more"),
        Damping::Restitution(e) => {
            check("restitution", e > 0.0 && e <= 1.0, &e, "above 0, up to 1");
        }
    }
}

/// Where a body starts; L = R I₀ Rᵀ ω.
fn body_state(model: &BodyModel, name: &str, body: &Body) -> Result<BodyState, BuildError> {
    let refuse = |quantity, value: &dyn std::fmt::Display, allowed| {
        Err(BuildError::Body { body: name.to_owned(), quantity, value: value.to_string(), allowed })
    };
    let position = body.position.unwrap_or(body.shape.centre());
    let three = "three finite numbers";
    if !position.is_finite() {
        return refuse("position", &position, three);
    }
    if !body.velocity.is_finite() {
        return refuse("initial_velocity", &body.velocity, three);
    }
    let q = body.orientation;
    let largest = q.to_array().iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if !(q.is_finite() && largest > 0.0) {
        return refuse("orientation", &q, "four finite numbers w, x, y, z, not all 0");
    }
    let orientation = if q.is_normalized() { q } else { (q / largest).normalize() };
    let rotation = DMat3::from_quat(orientation);
    let angular_momentum =
        rotation * (model.inertia * (rotation.transpose() * body.angular_velocity));
    if !angular_momentum.is_finite() {
        return refuse("initial_angular_velocity", &body.angular_velocity, three);
    }
    // what moves by forces is let off: nothing turns it about such an axis
    let lost = model.angular_velocity(rotation, angular_momentum) - body.angular_velocity;
    if !model.is_free() && lost.length() > 1e-9 * body.angular_velocity.length() {
        let allowed =
            "about an axis about which the body has inertia; mass_model = \"solid\" gives it some";
        return refuse("initial_angular_velocity", &body.angular_velocity, allowed);
    }
    let swing = match &body.motion {
        Motion::Prescribed(Prescribed { oscillation: Some(swing), .. }) => swing.at(0.0).1,
        _ => DVec3::ZERO,
    };
    let velocity = body.velocity + swing;
    if !velocity.is_finite() {
        return refuse("oscillation", &swing, "no faster than a double can hold");
    }
    Ok(BodyState { position, velocity, orientation, angular_momentum, ..BodyState::default() })
}

/// A body that starts with its centre of mass behind a wall, deeper than ten times the depth at
/// which the springs of its particles carry its weight, was put there by mistake.
fn check_inside(
    model: &Model,
    body: &BodyModel,
    name: &str,
    state: &BodyState,
) -> Result<(), BuildError> {
    for (wall, law) in model.walls.iter().zip(&body.contacts) {
        let depth = wall.depth(state.position);
        let sag = body.particle_mass() * model.gravity.length() / law.stiffness;
        if depth > 10.0 * sag {
            let normal = wall.normal.to_array();
            return Err(BuildError::Outside { body: name.to_owned(), normal, depth });
        }
    }
    Ok(())
}

fn same_names(model: &Model) -> Vec<BuildError> {
    let mut names: Vec<_> = model.names.iter().collect();
    names.sort_unstable();
    let mut twice: Vec<_> =
        names.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
    twice.dedup();
    twice.into_iter().map(|name| BuildError::SameName { body: name.clone() }).collect()
}
