//! A simulation that is viewed: its scene, its world, and the edits that wait for a reset.

use std::time::Duration;

use tumble::{MouseSpring, World};
use tumble_io::scene::{Loaded, Scene};

use crate::capacity::check_capacity;
use crate::command::{Command, SceneEdit};
use crate::integrators::with_dt;
use crate::save;
use crate::scene_edit::{applies_at_once, load_edited};
use crate::transfer::transfer_state;

/// Longest backlog that the simulation catches up with, in seconds of the clock. When the machine is too slow
/// for the chosen speed, the rest is dropped and the simulation runs slower than asked.
const MAX_BACKLOG: f64 = 0.1;

/// The speed at the start: one simulated second per second.
const REAL_TIME: Option<f64> = Some(1.0);

/// A simulation with its scene. It reads no clock: [`Session::add_elapsed`] passes it the elapsed time.
#[derive(Debug)]
pub struct Session {
    /// The scene of the present model.
    scene: Scene,
    world: World,
    /// The scene with all edits, pending ones included, and its world at t = 0.
    next_scene: Scene,
    next_world: World,
    /// Keys that are edited in `next_scene` and wait for a reset.
    pending: Vec<String>,
    playing: bool,
    speed: Option<f64>,
    /// Simulated time that is due but not yet computed (s).
    backlog: f64,
    /// See [`Session::reference_energy`]; without the work of the mouse spring.
    reference_energy: f64,
    mouse_spring: Option<MouseSpring>,
    error: Option<String>,
    revision: u64,
}

impl Session {
    /// A session at t = 0, playing in real time.
    ///
    /// # Errors
    /// Why the viewer cannot show the scene.
    pub fn new(loaded: Loaded) -> Result<Self, String> {
        check_capacity(&loaded.world)?;
        let Loaded { mut scene, world } = loaded;
        write_positions(&mut scene, &world);
        Ok(Self {
            next_scene: scene.clone(),
            next_world: world.clone(),
            reference_energy: world.energy().total(),
            mouse_spring: None,
            scene,
            world,
            pending: Vec::new(),
            playing: true,
            speed: REAL_TIME,
            backlog: 0.0,
            error: None,
            revision: 1,
        })
    }

    /// The scene of the present model.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene that the next reset starts, with all edits.
    pub fn next_scene(&self) -> &Scene {
        &self.next_scene
    }

    /// The present world.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Whether the simulation is running.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Simulated seconds per second; `None`: as fast as possible.
    pub fn speed(&self) -> Option<f64> {
        self.speed
    }

    /// The keys whose edits wait for a reset.
    pub fn pending(&self) -> &[String] {
        &self.pending
    }

    /// The error that stopped the simulation, if it failed.
    pub fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }

    /// A number that increases whenever the [header](crate::header) changes.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The energy from which the residual of the ledger is measured (J): the total at t = 0, plus what edits
    /// and the mouse spring have added since. The residual is then the error of the integrator alone.
    pub fn reference_energy(&self) -> f64 {
        self.reference_energy + self.world.mouse_spring_work()
    }

    /// Executes a command. Returns the scene file for [`Command::Save`], `None` for all others.
    ///
    /// # Errors
    /// Why the command cannot be executed; nothing has changed then.
    pub fn execute(&mut self, command: &Command) -> Result<Option<String>, String> {
        match command {
            Command::Play => self.play()?,
            Command::Pause => self.playing = false,
            Command::Step => self.step_once()?,
            Command::Reset => self.reset(),
            Command::Speed(speed) => (self.speed, self.backlog) = (*speed, 0.0),
            Command::Set(edit) => self.edit(edit)?,
            Command::AttachSpring { body, particle, target } => {
                self.attach_spring(*body, *particle, *target)?;
            }
            Command::MoveSpring(target) => self.move_spring(*target)?,
            Command::ReleaseSpring => self.release_spring(),
            Command::Save => return save::to_toml(&self.scene, &self.world).map(Some),
        }
        Ok(None)
    }

    fn play(&mut self) -> Result<(), String> {
        self.check_not_failed()?;
        (self.playing, self.backlog) = (true, 0.0);
        Ok(())
    }

    fn step_once(&mut self) -> Result<(), String> {
        self.check_not_failed()?;
        if self.playing {
            return Err("the simulation must be paused to take a single step".to_owned());
        }
        self.step();
        Ok(())
    }

    fn check_not_failed(&self) -> Result<(), String> {
        match &self.error {
            Some(_) => Err("the simulation has failed: reset first".to_owned()),
            None => Ok(()),
        }
    }

    /// Goes back to t = 0 with all edits.
    fn reset(&mut self) {
        self.scene = self.next_scene.clone();
        self.world = self.next_world.clone();
        self.reference_energy = self.world.energy().total();
        self.mouse_spring = None;
        self.pending.clear();
        self.error = None;
        self.backlog = 0.0;
        self.revision += 1;
    }

    /// Edits the scene. The edit takes effect at once if the key allows it and the simulation has not failed,
    /// otherwise at the next reset.
    fn edit(&mut self, edit: &SceneEdit) -> Result<(), String> {
        let scenes = [(&self.scene, &self.world), (&self.next_scene, &self.next_world)];
        let edits = with_dt(edit, &scenes);
        let next = Self::load_edited(&self.next_scene, &edits)?;
        if applies_at_once(&edit.key) && self.error.is_none() {
            let (scene, mut world) = if self.pending.is_empty() {
                (next.scene.clone(), next.world.clone())
            } else {
                let present = Self::load_edited(&self.scene, &edits)?;
                (present.scene, present.world)
            };
            transfer_state(&self.world, &mut world)?;
            // an edit may change the total energy, but not the residual
            let residual = self.world.energy().total() - self.reference_energy();
            self.reference_energy = world.energy().total() - residual;
            // attach the mouse spring to the new world, unless its particle no longer exists
            self.mouse_spring =
                self.mouse_spring.filter(|&spring| world.set_mouse_spring(Some(spring)));
            (self.scene, self.world, self.backlog) = (scene, world, 0.0);
        } else if !self.pending.contains(&edit.key) {
            self.pending.push(edit.key.clone());
        }
        (self.next_scene, self.next_world) = (next.scene, next.world);
        self.revision += 1;
        Ok(())
    }

    fn load_edited(scene: &Scene, edits: &[SceneEdit]) -> Result<Loaded, String> {
        let mut loaded = load_edited(scene, edits)?;
        check_capacity(&loaded.world)?;
        write_positions(&mut loaded.scene, &loaded.world);
        Ok(loaded)
    }

    fn attach_spring(
        &mut self,
        body: usize,
        particle: usize,
        target: [f64; 3],
    ) -> Result<(), String> {
        let spring = MouseSpring { body, particle, target: target.into() };
        if !self.world.set_mouse_spring(Some(spring)) {
            return Err(format!(
                "there is no particle {particle} in body {body} that the mouse spring could pull"
            ));
        }
        self.mouse_spring = Some(spring);
        Ok(())
    }

    fn move_spring(&mut self, target: [f64; 3]) -> Result<(), String> {
        let spring = self.mouse_spring.ok_or("the mouse spring is not attached")?;
        self.attach_spring(spring.body, spring.particle, target)
    }

    fn release_spring(&mut self) {
        self.mouse_spring = None;
        self.world.set_mouse_spring(None);
    }

    /// Adds elapsed clock time. While the simulation is playing, it becomes simulated time that is due.
    pub fn add_elapsed(&mut self, elapsed: Duration) {
        if let (true, Some(speed)) = (self.playing, self.speed) {
            let max = (speed * MAX_BACKLOG).max(self.world.dt());
            self.backlog = (self.backlog + speed * elapsed.as_secs_f64()).min(max);
        }
    }

    /// Time until the next step is due: zero if it is due now, `None` while paused.
    pub fn time_to_next_step(&self) -> Option<Duration> {
        let remaining = |speed: f64| ((self.world.dt() - self.backlog) / speed).max(0.0);
        let seconds = self.speed.map_or(0.0, remaining);
        // `Duration::from_secs_f64` panics on huge values
        self.playing.then(|| Duration::from_secs_f64(seconds.min(86_400.0)))
    }

    /// Takes the steps that are due while `keep_going` returns true; it is called every few milliseconds at most.
    /// Returns the number of steps taken.
    pub fn advance(&mut self, keep_going: &mut dyn FnMut() -> bool) -> u64 {
        let (dt, batch) = (self.world.dt(), steps_per_batch(&self.world));
        let mut taken = 0;
        while self.playing {
            let due = self.speed.map_or(u64::MAX, |_| (self.backlog / dt) as u64);
            if due == 0 {
                break;
            }
            for _ in 0..due.min(batch) {
                if !self.step() {
                    break;
                }
                self.backlog -= dt;
                taken += 1;
            }
            if !keep_going() {
                break;
            }
        }
        // without a speed limit the backlog has become negative
        self.backlog = self.backlog.max(0.0);
        taken
    }

    /// Takes one step. Returns false if it fails; the simulation is then paused with an error.
    fn step(&mut self) -> bool {
        let stepped = self.world.step();
        if let Err(error) = &stepped {
            self.error = Some(error.to_string());
            self.playing = false;
        }
        stepped.is_ok()
    }
}

/// Writes the default position of every body into the scene, so that its components can be edited one by one.
fn write_positions(scene: &mut Scene, world: &World) {
    let mut index = 0;
    for body in &mut scene.bodies {
        if index < world.body_count() {
            let centre = world.body(index).model().shape.centre();
            body.position.get_or_insert(centre);
        }
        index += body.copies.as_ref().map_or(1, |copies| copies.total() as usize);
    }
}

/// Number of steps between two readings of the clock, about 100,000 particle steps.
fn steps_per_batch(world: &World) -> u64 {
    let particles: u64 = world.bodies().map(|body| body.particle_count() as u64).sum();
    (100_000 / (particles + 1)).clamp(1, 1000)
}
