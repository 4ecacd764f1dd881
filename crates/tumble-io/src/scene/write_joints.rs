//! Writes joints and loads as TOML.

use toml::{Table, Value};
use tumble::{Joint, Load, LoadAxes, LoadCourse, Motor};

use super::description::{JointScene, Scene};
use super::write::{put, put_tables, vector};

/// Adds the joints and loads of a scene.
pub(super) fn put_joints_and_loads(top: &mut Table, scene: &Scene) {
    if let Some(gravity) = &scene.central_gravity {
        let mut table = Table::new();
        put(&mut table, "gm", gravity.gm);
        put(&mut table, "at", vector(gravity.at));
        put(top, "central_gravity", table);
    }
    let joints = scene.joints.iter().map(|own| Value::Table(joint(own)));
    put_tables(top, "joint", joints.collect());
    put_tables(top, "load", scene.loads.iter().map(|own| Value::Table(load(own))).collect());
}

fn joint(JointScene { joint, chain }: &JointScene) -> Table {
    let Joint { name, kind, between, at, axis, limits, motor, length, contact, .. } = joint;
    let mut table = Table::new();
    put(&mut table, "name", name.clone().unwrap_or_default());
    put(&mut table, "kind", kind.name());
    if let Some(chain) = chain {
        put(&mut table, "chain", chain.clone());
    } else {
        let name = |name: &Option<String>| Value::from(name.as_deref().unwrap_or("world"));
        put(&mut table, "between", between.iter().map(name).collect::<Vec<_>>());
        let at =
            if kind.has_length() { Value::from(at.map(vector).to_vec()) } else { vector(at[0]) };
        put(&mut table, "at", at);
    }
    if kind.has_axis() {
        put(&mut table, "axis", vector(*axis));
    }
    if let Some(limits) = limits {
        put(&mut table, "limits", limits.to_vec());
    }
    if let Some(motor) = motor {
        put(&mut table, "motor", motor_table(motor));
    }
    for (key, value) in [
        ("friction", joint.friction),
        ("stiffness", joint.stiffness),
        ("rest", joint.rest),
        ("damping", joint.damping),
    ] {
        if value != 0.0 {
            put(&mut table, key, value);
        }
    }
    if let Some(length) = length {
        put(&mut table, "length", *length);
    }
    if let Some(until) = joint.until {
        put(&mut table, "until", until);
    }
    put(&mut table, "contact", *contact);
    table
}

fn motor_table(motor: &Motor) -> Table {
    let mut table = Table::new();
    let effort = match *motor {
        Motor::Speed { speed, effort } => {
            put(&mut table, "speed", speed);
            effort
        }
        Motor::Position { target, stiffness, damping, effort } => {
            put(&mut table, "target", target);
            put(&mut table, "stiffness", stiffness);
            put(&mut table, "damping", damping);
            effort
        }
    };
    put(&mut table, "effort", effort);
    table
}

fn load(load: &Load) -> Table {
    let mut table = Table::new();
    put(&mut table, "body", load.body.clone());
    if !matches!(load.course, LoadCourse::Table(_)) {
        put(&mut table, "force", vector(load.force));
    }
    put(&mut table, "torque", vector(load.torque));
    put(&mut table, "at", vector(load.at));
    put(&mut table, "axes", if load.axes == LoadAxes::Body { "body" } else { "world" });
    match &load.course {
        LoadCourse::Constant => {}
        LoadCourse::Periodic { frequency, phase } => {
            put(&mut table, "frequency", *frequency);
            put(&mut table, "phase", *phase);
        }
        LoadCourse::Table(rows) => {
            let row = |(t, f): &(f64, tumble::DVec3)| Value::from(vec![*t, f.x, f.y, f.z]);
            put(&mut table, "table", rows.iter().map(row).collect::<Vec<_>>());
        }
    }
    table
}
