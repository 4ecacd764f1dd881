//! The rows that a run has already written, read back so that it can go on after them.

use tumble::{DQuat, DVec3, World, Wrench};

use super::folder::{CONTACTS, LEDGER, RunFolder, TRAJECTORY};
use super::ledger::ledger_header;
use super::recorder::Recorder;
use super::resume::ResumeError;
use super::rows::{RowError, Rows, parse_contact, parse_ledger, parse_trajectory};
use super::trajectory::{CONTACTS_HEADER, TRAJECTORY_HEADER};
use crate::page::{BodyFrame, Recording};
use crate::picture::{Frame, Pose};
use crate::scene::Scene;

/// The rows of a run up to a moment.
#[derive(Debug)]
pub(super) struct History {
    /// Bytes of `trajectory.csv` up to there.
    pub trajectory: u64,
    /// Bytes of `energy.csv` up to there.
    pub ledger: u64,
    /// Bytes of `contacts.csv` up to there.
    pub contacts: u64,
    /// What the pictures need of it.
    pub recorder: Recorder,
    /// What the page needs of it.
    pub film: Recording,
}

impl History {
    /// Reads the frames up to the state of `world`; `None` if there are no such files. What comes
    /// after, and a last row that is cut short, does not matter.
    pub fn read(
        folder: &RunFolder,
        scene: &Scene,
        world: &World,
    ) -> Result<Option<Self>, ResumeError> {
        let is_there = |name| folder.file(name).symlink_metadata().is_ok();
        if !is_there(TRAJECTORY) && !is_there(LEDGER) {
            return Ok(None);
        }
        let mut trajectory = Rows::open(folder.file(TRAJECTORY), TRAJECTORY_HEADER)?;
        let has_work = scene.does_work();
        let parse = |row: String| parse_ledger(&row, has_work).ok_or(());
        let mut ledger = Rows::open(folder.file(LEDGER), ledger_header(has_work))?;
        let mut contacts = Contacts::open(folder)?;
        let mut recorder = Recorder::new(world.body_count());
        let mut film = Recording::new(world.body_count());
        let last = world.state().step;
        let mut row = ledger.next()?.map(parse).transpose();
        // a run that lost its first rows begins with a later frame
        let first = match row {
            Ok(Some(row)) => (row.time / scene.dt).round() as u64,
            _ => scene.next_frame(last),
        };
        let is_frame =
            if first > last { first == scene.next_frame(last) } else { scene.is_frame(first) };
        if !is_frame {
            return Err(ledger.wrong("has a first row of a time without a frame").into());
        }
        let mut step = first;
        while step <= last {
            let time = step as f64 * scene.dt;
            let next = match row {
                Ok(Some(row)) if row.time == time => row,
                Ok(None) => {
                    return Err(ledger.wrong(&format!("has no row of t = {time} s")).into());
                }
                _ => {
                    let other = format!("has another row than that of t = {time} s");
                    return Err(ledger.wrong(&other).into());
                }
            };
            let bodies = bodies((&mut trajectory, &mut contacts), world, time)?;
            let pose = |b: &BodyFrame| Pose { position: b.position, orientation: b.orientation };
            let poses = bodies.iter().map(pose).collect();
            recorder.record_frame(Frame { time, poses }, next);
            film.record(step, &next, bodies.into_iter());
            step = scene.next_frame(step);
            if step <= last {
                row = ledger.next()?.map(parse).transpose();
            }
        }
        // of a first frame that is still to come, the row was read but is not kept
        let ledger = if first > last { ledger.header } else { ledger.at };
        let (trajectory, contacts) = (trajectory.at, contacts.kept);
        Ok(Some(Self { trajectory, ledger, contacts, recorder, film }))
    }
}

/// The rows of one frame of `trajectory.csv`, one a body, and what `contacts.csv` says to them.
fn bodies(
    (rows, contacts): (&mut Rows, &mut Contacts),
    world: &World,
    time: f64,
) -> Result<Vec<BodyFrame>, ResumeError> {
    let mut bodies = Vec::with_capacity(world.body_count());
    for body in world.bodies() {
        let name = body.name();
        let missing = format!("has no row of \"{name}\" at t = {time} s");
        let row = rows.next()?.ok_or_else(|| rows.wrong(&missing))?;
        let frame = body_frame(&row, time, name).ok_or_else(|| {
            rows.wrong(&format!("has another row than that of \"{name}\" at t = {time} s"))
        })?;
        bodies.push(BodyFrame { contact: contacts.of(time, name)?, ..frame });
    }
    Ok(bodies)
}

fn body_frame(row: &str, time: f64, name: &str) -> Option<BodyFrame> {
    let (of, body, numbers) = parse_trajectory(row)?;
    let [px, py, pz, w, x, y, z, vx, vy, vz, wx, wy, wz, lx, ly, lz] = numbers;
    let frame = BodyFrame {
        position: DVec3::new(px, py, pz),
        orientation: DQuat::from_xyzw(x, y, z, w),
        velocity: DVec3::new(vx, vy, vz),
        angular_velocity: DVec3::new(wx, wy, wz),
        angular_momentum: DVec3::new(lx, ly, lz),
        contact: Wrench::default(),
    };
    (of == time && body == name).then_some(frame)
}

/// The rows of `contacts.csv`, of which there are only some.
struct Contacts {
    rows: Rows,
    next: Option<(f64, String, Wrench)>,
    /// Bytes of the header and the rows that were asked for.
    kept: u64,
}

impl Contacts {
    fn open(folder: &RunFolder) -> Result<Self, RowError> {
        let rows = Rows::open(folder.file(CONTACTS), CONTACTS_HEADER)?;
        let kept = rows.header;
        let mut contacts = Self { rows, next: None, kept };
        contacts.advance();
        Ok(contacts)
    }

    /// Contact of one body in one frame; to be asked in the order of `trajectory.csv`.
    fn of(&mut self, time: f64, name: &str) -> Result<Wrench, RowError> {
        match &self.next {
            Some((of, body, wrench)) if *of == time && body == name => {
                let wrench = *wrench;
                self.kept = self.rows.at;
                self.advance();
                Ok(wrench)
            }
            Some((of, body, _)) if *of < time => {
                let what = format!("has a row of \"{body}\" at t = {of} s out of its order");
                Err(self.rows.wrong(&what))
            }
            _ => Ok(Wrench::default()),
        }
    }

    /// Looks one row ahead, perhaps behind the checkpoint, where a power cut may have left anything:
    /// what is no row ends them.
    fn advance(&mut self) {
        self.next = self.rows.next().ok().flatten().and_then(|row| contact(&row));
    }
}

fn contact(row: &str) -> Option<(f64, String, Wrench)> {
    let (time, body, [fx, fy, fz, tx, ty, tz]) = parse_contact(row)?;
    let (force, torque) = (DVec3::new(fx, fy, fz), DVec3::new(tx, ty, tz));
    Some((time, body.to_owned(), Wrench { force, torque }))
}
