//! The simulation that pages look at: its scene, its world, and what waits for a reset.

use std::time::Duration;

use tumble::{MouseSpring, World};
use tumble_io::scene::{Loaded, Scene};

use crate::command::{Command, Setting};
use crate::{head, save, setting};

/// Simulated time that is not made in time is dropped: the motion then goes slower than asked, and
/// does not run after what it has missed. In seconds of the clock.
const MOST_OWED: f64 = 0.1;

/// Without an order of the person, one second takes a second.
const REAL_TIME: Option<f64> = Some(1.0);

/// A simulation on its way. It knows no clock: [`Session::owe`] tells it how much time has passed.
#[derive(Debug)]
pub struct Session {
    /// The scene of the present model.
    scene: Scene,
    world: World,
    /// The scene with everything that was set, and its world at t = 0.
    next_scene: Scene,
    start: World,
    /// Keys that are in `next_scene` but wait for a reset.
    pending: Vec<String>,
    playing: bool,
    speed: Option<f64>,
    /// Simulated time to be made (s).
    owed: f64,
    baseline: f64,
    /// What is being pulled.
    hand: Option<MouseSpring>,
    error: Option<String>,
    revision: u64,
}

impl Session {
    /// At t = 0, playing, a second in a second.
    ///
    /// # Errors
    /// Why the scene cannot be shown.
    pub fn new(loaded: Loaded) -> Result<Self, String> {
        head::can_be_shown(&loaded.world)?;
        let Loaded { mut scene, world } = loaded;
        say_positions(&mut scene, &world);
        Ok(Self {
            next_scene: scene.clone(),
            start: world.clone(),
            baseline: world.energy().total(),
            hand: None,
            scene,
            world,
            pending: Vec::new(),
            playing: true,
            speed: REAL_TIME,
            owed: 0.0,
            error: None,
            revision: 1,
        })
    }

    /// The scene of the present model.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene that the next reset starts.
    pub fn next_scene(&self) -> &Scene {
        &self.next_scene
    }

    /// The world as it is now.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Whether time goes on.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Simulated seconds a second; `None`: as fast as it goes.
    pub fn speed(&self) -> Option<f64> {
        self.speed
    }

    /// The keys that were set and wait for a reset.
    pub fn pending(&self) -> &[String] {
        &self.pending
    }

    /// Why the simulation stands still, if it failed.
    pub fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }

    /// Grows whenever what [`head`] says has changed.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// What the total of the ledger is measured against (J): its value at t = 0, and what the person's hand
    /// has added since, by settings and by pulling.
    pub fn baseline(&self) -> f64 {
        self.baseline + self.world.mouse_work()
    }

    /// Carries out a command; the answer, if there is one, is the scene to be saved.
    ///
    /// # Errors
    /// Why it cannot be carried out; nothing has changed then.
    pub fn carry_out(&mut self, command: &Command) -> Result<Option<String>, String> {
        match command {
            Command::Play => self.play()?,
            Command::Pause => self.playing = false,
            Command::Step => self.step_once()?,
            Command::Reset => self.reset(),
            Command::Speed(speed) => (self.speed, self.owed) = (*speed, 0.0),
            Command::Set(setting) => self.set(setting)?,
            Command::Grab { body, particle, target } => self.grab(*body, *particle, *target)?,
            Command::Move(target) => self.move_target(*target)?,
            Command::Release => self.release(),
            Command::Save => return save::to_toml(&self.scene, &self.world).map(Some),
        }
        Ok(None)
    }

    fn play(&mut self) -> Result<(), String> {
        self.still_sound()?;
        (self.playing, self.owed) = (true, 0.0);
        Ok(())
    }

    fn step_once(&mut self) -> Result<(), String> {
        self.still_sound()?;
        if self.playing {
            return Err("a single step needs the motion to be paused".to_owned());
        }
        self.step();
        Ok(())
    }

    fn still_sound(&self) -> Result<(), String> {
        match &self.error {
            Some(_) => Err("the simulation has failed: reset first".to_owned()),
            None => Ok(()),
        }
    }

    /// Back to t = 0, with everything that was set.
    fn reset(&mut self) {
        self.scene = self.next_scene.clone();
        self.world = self.start.clone();
        self.baseline = self.world.energy().total();
        self.hand = None;
        self.pending.clear();
        self.error = None;
        self.owed = 0.0;
        self.revision += 1;
    }

    /// Changes a key: at once where the motion can go on, else at the next reset. A simulation that
    /// has failed is changed at the next reset.
    fn set(&mut self, new: &Setting) -> Result<(), String> {
        let next = self.read(&self.next_scene, new)?;
        if setting::applies_at_once(&new.key) && self.error.is_none() {
            let (scene, mut world) = if self.pending.is_empty() {
                (next.scene.clone(), next.world.clone())
            } else {
                let now = self.read(&self.scene, new)?;
                (now.scene, now.world)
            };
            setting::transplant(&self.world, &mut world)?;
            // what the person's hand has changed is no error of the integrator
            let residual = self.world.energy().total() - self.baseline();
            self.baseline = world.energy().total() - residual;
            // a hand holds on, if what it holds is still there
            self.hand = self.hand.filter(|&hand| world.set_mouse_spring(Some(hand)));
            (self.scene, self.world, self.owed) = (scene, world, 0.0);
        } else if !self.pending.contains(&new.key) {
            self.pending.push(new.key.clone());
        }
        (self.next_scene, self.start) = (next.scene, next.world);
        self.revision += 1;
        Ok(())
    }

    /// A scene with a key changed.
    fn read(&self, scene: &Scene, new: &Setting) -> Result<Loaded, String> {
        let mut loaded = setting::load_with(scene, new)?;
        head::can_be_shown(&loaded.world)?;
        say_positions(&mut loaded.scene, &loaded.world);
        Ok(loaded)
    }

    /// A hand on a particle. Its work goes into the baseline, so that the residual stays the integrator's alone.
    fn grab(&mut self, body: usize, particle: usize, target: [f64; 3]) -> Result<(), String> {
        let hand = MouseSpring { body, particle, target: target.into() };
        if !self.world.set_mouse_spring(Some(hand)) {
            return Err(format!("there is no particle {particle} of a body {body} to pull there"));
        }
        self.hand = Some(hand);
        Ok(())
    }

    fn move_target(&mut self, target: [f64; 3]) -> Result<(), String> {
        let hand = self.hand.ok_or("nothing is being pulled")?;
        self.grab(hand.body, hand.particle, target)
    }

    fn release(&mut self) {
        self.hand = None;
        self.world.set_mouse_spring(None);
    }

    /// Tells that so much time has passed while the motion was playing.
    pub fn owe(&mut self, passed: Duration) {
        if let (true, Some(speed)) = (self.playing, self.speed) {
            let most = (speed * MOST_OWED).max(self.world.dt());
            self.owed = (self.owed + speed * passed.as_secs_f64()).min(most);
        }
    }

    /// How long it is until the next step is due; zero if it is, `None` if none ever is.
    pub fn due_in(&self) -> Option<Duration> {
        let missing = |speed: f64| ((self.world.dt() - self.owed) / speed).max(0.0);
        let seconds = self.speed.map_or(0.0, missing);
        // a wait longer than a day may as well be looked at again after a day
        self.playing.then(|| Duration::from_secs_f64(seconds.min(86_400.0)))
    }

    /// Takes the steps that are due, as long as `go_on` says so; it is asked every few milliseconds at
    /// most. Returns how many steps were taken.
    pub fn advance(&mut self, go_on: &mut dyn FnMut() -> bool) -> u64 {
        let (dt, batch) = (self.world.dt(), batch(&self.world));
        let mut taken = 0;
        while self.playing {
            let due = self.speed.map_or(u64::MAX, |_| (self.owed / dt) as u64);
            if due == 0 {
                break;
            }
            for _ in 0..due.min(batch) {
                if !self.step() {
                    break;
                }
                self.owed -= dt;
                taken += 1;
            }
            if !go_on() {
                break;
            }
        }
        // without a speed there is nothing to keep up with
        self.owed = self.owed.max(0.0);
        taken
    }

    /// One step; false when it failed, and the motion stands still from then on.
    fn step(&mut self) -> bool {
        let stepped = self.world.step();
        if let Err(error) = &stepped {
            self.error = Some(error.to_string());
            self.playing = false;
        }
        stepped.is_ok()
    }
}

/// Writes the place of every body into the scene, so that its coordinates can be set one by one.
fn say_positions(scene: &mut Scene, world: &World) {
    let mut index = 0;
    for body in &mut scene.bodies {
        if index < world.body_count() {
            let centre = world.body(index).model().shape.centre();
            body.position.get_or_insert(centre);
        }
        index += body.copies.as_ref().map_or(1, |copies| copies.total() as usize);
    }
}

/// Steps between two looks at the clock: some hundred thousand particles' worth.
fn batch(world: &World) -> u64 {
    let particles: u64 = world.bodies().map(|body| body.particle_count() as u64).sum();
    (100_000 / (particles + 1)).clamp(1, 1000)
}
