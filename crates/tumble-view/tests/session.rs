//! The session of the viewer, without sockets and without a clock.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::time::Duration;

use tumble::DVec3;
use tumble_io::scene::{LoadOptions, Loaded, Source, load_builtin, load_text};
use tumble_view::{Command, Session, frame, header};

const SCENE: &str = "
dt = 1e-3
[collision]
collision_stiffness = 1e4
restitution = 0.6
friction_stiffness = 0.4
[box]
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[[body]]
name = \"one\"
shape = \"sphere\"
subdivisions = 1
position = [0.0, -0.8, 0.0]
initial_velocity = [1.0, 0.0, 0.5]
initial_angular_velocity = [1.0, 2.0, 3.0]
[[body]]
name = \"two\"
shape = \"box\"
position = [0.3, 0.2, 0.0]
copies = { count = [2, 1, 1], spacing = [0.6, 0, 0], seed = 3 }
";

fn loaded(text: &str) -> Loaded {
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    load_text("test", source, Path::new("."), &LoadOptions::default()).unwrap()
}

fn session() -> Session {
    Session::new(loaded(SCENE)).unwrap()
}

fn send(session: &mut Session, text: &str) -> Result<Option<String>, String> {
    session.execute(&Command::parse(text)?)
}

fn set(session: &mut Session, key: &str, value: &str) -> Result<(), String> {
    send(session, &format!("{{\"type\":\"set\",\"key\":\"{key}\",\"value\":{value}}}")).map(|_| ())
}

/// Takes this many single steps, then plays on unless the simulation has failed.
fn play(session: &mut Session, steps: u64) {
    send(session, "{\"type\":\"pause\"}").unwrap();
    for _ in 0..steps {
        send(session, "{\"type\":\"step\"}").unwrap();
    }
    if session.error().is_none() {
        send(session, "{\"type\":\"play\"}").unwrap();
    }
}

fn float(record: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(record[at..at + 8].try_into().unwrap())
}

/// The residual of the energy ledger (J).
fn residual(session: &Session) -> f64 {
    session.world().energy().total() - session.reference_energy()
}

#[test]
fn the_simulation_runs_at_the_chosen_speed() {
    let mut session = session();
    let always = &mut || true;
    assert_eq!(session.advance(always), 0);
    session.add_elapsed(Duration::from_micros(20_500));
    assert_eq!(session.advance(always), 20);
    // the rest of a step carries over
    session.add_elapsed(Duration::from_micros(600));
    assert_eq!(session.advance(always), 1);
    send(&mut session, "{\"type\":\"speed\",\"value\":0.1}").unwrap();
    session.add_elapsed(Duration::from_millis(55));
    assert_eq!(session.advance(always), 5);
    assert!((session.time_to_next_step().unwrap().as_secs_f64() - 0.005).abs() < 1e-9);
    send(&mut session, "{\"type\":\"speed\",\"value\":null}").unwrap();
    assert_eq!(session.time_to_next_step(), Some(Duration::ZERO));
    let mut calls = 0;
    let taken = session.advance(&mut || {
        calls += 1;
        calls < 3
    });
    assert!(taken >= 3, "{taken}");
    send(&mut session, "{\"type\":\"pause\"}").unwrap();
    session.add_elapsed(Duration::from_secs(1));
    assert_eq!((session.advance(always), session.time_to_next_step()), (0, None));
}

#[test]
fn a_long_backlog_is_dropped() {
    let mut session = session();
    session.add_elapsed(Duration::from_secs(3600));
    let steps = session.advance(&mut || true);
    assert!((99..=100).contains(&steps), "{steps}");
}

#[test]
fn a_live_simulation_has_the_same_states_as_a_run() {
    let mut session = session();
    play(&mut session, 500);
    let mut world = loaded(SCENE).world;
    (0..500).for_each(|_| world.step().unwrap());
    assert_eq!(session.world().state().hash(), world.state().hash());
}

#[test]
fn a_single_step_requires_a_pause() {
    let mut session = session();
    assert!(send(&mut session, "{\"type\":\"step\"}").unwrap_err().contains("paused"));
    send(&mut session, "{\"type\":\"pause\"}").unwrap();
    send(&mut session, "{\"type\":\"step\"}").unwrap();
    assert_eq!(session.world().state().step, 1);
}

#[test]
fn an_edit_that_applies_at_once_does_not_change_the_residual() {
    let mut session = session();
    play(&mut session, 300);
    for (key, value) in [
        ("collision.collision_stiffness", "20000"),
        ("collision.restitution", "0.3"),
        ("collision.friction_stiffness", "0.1"),
        ("collision.collision_damping", "5"),
        ("collision.restitution", "0.9"),
        ("velocity_damping_stiffness", "0.01"),
        ("gravity.1", "-1.62"),
        ("gravity", "[0, -3.7, 0]"),
        ("energy_tolerance", "1e-6"),
        ("energy_tolerance", "null"),
        ("integrator", "\"euler\""),
        ("integrator", "\"splitting\""),
        ("box.max", "[1.0, 1.5, 1.0]"),
        ("box.open", "[\"+y\"]"),
        ("body.collision_stiffness", "3e4"),
        ("body.1.friction_stiffness", "0.9"),
    ] {
        let before = (residual(&session), session.revision(), session.world().state().clone());
        set(&mut session, key, value).unwrap_or_else(|error| panic!("{key} = {value}: {error}"));
        let after = (residual(&session), session.world().state());
        assert!((after.0 - before.0).abs() < 1e-9, "{key}: {} {}", before.0, after.0);
        // an integrator brings its step along, and time goes on at a multiple of it
        if key != "integrator" {
            assert_eq!((after.1.step, after.1.time), (before.2.step, before.2.time), "{key}");
        }
        assert_eq!(after.1.bodies.len(), before.2.bodies.len());
        assert!(session.revision() > before.1, "{key}");
        assert!(session.pending().is_empty(), "{key}");
        play(&mut session, 20);
    }
    let model = session.world().model();
    assert_eq!(model.gravity.y, -3.7);
    assert_eq!(model.walls.len(), 5);
    assert_eq!(model.bodies[2].contacts[0].friction, 0.9);
    assert_eq!(session.error(), None);
}

#[test]
fn a_change_of_dt_moves_time_to_the_next_whole_step() {
    let mut session = session();
    play(&mut session, 100);
    set(&mut session, "dt", "3e-4").unwrap();
    let state = session.world().state();
    assert_eq!((state.step, state.time), (334, 334.0 * 3e-4));
    play(&mut session, 1);
    assert_eq!(session.error(), None);
    // the step number would not be exact as a double
    assert!(set(&mut session, "dt", "1e-300").is_err());
    assert_eq!(session.world().dt(), 3e-4);
}

/// Two balls on a floor with friction, one on the other, from each integrator to each other.
#[test]
fn a_change_of_the_integrator_takes_its_step_along_and_goes_on_from_the_present_state() {
    const SCENE: &str = r#"
        [collision]
        collision_stiffness = 2e4
        restitution = 0.5
        friction_stiffness = 0.5
        [[wall]]
        normal = [0, 1, 0]
        [[body]]
        name = "ball"
        particles = [[0, 0, 0]]
        particle_radius = 0.1
        mass_model = "solid"
        mass = 1
        position = [0, 0.2, 0]
        initial_velocity = [0.3, 0, 0]
        copies = { count = [1, 2, 1], spacing = [1, 0.201, 1] }
    "#;
    let mut session = Session::new(loaded(SCENE)).unwrap();
    for name in ["implicit", "splitting", "implicit", "euler", "splitting", "euler", "implicit"] {
        play(&mut session, 300);
        let (before, residual_before) = (session.world().state().clone(), residual(&session));
        let header: serde_json::Value = serde_json::from_str(&header::json(&session)).unwrap();
        let choices = header["integrators"].as_array().unwrap();
        let choice = choices.iter().find(|choice| choice["name"] == name).unwrap();
        set(&mut session, "integrator", &format!("\"{name}\"")).unwrap();
        assert_eq!(session.world().model().integrator.name(), name);
        assert_eq!(session.world().dt(), choice["dt"].as_f64().unwrap());
        assert_eq!(session.world().state().bodies, before.bodies);
        assert!((residual(&session) - residual_before).abs() < 1e-9);
        assert!(session.pending().is_empty());
    }
    // steps of implicit contacts can be changed too, and so can their friction
    play(&mut session, 300);
    for (key, value) in [("dt", "1e-4"), ("collision.friction_stiffness", "0.1"), ("dt", "0.01")] {
        set(&mut session, key, value).unwrap();
        play(&mut session, 20);
    }
    assert_eq!(session.error(), None);
    let heights = [0, 1].map(|ball| session.world().body(ball).position().y);
    assert!(heights.iter().all(|&y| y > 0.09 && y < 0.32), "{heights:?}");
}

#[test]
fn a_scene_with_an_energy_tolerance_has_one_integrator() {
    let session =
        Session::new(loaded("energy_tolerance = 1e-6\n[[body]]\nshape = \"sphere\"\n")).unwrap();
    let header: serde_json::Value = serde_json::from_str(&header::json(&session)).unwrap();
    let names: Vec<_> =
        header["integrators"].as_array().unwrap().iter().map(|c| &c["name"]).collect();
    assert_eq!(names, ["splitting"]);
}

#[test]
fn an_invalid_edit_is_refused_with_the_readers_message_and_changes_nothing() {
    let mut session = session();
    play(&mut session, 50);
    let before = (session.scene().to_toml(), session.world().state().clone(), session.revision());
    for (key, value, expected) in [
        ("collision.collision_stiffness", "-1", "collision_stiffness"),
        ("dt", "0.5", "stable only up to"),
        ("dt", "0", "`dt`"),
        ("dt", "\"x\"", "must be"),
        ("integrator", "\"splittin\"", "splitting"),
        ("gravty", "1", "not a known key"),
        ("gravity.7", "1", "counted from 0"),
        ("collision.restitution", "1.5", "restitution"),
        ("body.9.scale", "1", "counted from 0"),
        ("body.0.scale", "0", "scale"),
        ("body.0.position", "[0, -7, 0]", "outside"),
        ("body", "[]", "no body"),
        ("box.min", "[-1, 0, -1]", "`box.min`|outside|behind"),
        ("energy_tolerance", "null", "not set"),
        ("wall", "3", "must be"),
        ("body.1.copies.count", "[100, 100, 100]", "at most"),
        ("body.1.copies.count", "[2, 100, 110]", "shows at most"),
    ] {
        let error = set(&mut session, key, value).unwrap_err();
        assert!(expected.split('|').any(|part| error.contains(part)), "{key} = {value}: {error}");
        assert!(!error.contains("-->"), "{error}");
    }
    let after = (session.scene().to_toml(), session.world().state().clone(), session.revision());
    assert_eq!(before, after);
    assert_eq!(session.next_scene().to_toml(), before.0);
}

#[test]
fn edits_of_shape_mass_and_initial_state_wait_for_a_reset() {
    let mut session = session();
    play(&mut session, 50);
    set(&mut session, "body.0.scale", "0.5").unwrap();
    set(&mut session, "overlaps", "\"push\"").unwrap();
    set(&mut session, "body.0.initial_velocity.0", "2.5").unwrap();
    set(&mut session, "body.1.copies.count", "[3, 1, 1]").unwrap();
    set(&mut session, "body.0.mass", "7").unwrap();
    assert_eq!(session.pending().len(), 4);
    assert_eq!(session.world().body_count(), 3);
    // an edit that applies at once leaves them pending
    set(&mut session, "gravity.1", "-2").unwrap();
    assert_eq!(session.world().model().gravity.y, -2.0);
    assert_eq!(session.world().body_count(), 3);
    send(&mut session, "{\"type\":\"reset\"}").unwrap();
    assert!(session.pending().is_empty());
    let world = session.world();
    assert_eq!((world.time(), world.body_count(), world.model().gravity.y), (0.0, 4, -2.0));
    assert_eq!((world.body(0).velocity().x, world.body(0).model().mass), (2.5, 7.0));
    assert_eq!(residual(&session), 0.0);
}

#[test]
fn a_failed_simulation_reports_its_error_and_a_reset_recovers_from_it() {
    let text =
        SCENE.replace("initial_velocity = [1.0, 0.0, 0.5]", "initial_velocity = [0, -3e4, 0]");
    let mut session = Session::new(loaded(&text)).unwrap();
    session.add_elapsed(Duration::from_secs(1));
    session.advance(&mut || true);
    assert!(session.error().unwrap().contains("diverged"), "{:?}", session.error());
    assert!(!session.is_playing());
    assert!(send(&mut session, "{\"type\":\"play\"}").unwrap_err().contains("reset first"));
    assert!(send(&mut session, "{\"type\":\"step\"}").unwrap_err().contains("reset first"));
    set(&mut session, "body.0.initial_velocity", "[0, 0, 0]").unwrap();
    set(&mut session, "dt", "5e-4").unwrap();
    assert_eq!(session.pending().len(), 2);
    send(&mut session, "{\"type\":\"reset\"}").unwrap();
    assert_eq!((session.error(), session.world().dt()), (None, 5e-4));
    play(&mut session, 100);
    assert_eq!(session.error(), None);
}

#[test]
fn a_saved_scene_continues_like_the_live_simulation() {
    let without_friction = SCENE.replace("friction_stiffness = 0.4", "");
    let mut session = Session::new(loaded(&without_friction)).unwrap();
    play(&mut session, 150);
    set(&mut session, "gravity.1", "-5").unwrap();
    set(&mut session, "body.0.mass", "9").unwrap();
    play(&mut session, 150);
    let toml = send(&mut session, "{\"type\":\"save\"}").unwrap().unwrap();
    assert!(toml.starts_with("# The scene \"test\" as it was at t = 0.3"), "{toml}");
    let mut world = loaded(&toml).world;
    assert_eq!(world.body_count(), 3);
    for _ in 0..200 {
        world.step().unwrap();
    }
    play(&mut session, 200);
    for (saved, live) in world.bodies().zip(session.world().bodies()) {
        assert_eq!(saved.name(), live.name());
        assert!((saved.position() - live.position()).length() < 1e-9, "{}", saved.name());
        assert!((saved.velocity() - live.velocity()).length() < 1e-8, "{}", saved.name());
        assert!(saved.orientation().dot(live.orientation()).abs() > 1.0 - 1e-12);
    }
}

#[test]
fn a_saved_scene_has_no_more_than_the_simulation_whatever_its_name() {
    let name = "a \" \n[[body]]\nshape = 'sphere'\r\u{1b}[2J";
    let source = Source { name: "test".to_owned(), text: SCENE.to_owned() };
    let evil = load_text(name, source, Path::new("."), &LoadOptions::default()).unwrap();
    let mut session = Session::new(evil).unwrap();
    let toml = send(&mut session, "{\"type\":\"save\"}").unwrap().unwrap();
    assert_eq!(loaded(&toml).world.body_count(), session.world().body_count());
}

#[test]
fn every_built_in_scene_can_be_viewed_edited_and_saved() {
    for scene in tumble_io::scene::BUILTIN {
        let loaded = load_builtin(scene.name, &LoadOptions::default()).unwrap().unwrap();
        let mut session = Session::new(loaded).unwrap();
        play(&mut session, 20);
        let header: serde_json::Value = serde_json::from_str(&header::json(&session)).unwrap();
        for parameter in header["parameters"].as_array().unwrap() {
            let (key, value) = (parameter["key"].as_str().unwrap(), parameter["value"].to_string());
            set(&mut session, key, &value)
                .unwrap_or_else(|error| panic!("{}: {error}", scene.name));
            let (low, high) =
                (parameter["min"].as_f64().unwrap(), parameter["max"].as_f64().unwrap());
            let value = parameter["value"].as_f64().unwrap();
            assert!(low <= value && value <= high && low < high, "{parameter}");
        }
        play(&mut session, 5);
        send(&mut session, "{\"type\":\"save\"}").unwrap().unwrap();
        assert_eq!(session.error(), None, "{}", scene.name);
    }
}

#[test]
fn header_and_frame_have_the_documented_format() {
    let mut session = session();
    play(&mut session, 400);
    let header: serde_json::Value = serde_json::from_str(&header::json(&session)).unwrap();
    assert_eq!(
        (&header["type"], &header["live"], &header["name"]),
        (&"head".into(), &true.into(), &"test".into())
    );
    // the copies share a shape
    assert_eq!(header["shapes"].as_array().unwrap().len(), 2);
    assert_eq!(header["bodies"][2]["shape"], 1);
    assert_eq!(header["shapes"][0]["particle_count"], 42);
    assert!(header["shapes"][0]["particles"].is_null());
    assert_eq!(header["walls"].as_array().unwrap().len(), 6);
    assert_eq!(header["walls"][0]["friction"], 0.4);
    assert_eq!(header["box"]["max"][1], 1.0);
    let vertices = header["shapes"][0]["vertices"].as_str().unwrap();
    assert_eq!(vertices.len(), (42 * 12usize).div_ceil(3) * 4);

    let record = frame::record(&session);
    assert_eq!(record.len(), 104 + 88 * 3);
    let (energy, residual) = (session.world().energy(), residual(&session));
    assert_eq!((float(&record, 0), float(&record, 8)), (session.world().time(), 400.0));
    assert_eq!((float(&record, 16), float(&record, 88)), (energy.kinetic, energy.total()));
    assert_eq!(float(&record, 96), residual);
    let body = |number: usize, at: usize| {
        let start = 104 + 88 * number + 4 * at;
        f64::from(f32::from_le_bytes(record[start..start + 4].try_into().unwrap()))
    };
    for (number, view) in session.world().bodies().enumerate() {
        assert!((body(number, 1) - view.position().y).abs() < 1e-6);
        assert!((body(number, 3) - view.orientation().w).abs() < 1e-6);
        assert!((body(number, 6) - view.orientation().z).abs() < 1e-6);
        assert!((body(number, 9) - view.velocity().z).abs() < 1e-5);
        let force = session.world().contact_wrench(number).force;
        assert!((body(number, 17) - force.y).abs() <= 1e-6 * force.length());
    }
    // the first body lies on the floor
    assert!(body(0, 17) > 0.0);
}

#[test]
fn the_mouse_spring_pulls_a_body_and_its_work_is_not_in_the_residual() {
    let mut session = session();
    send(&mut session, "{\"type\":\"pause\"}").unwrap();
    let grab = "{\"type\":\"grab\",\"body\":0,\"particle\":0,\"target\":[-0.5,0.5,0]}";
    send(&mut session, grab).unwrap();
    let before = session.reference_energy();
    for _ in 0..500 {
        send(&mut session, "{\"type\":\"step\"}").unwrap();
    }
    send(&mut session, "{\"type\":\"move\",\"target\":[-0.5,0.6,0.5]}").unwrap();
    for _ in 0..500 {
        send(&mut session, "{\"type\":\"step\"}").unwrap();
    }
    let position = session.world().body(0).particle(0).0;
    assert!((position - DVec3::new(-0.5, 0.6, 0.5)).length() < 0.1, "{position}");
    assert!(session.reference_energy() > before, "the mouse spring does work");
    let residual = session.world().energy().total() - session.reference_energy();
    let scale = session.world().energy().kinetic + session.world().mouse_spring_work();
    assert!(residual.abs() < 0.02 * scale, "{residual} {scale}");
    // an edit keeps the spring attached, a reset releases it
    send(&mut session, "{\"type\":\"set\",\"key\":\"gravity.1\",\"value\":-1.62}").unwrap();
    send(&mut session, "{\"type\":\"move\",\"target\":[0,2,0]}").unwrap();
    send(&mut session, "{\"type\":\"reset\"}").unwrap();
    assert!(send(&mut session, "{\"type\":\"move\",\"target\":[0,2,0]}").is_err());
    send(&mut session, "{\"type\":\"release\"}").unwrap();
}

#[test]
fn the_mouse_spring_needs_an_existing_particle() {
    let mut session = session();
    for (body, particle) in [(0, 999_999), (999, 0)] {
        let grab = format!(
            "{{\"type\":\"grab\",\"body\":{body},\"particle\":{particle},\"target\":[0,0,0]}}"
        );
        assert!(send(&mut session, &grab).unwrap_err().contains("there is no particle"));
    }
}
