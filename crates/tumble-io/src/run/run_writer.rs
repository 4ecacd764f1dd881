//! Writes the rows of a run on a thread of its own, so that the time steps do not wait for text
//! formatting and disks.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use tumble::Contact;

use super::contact_points::{RowNames, write_contact_points};
use super::energy_ledger::EnergyColumns;
use super::energy_ledger::write_energy;
use super::error::RunError;
use super::folder::{
    CONTACT_POINTS_FILE, CONTACTS_FILE, ENERGY_FILE, JOINTS_FILE, RunFolder, TRAJECTORY_FILE,
};
use super::frame_buffers::FrameBuffers;
use super::joint_rows::write_joints;
use super::trajectory::{write_contacts, write_frame};
use crate::page::WorldFrame;
use crate::plot::EnergyRow;

/// Frames are sent in batches of about so many bodies: waking a thread costs more than writing a
/// frame of one body.
const BATCH_BODIES: usize = 256;
/// Batches that may wait in the channel. When the disk is slower than that, the time steps wait.
const CHANNEL_CAPACITY: usize = 8;

/// The open CSV files of a run.
pub(super) struct CsvFiles {
    pub trajectory: BufWriter<File>,
    pub energy: BufWriter<File>,
    pub contacts: BufWriter<File>,
    /// `contact_points.csv`, if the scene asks for it.
    pub contact_points: Option<BufWriter<File>>,
    /// `joints.csv`, if there are joints.
    pub joints: Option<BufWriter<File>>,
    /// The columns of `energy.csv`.
    pub columns: EnergyColumns,
}

/// One frame of a run.
pub(super) struct RunFrame {
    pub step: u64,
    pub row: EnergyRow,
    pub frame: WorldFrame,
    /// The contacts of the latest step, if they are recorded.
    pub contacts: Vec<Contact>,
}

enum Request {
    Write(Vec<RunFrame>),
    /// Sync all files to the disk, then reply.
    Sync(SyncSender<()>),
}

/// Handle of the writer thread.
pub(super) struct RunWriter {
    folder: RunFolder,
    requests: Option<SyncSender<Request>>,
    batch: Vec<RunFrame>,
    thread: Option<JoinHandle<Result<FrameBuffers, RunError>>>,
}

impl RunWriter {
    /// Starts the thread. `names` are the names of bodies and walls, in order.
    pub fn start(
        folder: &RunFolder,
        files: CsvFiles,
        frames: FrameBuffers,
        names: RowNames,
    ) -> Self {
        let (requests, received) = sync_channel(CHANNEL_CAPACITY);
        let worker = Worker { folder: folder.clone(), files, frames, names };
        let thread = Some(std::thread::spawn(move || worker.run(&received)));
        Self { folder: folder.clone(), requests: Some(requests), batch: Vec::new(), thread }
    }

    /// Queues a frame.
    ///
    /// # Errors
    /// [`RunError::Write`] when an earlier frame could not be written.
    pub fn write(&mut self, frame: RunFrame) -> Result<(), RunError> {
        let rows = (frame.frame.bodies.len() + frame.contacts.len()).max(1);
        self.batch.push(frame);
        if self.batch.len() * rows >= BATCH_BODIES { self.send_batch() } else { Ok(()) }
    }

    fn send_batch(&mut self) -> Result<(), RunError> {
        let batch = std::mem::take(&mut self.batch);
        if batch.is_empty() { Ok(()) } else { self.send(Request::Write(batch)) }
    }

    /// Waits until all queued frames are on the disk.
    ///
    /// # Errors
    /// [`RunError::Write`] when a file could not be written or synced.
    pub fn sync(&mut self) -> Result<(), RunError> {
        self.send_batch()?;
        let (done, reply) = sync_channel(1);
        self.send(Request::Sync(done))?;
        reply.recv().map_err(|_| self.failure())
    }

    /// Writes all queued frames, ends the thread and returns the frames held in memory.
    ///
    /// # Errors
    /// [`RunError::Write`] when a row could not be written.
    pub fn finish(mut self) -> Result<FrameBuffers, RunError> {
        self.send_batch()?;
        self.join()
    }

    fn send(&mut self, request: Request) -> Result<(), RunError> {
        let is_sent = self.requests.as_ref().is_some_and(|requests| requests.send(request).is_ok());
        if is_sent { Ok(()) } else { Err(self.failure()) }
    }

    /// The error that ended the thread.
    fn failure(&mut self) -> RunError {
        match self.join() {
            Err(error) => error,
            Ok(_) => self.stopped(),
        }
    }

    fn join(&mut self) -> Result<FrameBuffers, RunError> {
        self.requests = None;
        let ended = self.thread.take().map(JoinHandle::join);
        ended.and_then(Result::ok).unwrap_or_else(|| Err(self.stopped()))
    }

    fn stopped(&self) -> RunError {
        let error = io::Error::other("the writer thread has stopped");
        RunError::Write(self.folder.file_path(TRAJECTORY_FILE), error)
    }
}

impl Drop for RunWriter {
    /// Writes the queued frames even when the run fails.
    fn drop(&mut self) {
        // an error was reported before, or the run ends with an error of its own
        let _ = self.send_batch().and_then(|()| self.join().map(drop));
    }
}

/// What the thread owns.
struct Worker {
    folder: RunFolder,
    files: CsvFiles,
    frames: FrameBuffers,
    names: RowNames,
}

impl Worker {
    fn run(mut self, requests: &Receiver<Request>) -> Result<FrameBuffers, RunError> {
        while let Ok(request) = requests.recv() {
            match request {
                Request::Write(frames) => {
                    frames.into_iter().try_for_each(|frame| self.write(frame))?;
                }
                Request::Sync(done) => {
                    self.sync()?;
                    // the receiver may be gone
                    let _ = done.send(());
                }
            }
        }
        self.for_each_file(|file| file.flush())?;
        Ok(self.frames)
    }

    fn write(&mut self, frame: RunFrame) -> Result<(), RunError> {
        let RunFrame { step, row, frame, contacts: listed } = frame;
        let CsvFiles { trajectory, energy, contacts, contact_points, joints, columns } =
            &mut self.files;
        let names = &self.names.bodies;
        let failed = |name| move |error| (name, error);
        write_frame(trajectory, row.time, names, &frame.bodies)
            .map_err(failed(TRAJECTORY_FILE))
            .and_then(|()| write_energy(energy, &row, *columns).map_err(failed(ENERGY_FILE)))
            .and_then(|()| {
                write_contacts(contacts, row.time, names, &frame.bodies)
                    .map_err(failed(CONTACTS_FILE))
            })
            .and_then(|()| match joints {
                Some(file) => write_joints(file, row.time, &self.names.joints, &frame.joints)
                    .map_err(failed(JOINTS_FILE)),
                None => Ok(()),
            })
            .and_then(|()| match contact_points {
                Some(file) => write_contact_points(file, row.time, &self.names, &listed)
                    .map_err(failed(CONTACT_POINTS_FILE)),
                None => Ok(()),
            })
            .map_err(|(name, error)| RunError::Write(self.folder.file_path(name), error))?;
        self.frames.record(step, &row, &frame);
        Ok(())
    }

    fn sync(&mut self) -> Result<(), RunError> {
        self.for_each_file(|file| file.flush().and_then(|()| file.get_ref().sync_data()))
    }

    fn for_each_file(
        &mut self,
        apply: impl Fn(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), RunError> {
        let CsvFiles { trajectory, energy, contacts, contact_points, joints, .. } = &mut self.files;
        let files =
            [(TRAJECTORY_FILE, trajectory), (ENERGY_FILE, energy), (CONTACTS_FILE, contacts)];
        let others = contact_points.iter_mut().map(|file| (CONTACT_POINTS_FILE, file));
        let others = others.chain(joints.iter_mut().map(|file| (JOINTS_FILE, file)));
        for (name, file) in files.into_iter().chain(others) {
            apply(file).map_err(|error| RunError::Write(self.folder.file_path(name), error))?;
        }
        Ok(())
    }
}
