//! Reads a run back from its folder, frame by frame; the input of all exports.
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
    CHECKPOINT_FILE, CsvReader, ENERGY_FILE, EnergyColumns, RowError, SCENE_FILE, TRAJECTORY_FILE,
    TRAJECTORY_HEADER, parse_energy, parse_trajectory,
};
use crate::scene::{LoadOptions, Loaded, Scene, SceneError, load_recorded_file};

/// Advice for an interrupted run.
const RESUME_ADVICE: &str = "`tumble resume` on the folder completes an interrupted run";
/// Tolerance for the norm of an orientation quaternion.
const NORM_TOLERANCE: f64 = 1e-6;

/// A finished or interrupted run.
#[derive(Debug)]
pub struct Replay {
    /// The scene as run, with the name it had then.
    pub scene: Scene,
    /// The world at t = 0, with all bodies and their shapes.
    pub world: World,
    /// The recorded frames: at least one, with strictly increasing times.
    pub frames: Vec<ReplayFrame>,
    /// The energy ledger, one row per frame.
    pub ledger: Vec<EnergyRow>,
}

/// All bodies at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayFrame {
    /// Time (s).
    pub time: f64,
    /// One pose per body, in the order of [`World::bodies`].
    pub poses: Vec<Pose>,
}

/// Pose and velocities of a body. All numbers are finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Centre of mass x (m).
    pub position: DVec3,
    /// Velocity v of the centre of mass (m/s).
    pub velocity: DVec3,
    /// Orientation q, body axes to world axes; a unit quaternion within 10⁻⁶.
    pub orientation: DQuat,
    /// Angular velocity ω, world axes (rad/s).
    pub angular_velocity: DVec3,
    /// Angular momentum L about the centre of mass, world axes (kg·m²/s).
    pub angular_momentum: DVec3,
}

/// Why a run cannot be read from a folder.
#[derive(Debug)]
pub enum ReplayError {
    /// The path is not a folder with a run.
    NotARun(PathBuf, String),
    /// The scene or one of its meshes is missing, invalid or changed.
    Scene(SceneError),
    /// A row of `trajectory.csv` or `energy.csv` is missing, invalid or not of this scene.
    Row(RowError),
}

impl std::fmt::Display for ReplayError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotARun(path, problem) => write!(f, "{} {problem}", path.display()),
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
    /// Reads the run in `folder`: its scene, its meshes and all frames.
    ///
    /// # Errors
    /// [`ReplayError`], with file and line, when a file is missing, truncated or not of this run.
    pub fn open(folder: &Path) -> Result<Self, ReplayError> {
        let Loaded { mut scene, world } = load_scene(folder)?;
        if let Some(name) = scene_name(folder) {
            scene.name = name;
        }
        let mut trajectory = CsvReader::open(folder.join(TRAJECTORY_FILE), TRAJECTORY_HEADER)?;
        let columns = EnergyColumns::new(&scene);
        let mut energy = CsvReader::open(folder.join(ENERGY_FILE), &columns.header())?;
        let (mut frames, mut ledger) = (Vec::<ReplayFrame>::new(), Vec::new());
        while let Some(frame) = read_frame(&mut trajectory, &world)? {
            if frames.last().is_some_and(|last| last.time >= frame.time) {
                return Err(trajectory.error("has a time that does not increase").into());
            }
            ledger.push(read_energy(&mut energy, frame.time, columns)?);
            frames.push(frame);
        }
        if frames.is_empty() {
            return Err(trajectory.error("holds no frame; run the scene again").into());
        }
        if energy.next_row()?.is_some() || energy.is_truncated {
            let problem =
                format!("has more rows than {TRAJECTORY_FILE} has frames; {RESUME_ADVICE}");
            return Err(energy.error(&problem).into());
        }
        Ok(Self { scene, world, frames, ledger })
    }
}

fn load_scene(folder: &Path) -> Result<Loaded, ReplayError> {
    let not_a_run =
        |problem: &str| Err(ReplayError::NotARun(folder.to_owned(), problem.to_owned()));
    let path = folder.join(SCENE_FILE);
    match std::fs::metadata(folder) {
        Err(error) => return not_a_run(&format!("cannot be read: {error}")),
        Ok(metadata) if !metadata.is_dir() => {
            return not_a_run("is not a folder; name a folder that `tumble run` wrote");
        }
        Ok(_) => {}
    }
    match std::fs::metadata(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return not_a_run("holds no run: there is no scene.toml in it");
        }
        Ok(metadata) if metadata.len() == 0 => {
            return not_a_run("holds a run that has not started: its scene.toml is empty");
        }
        _ => {}
    }
    // the run accepted its dt, possibly with --force
    let options = LoadOptions { sets: Vec::new(), force: true };
    load_recorded_file(&path, &options).map_err(ReplayError::Scene)
}

/// Name of the scene, from the checkpoint if there is one, otherwise the name of the folder.
fn scene_name(folder: &Path) -> Option<String> {
    let path = folder.join(CHECKPOINT_FILE);
    let checkpoint = if path.is_file() { read_checkpoint(&path).ok() } else { None };
    let folder_name = || {
        let folder = folder.canonicalize().ok()?;
        Some(folder.file_name()?.to_string_lossy().into_owned())
    };
    checkpoint.map(|checkpoint| checkpoint.name).or_else(folder_name)
}

/// Reads one frame of `trajectory.csv`, a row per body; `None` at the end of the file.
fn read_frame(rows: &mut CsvReader, world: &World) -> Result<Option<ReplayFrame>, RowError> {
    let mut frame = ReplayFrame { time: 0.0, poses: Vec::with_capacity(world.body_count()) };
    for (index, body) in world.bodies().enumerate() {
        let Some(row) = rows.next_row()? else {
            return match (index, rows.is_truncated) {
                (_, true) => Err(truncated(rows)),
                (0, false) => Ok(None),
                _ => Err(rows.error(&format!(
                    "is not followed by a row of \"{}\"; {RESUME_ADVICE}",
                    body.name()
                ))),
            };
        };
        let (time, name, numbers) = parse_trajectory(&row)
            .ok_or_else(|| rows.error("is not a row of a time, a body and 16 numbers"))?;
        if name != body.name() {
            let is_known = world.bodies().any(|body| body.name() == name);
            let problem = if is_known {
                format!("is a row of \"{name}\", but one of \"{}\" is expected", body.name())
            } else {
                format!("names the body \"{name}\", which the scene does not have")
            };
            return Err(rows.error(&problem));
        }
        if index > 0 && time != frame.time {
            let problem =
                format!("has t = {time} s in the middle of the frame of t = {} s", frame.time);
            return Err(rows.error(&problem));
        }
        frame.time = time;
        let pose = parse_pose(numbers).filter(|_| time.is_finite());
        let problem =
            "has a number that is not finite, or an orientation that is not a unit quaternion";
        frame.poses.push(pose.ok_or_else(|| rows.error(problem))?);
    }
    Ok(Some(frame))
}

/// The pose, unless a number is not finite or the orientation is not a unit quaternion.
fn parse_pose(numbers: [f64; 16]) -> Option<Pose> {
    let [px, py, pz, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz, lx, ly, lz] = numbers;
    let orientation = DQuat::from_xyzw(qx, qy, qz, qw);
    let is_unit = (orientation.length() - 1.0).abs() < NORM_TOLERANCE;
    (is_unit && numbers.iter().all(|number| number.is_finite())).then_some(Pose {
        position: DVec3::new(px, py, pz),
        velocity: DVec3::new(vx, vy, vz),
        orientation,
        angular_velocity: DVec3::new(wx, wy, wz),
        angular_momentum: DVec3::new(lx, ly, lz),
    })
}

/// Reads the row of `energy.csv` for the frame at `time` (s).
fn read_energy(
    rows: &mut CsvReader,
    time: f64,
    columns: EnergyColumns,
) -> Result<EnergyRow, RowError> {
    let Some(row) = rows.next_row()? else {
        let problem = format!("has no row of t = {time} s; {RESUME_ADVICE}");
        return Err(if rows.is_truncated { truncated(rows) } else { rows.error(&problem) });
    };
    let count =
        9 + u8::from(columns.work) + u8::from(columns.numerical) + 3 * u8::from(columns.joints);
    let row = parse_energy(&row, columns)
        .ok_or_else(|| rows.error(&format!("is not a row of {count} numbers")))?;
    if row.time != time {
        let problem =
            format!("is the row of t = {} s, but that of t = {time} s is expected", row.time);
        return Err(rows.error(&problem));
    }
    Ok(row)
}

fn truncated(rows: &CsvReader) -> RowError {
    rows.error(&format!(
        "is cut short: the run was interrupted while writing this line; {RESUME_ADVICE}"
    ))
}
