//! Joints, from their descriptions.

use glam::DVec3;

use super::description::WorldBuilder;
use crate::joint::{JointVelocities, Place};
use crate::{
    BuildError, Integrator, Joint, JointKind, JointModel, JointState, Joints, Model, Motor, State,
};

/// What is wrong with a joint: the quantity, its value, and what is allowed.
type Fault = (&'static str, String, &'static str);

/// Two points at a joint meet up to this part of their distance from the origin.
const MEETS: f64 = 1e-9;

impl WorldBuilder {
    /// Adds the joints to the model and the state.
    pub(super) fn add_joints(
        &self,
        model: &mut Model,
        state: &mut State,
        errors: &mut Vec<BuildError>,
    ) {
        // a body that is refused has no index
        if !errors.is_empty() {
            return;
        }
        let mut list = Vec::with_capacity(self.joints.len());
        for (index, joint) in self.joints.iter().enumerate() {
            let name = joint.name.clone().unwrap_or_else(|| format!("joint {index}"));
            match joint_model(joint, name.clone(), (self.integrator, model), state) {
                Ok(joint) => list.push(joint),
                Err((quantity, value, allowed)) => {
                    errors.push(BuildError::Joint { joint: name, quantity, value, allowed });
                }
            }
        }
        let mut names: Vec<_> = list.iter().map(|joint: &JointModel| &joint.name).collect();
        names.sort_unstable();
        if let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            let joint = twice[0].clone();
            let allowed = "different from those of other joints";
            errors.push(BuildError::Joint {
                joint: joint.clone(),
                quantity: "name",
                value: joint,
                allowed,
            });
        }
        model.joints = Joints::new(list, &model.bodies);
        state.joints = vec![JointState::default(); model.joints.list.len()];
        model.joints.has_redundant = crate::joint::redundant_constraints(model, state) > 0;
        if errors.is_empty() {
            self.set_joined_velocities(model, state, errors);
        }
    }

    /// Lets velocities that are left out follow from the joints, and checks that all of them fit.
    fn set_joined_velocities(
        &self,
        model: &Model,
        state: &mut State,
        errors: &mut Vec<BuildError>,
    ) {
        if model.joints.is_empty() {
            return;
        }
        let is_given = |index: usize| {
            let body = &self.bodies[index];
            [body.velocity.is_some(), body.angular_velocity.is_some()]
        };
        let mut velocities = JointVelocities::new(model, state);
        velocities.follow(|index| is_given(index)[0]);
        if velocities.misfit().is_some() {
            velocities.fit(|index| is_given(index).contains(&true));
        }
        match velocities.misfit() {
            None => velocities.apply(state),
            Some((joint, speed)) => errors.push(BuildError::Joint {
                joint: model.joints.list[joint].name.clone(),
                quantity: "initial_velocity",
                value: format!("such that the joint would come apart at {speed:.3e}"),
                allowed: "such that both bodies move together at the joint; where `initial_velocity` is left out it follows from the joints",
            }),
        }
    }
}

fn joint_model(
    joint: &Joint,
    name: String,
    (integrator, model): (Integrator, &Model),
    state: &State,
) -> Result<JointModel, Fault> {
    if !integrator.kicks() {
        let allowed = "\"splitting\" or \"implicit\" in scenes with joints";
        return Err(("integrator", format!("\"{}\"", integrator.name()), allowed));
    }
    check(joint)?;
    let mut bodies = [None; 2];
    let mut places = [Place::WORLD; 2];
    for side in 0..2 {
        let Some(wanted) = &joint.between[side] else { continue };
        let found = model.names.iter().position(|name| name == wanted);
        let Some(index) = found else {
            return Err(("between", format!("\"{wanted}\""), "names of bodies, or \"world\""));
        };
        bodies[side] = Some(index as u32);
        places[side] = Place::new(&state.bodies[index]);
    }
    if bodies[0] == bodies[1] {
        let name = joint.between[0].as_deref().unwrap_or("world");
        return Err(("between", format!("\"{name}\" twice"), "two different bodies"));
    }
    let is_free = |body: &u32| model.bodies[*body as usize].is_free();
    if !bodies.iter().flatten().any(is_free) {
        let allowed = "at least one body that moves by forces";
        return Err(("between", "two bodies that do not".to_owned(), allowed));
    }
    let joint = JointModel::new(joint, name, bodies, places);
    for (side, body) in bodies.iter().enumerate() {
        let Some(body) = body.map(|body| &model.bodies[body as usize]) else { continue };
        let is_away = joint.anchors[side].length() > MEETS * (1.0 + body.extent);
        if body.is_free()
            && body.inverse_moments == DVec3::ZERO
            && is_away
            && !joint.kind.has_length()
        {
            let allowed = "\"distance\" or \"rope\" for a body of one point away from the joint: without inertia it would not turn";
            return Err(("kind", format!("\"{}\"", joint.kind.name()), allowed));
        }
    }
    Ok(joint)
}

/// Checks all numbers of a joint.
fn check(joint: &Joint) -> Result<(), Fault> {
    let [first, second] = joint.at;
    let separation = (first - second).length();
    let size = 1.0f64.max(first.length());
    let kind = joint.kind;
    if !(first.is_finite() && second.is_finite()) {
        return Err(("at", format!("{first}, {second}"), "finite coordinates"));
    }
    if kind.has_length() && separation <= MEETS * size {
        return Err(("at", format!("{first}, {second}"), "two points at a distance"));
    }
    if !kind.has_length() && separation > MEETS * size {
        let allowed =
            "one point, or the same point twice: the bodies of this kind of joint meet there";
        return Err(("at", format!("{first}, {second}"), allowed));
    }
    if kind.has_axis() && !(joint.axis.is_finite() && joint.axis.length() > 0.0) {
        return Err(("axis", joint.axis.to_string(), "three finite numbers, not all 0"));
    }
    if let Some([low, high]) = joint.limits {
        let value = format!("[{low}, {high}]");
        if !(kind.has_axis() || matches!(kind, JointKind::Distance | JointKind::Spring)) {
            return Err(("limits", value, "left out: a joint of this kind has none"));
        }
        if !(low <= 0.0 && high >= 0.0 && low < high) {
            let allowed =
                "the smallest and the largest coordinate, with 0, that of the start, between them";
            return Err(("limits", value, allowed));
        }
    }
    if let Some(until) = joint.until {
        let is_spring = joint.stiffness > 0.0;
        if is_spring || until.is_nan() {
            let allowed = "a time (s) at which the joint lets go; joints with a spring do not";
            return Err(("until", until.to_string(), allowed));
        }
    }
    check_length(joint, separation)?;
    check_forces(joint)
}

fn check_length(joint: &Joint, separation: f64) -> Result<(), Fault> {
    let Some(length) = joint.length else { return Ok(()) };
    let refuse = |allowed| Err(("length", length.to_string(), allowed));
    match joint.kind {
        JointKind::Spring if !(length >= 0.0 && length.is_finite()) => {
            refuse("a number of m, 0 or more")
        }
        JointKind::Rope if !(length >= separation * (1.0 - MEETS) && length.is_finite()) => {
            refuse("at least the distance of the two points `at` the start")
        }
        JointKind::Distance if (length - separation).abs() > MEETS * separation => {
            refuse("the distance of the two points `at` the start, or left out")
        }
        JointKind::Spring | JointKind::Rope | JointKind::Distance => Ok(()),
        _ => refuse("left out: only \"distance\", \"rope\" and \"spring\" have a length"),
    }
}

fn check_forces(joint: &Joint) -> Result<(), Fault> {
    let Joint { kind, friction, stiffness, damping, .. } = *joint;
    for (quantity, value, is_possible) in [
        ("friction", friction, kind.has_axis()),
        ("rest", if joint.rest.is_finite() { joint.rest.abs() } else { f64::NAN }, kind.has_axis()),
        ("stiffness", stiffness, kind.has_axis() || kind == JointKind::Spring),
        ("damping", damping, kind.has_axis() || kind == JointKind::Spring),
    ] {
        if !(value >= 0.0 && value.is_finite()) {
            return Err((quantity, value.to_string(), "a number, 0 or more"));
        }
        if value > 0.0 && !is_possible {
            return Err((quantity, value.to_string(), "left out: a joint of this kind has none"));
        }
    }
    if kind == JointKind::Spring && stiffness == 0.0 && damping == 0.0 {
        return Err(("stiffness", "0".to_owned(), "a number of N/m above 0"));
    }
    let Some(motor) = joint.motor else { return Ok(()) };
    if !kind.has_axis() {
        return Err((
            "motor",
            "there".to_owned(),
            "left out: only \"hinge\" and \"slider\" have one",
        ));
    }
    let (is_valid, effort) = match motor {
        Motor::Speed { speed, effort } => (speed.is_finite(), effort),
        Motor::Position { target, stiffness, damping, effort } => {
            let forces = [stiffness, damping].iter().all(|x| *x >= 0.0 && x.is_finite());
            (target.is_finite() && forces && stiffness + damping > 0.0, effort)
        }
    };
    if !is_valid {
        let allowed = "a finite `speed`, or a finite `target` with `stiffness` and `damping` of 0 or more, not both 0";
        return Err(("motor", format!("{motor:?}"), allowed));
    }
    if effort.is_nan() || effort <= 0.0 {
        return Err(("motor.effort", effort.to_string(), "a number of N·m or N above 0"));
    }
    Ok(())
}

impl WorldBuilder {
    /// Adds the loads to the model.
    pub(super) fn add_loads(&self, model: &mut Model, errors: &mut Vec<BuildError>) {
        let body_of = |wanted: &str| -> Result<u32, Fault> {
            let found = model.names.iter().position(|name| name == wanted);
            let index = found.ok_or(("body", format!("\"{wanted}\""), "the name of a body"))?;
            if model.bodies[index].is_free() {
                Ok(index as u32)
            } else {
                Err(("body", format!("\"{wanted}\""), "a body that moves by forces"))
            }
        };
        if !errors.is_empty() {
            return;
        }
        let mut loads = model.loads.clone();
        let mut refuse = |load: usize, (quantity, value, allowed): Fault| {
            errors.push(BuildError::Load { load, quantity, value, allowed });
        };
        for (index, load) in self.loads.iter().enumerate() {
            match check_load(load).and_then(|()| body_of(&load.body)) {
                Ok(body) => loads.list.push((body, load.clone())),
                Err(fault) => refuse(index, fault),
            }
        }
        for (index, function) in self.force_functions.iter().enumerate() {
            match body_of(&function.body) {
                Ok(body) => loads.functions.push((body, function.clone())),
                Err(fault) => refuse(self.loads.len() + index, fault),
            }
        }
        loads.list.sort_by_key(|(body, _)| *body);
        loads.functions.sort_by_key(|(body, _)| *body);
        loads.central_gravity = self.central_gravity;
        if let Some(gravity) = &self.central_gravity
            && !(gravity.gm > 0.0 && gravity.gm.is_finite() && gravity.at.is_finite())
        {
            let allowed = "a `gm` above 0 (m³/s²) and a finite place `at`";
            let value = format!("{gravity:?}");
            errors.push(BuildError::World { quantity: "central_gravity", value, allowed });
        }
        if !loads.is_empty() && !self.integrator.kicks() {
            let value = format!("\"{}\"", self.integrator.name());
            let allowed = "\"splitting\" or \"implicit\" in scenes with loads";
            errors.push(BuildError::World { quantity: "integrator", value, allowed });
        }
        model.loads = loads;
    }
}

fn check_load(load: &crate::Load) -> Result<(), Fault> {
    let three = "three finite numbers";
    for (quantity, value) in [("force", load.force), ("torque", load.torque), ("at", load.at)] {
        if !DVec3::is_finite(value) {
            return Err((quantity, value.to_string(), three));
        }
    }
    match &load.course {
        crate::LoadCourse::Constant => Ok(()),
        crate::LoadCourse::Periodic { frequency, phase } => {
            if *frequency >= 0.0 && frequency.is_finite() && phase.is_finite() {
                Ok(())
            } else {
                let value = format!("{frequency} with phase {phase}");
                Err(("frequency", value, "a number of Hz, 0 or more, with a finite phase"))
            }
        }
        crate::LoadCourse::Table(rows) => {
            let rises = rows.windows(2).all(|pair| pair[0].0 < pair[1].0);
            let is_finite = rows.iter().all(|(time, force)| time.is_finite() && force.is_finite());
            if rises && is_finite && !rows.is_empty() {
                Ok(())
            } else {
                let value = format!("one of {} rows", rows.len());
                Err(("table", value, "rows [t, fx, fy, fz] of finite numbers whose times rise"))
            }
        }
    }
}
