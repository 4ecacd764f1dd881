//! A run read back from its folder, frame by frame: what exports and viewers start from.
//!
//! ```no_run
//! use std::path::Path;
//! use tumble_io::replay::Replay;
//!
//! let replay = Replay::open(Path::new("out/bounce"))?;
//! for frame in &replay.frames {
//!     println!("{} {}", frame.time, frame.poses[0].position);
//! }
//! # Ok::<(), tumble_io::replay::ReplayError>(())
//! ```

use std::path::{Path, PathBuf};

use tumble::{DQuat, DVec3, World};

use crate::checkpoint::read_checkpoint;
use crate::plot::EnergyRow;
use crate::run::{
    CHECKPOINT, LEDGER, RowError, Rows, SCENE, TRAJECTORY, TRAJECTORY_HEADER, ledger_header,
    parse_ledger, parse_trajectory,
};
use crate::scene::{LoadOptions, Loaded, Scene, SceneError, load_file};

/// What to do about rows that stop too early.
const MEND: &str = "`tumble resume` on the folder mends an interrupted run";
/// How far from one the length of an orientation may be.
const SLACK: f64 = 1e-6;

/// A finished or interrupted run.
#[derive(Debug)]
pub struct Replay {
    /// The scene as it was run, under the name it had then.
    pub scene: Scene,
    /// The world at t = 0, with the shapes of all bodies.
    pub world: World,
    /// The recorded frames, at least one, times rising.
    pub frames: Vec<ReplayFrame>,
    /// The energy ledger, one row a frame.
    pub ledger: Vec<EnergyRow>,
}

/// The bodies at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayFrame {
    /// Time (s).
    pub time: f64,
    /// One pose a body, in the order of [`World::bodies`].
    pub poses: Vec<Pose>,
}

/// Where a body is and how it moves; all finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Centre of mass x (m).
    pub position: DVec3,
    /// Velocity v of the centre of mass (m/s).
    pub velocity: DVec3,
    /// Orientation q, body axes to world axes; of length one within a millionth.
    pub orientation: DQuat,
    /// Angular velocity ω, world axes (rad/s).
    pub angular_velocity: DVec3,
    /// Angular momentum L about the centre of mass, world axes (kg·m²/s).
    pub angular_momentum: DVec3,
}

/// Why a folder cannot be read as a run.
#[derive(Debug)]
pub enum ReplayError {
    /// There is no run.
    NotARun(PathBuf, String),
    /// The scene, or a mesh it names, is not what it was.
    Scene(SceneError),
    /// A row of `trajectory.csv` or `energy.csv` is not one of that scene.
    Row(RowError),
}

impl std::fmt::Display for ReplayError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotARun(path, why) => write!(f, "{} {why}", path.display()),
            Self::Scene(error) => error.fmt(f),
            Self::Row(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ReplayError {}

impl From<RowError> for ReplayError {
    fn from(error: RowError) -> Self {
        Self::Row(error)
    }
}

impl Replay {
    /// Reads the run in `folder`: its scene, its meshes, and every frame.
    ///
    /// # Errors
    /// [`ReplayError`] when a file is missing, cut short or not of this run, with file and line.
    pub fn open(folder: &Path) -> Result<Self, ReplayError> {
        let Loaded { mut scene, world } = load_scene(folder)?;
        if let Some(name) = name(folder) {
            scene.name = name;
        }
        let mut trajectory = Rows::open(folder.join(TRAJECTORY), TRAJECTORY_HEADER)?;
        let has_work = scene.does_work();
        let mut rows = Rows::open(folder.join(LEDGER), ledger_header(has_work))?;
        let (mut frames, mut ledger) = (Vec::<ReplayFrame>::new(), Vec::new());
        while let Some(frame) = read_frame(&mut trajectory, &world)? {
            if frames.last().is_some_and(|last| last.time >= frame.time) {
                return Err(trajectory.wrong("has a time that does not rise").into());
            }
            ledger.push(read_ledger(&mut rows, frame.time, has_work)?);
            frames.push(frame);
        }
        if frames.is_empty() {
            return Err(trajectory.wrong("holds no frame; run the scene again").into());
        }
        if rows.next()?.is_some() || rows.torn {
            let more = format!("has more rows than {TRAJECTORY} has frames; {MEND}");
            return Err(rows.wrong(&more).into());
        }
        Ok(Self { scene, world, frames, ledger })
    }
}

fn load_scene(folder: &Path) -> Result<Loaded, ReplayError> {
    let none = |why: &str| Err(ReplayError::NotARun(folder.to_owned(), why.to_owned()));
    let path = folder.join(SCENE);
    match std::fs::metadata(folder) {
        Err(error) => return none(&format!("cannot be read: {error}")),
        Ok(metadata) if !metadata.is_dir() => {
            return none("is no folder; name the folder that `tumble run` wrote");
        }
        Ok(_) => {}
    }
    match std::fs::metadata(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return none("holds no run: there is no scene.toml in it");
        }
        Ok(metadata) if metadata.len() == 0 => {
            return none("holds a run that has not begun: its scene.toml is empty");
        }
        _ => {}
    }
    // a run with --force was accepted with its dt
    let options = LoadOptions { sets: Vec::new(), force: true };
    load_file(&path, &options).map_err(ReplayError::Scene)
}

/// The name of the scene, which only the checkpoint tells; else that of the folder.
fn name(folder: &Path) -> Option<String> {
    let path = folder.join(CHECKPOINT);
    let checkpoint = if path.is_file() { read_checkpoint(&path).ok() } else { None };
    let of_folder = || {
        let folder = folder.canonicalize().ok()?;
        Some(folder.file_name()?.to_string_lossy().into_owned())
    };
    checkpoint.map(|checkpoint| checkpoint.name).or_else(of_folder)
}

/// The rows of one frame of `trajectory.csv`, one a body; `None` at the end of the file.
fn read_frame(rows: &mut Rows, world: &World) -> Result<Option<ReplayFrame>, RowError> {
    let mut frame = ReplayFrame { time: 0.0, poses: Vec::with_capacity(world.body_count()) };
    for (index, body) in world.bodies().enumerate() {
        let Some(row) = rows.next()? else {
            return match (index, rows.torn) {
                (_, true) => Err(torn(rows)),
                (0, false) => Ok(None),
                _ => {
                    Err(rows
                        .wrong(&format!("is followed by no row of \"{}\"; {MEND}", body.name())))
                }
            };
        };
        let (time, name, numbers) = parse_trajectory(&row)
            .ok_or_else(|| rows.wrong("is no row of a time, a body and 16 numbers"))?;
        if name != body.name() {
            let known = world.bodies().any(|body| body.name() == name);
            let what = if known {
                format!("is a row of \"{name}\" where one of \"{}\" is due", body.name())
            } else {
                format!("names the body \"{name}\", which the scene does not have")
            };
            return Err(rows.wrong(&what));
        }
        if index > 0 && time != frame.time {
            let what = format!("has t = {time} s in the middle of the frame of {} s", frame.time);
            return Err(rows.wrong(&what));
        }
        frame.time = time;
        let pose = pose(numbers).filter(|_| time.is_finite());
        let wrong =
            "holds a number that is not finite, or an orientation that is no unit quaternion";
        frame.poses.push(pose.ok_or_else(|| rows.wrong(wrong))?);
    }
    Ok(Some(frame))
}

fn pose(numbers: [f64; 16]) -> Option<Pose> {
    let [px, py, pz, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz, lx, ly, lz] = numbers;
    let orientation = DQuat::from_xyzw(qx, qy, qz, qw);
    let is_unit = (orientation.length() - 1.0).abs() < SLACK;
    (is_unit && numbers.iter().all(|number| number.is_finite())).then_some(Pose {
        position: DVec3::new(px, py, pz),
        velocity: DVec3::new(vx, vy, vz),
        orientation,
        angular_velocity: DVec3::new(wx, wy, wz),
        angular_momentum: DVec3::new(lx, ly, lz),
    })
}

/// The row of `energy.csv` that goes with the frame at `time` (s).
fn read_ledger(rows: &mut Rows, time: f64, has_work: bool) -> Result<EnergyRow, RowError> {
    let Some(row) = rows.next()? else {
        let what = format!("has no row of t = {time} s; {MEND}");
        return Err(if rows.torn { torn(rows) } else { rows.wrong(&what) });
    };
    let count = if has_work { "ten" } else { "nine" };
    let row = parse_ledger(&row, has_work)
        .ok_or_else(|| rows.wrong(&format!("is no row of {count} numbers")))?;
    if row.time != time {
        let what = format!("is the row of t = {} s where that of {time} s is due", row.time);
        return Err(rows.wrong(&what));
    }
    Ok(row)
}

fn torn(rows: &Rows) -> RowError {
    rows.wrong(&format!("is cut short: the run was interrupted while it wrote this line; {MEND}"))
}
