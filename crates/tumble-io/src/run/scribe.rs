//! A thread of its own writes the rows of a run and remembers what its pictures need, so that the
//! steps do not wait for text and disks.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use super::folder::{CONTACTS, LEDGER, RunError, RunFolder, TRAJECTORY};
use super::ledger::write_ledger;
use super::recorder::Recorder;
use super::trajectory::{write_contacts, write_frame};
use crate::page::{BodyFrame, Recording};
use crate::picture::{Frame, Pose};
use crate::plot::EnergyRow;

/// Frames are handed over in batches of about so many bodies: waking a thread costs more than a frame of one body.
const BATCH: usize = 256;
/// Batches that may wait to be written. Where the disk cannot keep up, the steps wait after all.
const WAITING: usize = 8;

/// The files that grow.
pub(super) struct Files {
    pub trajectory: BufWriter<File>,
    pub ledger: BufWriter<File>,
    pub contacts: BufWriter<File>,
    /// Whether the ledger has the column `work`.
    pub has_work: bool,
}

/// What the pictures need.
pub(super) struct Memory {
    pub recorder: Recorder,
    pub film: Recording,
}

/// One frame, to be written.
pub(super) struct Moment {
    pub step: u64,
    pub row: EnergyRow,
    pub bodies: Vec<BodyFrame>,
}

enum Order {
    Write(Vec<Moment>),
    /// Everything so far is to reach the disk, and then to be answered.
    Settle(SyncSender<()>),
}

/// The thread, seen from the run.
pub(super) struct Scribe {
    folder: RunFolder,
    orders: Option<SyncSender<Order>>,
    batch: Vec<Moment>,
    thread: Option<JoinHandle<Result<Memory, RunError>>>,
}

impl Scribe {
    /// Starts the thread. `names` are those of the bodies.
    pub fn start(folder: &RunFolder, files: Files, memory: Memory, names: Vec<String>) -> Self {
        let (orders, received) = sync_channel(WAITING);
        let desk = Desk { folder: folder.clone(), files, memory, names };
        let thread = Some(std::thread::spawn(move || desk.work(&received)));
        Self { folder: folder.clone(), orders: Some(orders), batch: Vec::new(), thread }
    }

    /// Hands over a frame.
    ///
    /// # Errors
    /// That of an earlier frame, which could not be written.
    pub fn write(&mut self, moment: Moment) -> Result<(), RunError> {
        let bodies = moment.bodies.len().max(1);
        self.batch.push(moment);
        if self.batch.len() * bodies >= BATCH { self.hand_over() } else { Ok(()) }
    }

    fn hand_over(&mut self) -> Result<(), RunError> {
        let batch = std::mem::take(&mut self.batch);
        if batch.is_empty() { Ok(()) } else { self.order(Order::Write(batch)) }
    }

    /// Waits until everything is on the disk.
    ///
    /// # Errors
    /// [`RunError::Write`] when it cannot get there.
    pub fn settle(&mut self) -> Result<(), RunError> {
        self.hand_over()?;
        let (done, answer) = sync_channel(1);
        self.order(Order::Settle(done))?;
        answer.recv().map_err(|_| self.failure())
    }

    /// Ends the thread, with all rows handed to the system; returns what it remembers.
    ///
    /// # Errors
    /// [`RunError::Write`] when a row could not be written.
    pub fn finish(mut self) -> Result<Memory, RunError> {
        self.hand_over()?;
        self.join()
    }

    fn order(&mut self, order: Order) -> Result<(), RunError> {
        let sent = self.orders.as_ref().is_some_and(|orders| orders.send(order).is_ok());
        if sent { Ok(()) } else { Err(self.failure()) }
    }

    /// Why the thread has stopped.
    fn failure(&mut self) -> RunError {
        match self.join() {
            Err(error) => error,
            Ok(_) => self.stopped(),
        }
    }

    fn join(&mut self) -> Result<Memory, RunError> {
        self.orders = None;
        let ended = self.thread.take().map(JoinHandle::join);
        ended.and_then(Result::ok).unwrap_or_else(|| Err(self.stopped()))
    }

    fn stopped(&self) -> RunError {
        let error = io::Error::other("writing had stopped before");
        RunError::Write(self.folder.file(TRAJECTORY), error)
    }
}

impl Drop for Scribe {
    /// What was handed over is written, however the run ends.
    fn drop(&mut self) {
        // an error was told before, or the run ends with one of its own
        let _ = self.hand_over().and_then(|()| self.join().map(drop));
    }
}

/// The thread's side.
struct Desk {
    folder: RunFolder,
    files: Files,
    memory: Memory,
    names: Vec<String>,
}

impl Desk {
    fn work(mut self, orders: &Receiver<Order>) -> Result<Memory, RunError> {
        while let Ok(order) = orders.recv() {
            match order {
                Order::Write(moments) => {
                    moments.into_iter().try_for_each(|moment| self.write(moment))?;
                }
                Order::Settle(done) => {
                    self.settle()?;
                    // who asked may have gone
                    let _ = done.send(());
                }
            }
        }
        self.each(|file| file.flush())?;
        Ok(self.memory)
    }

    fn write(&mut self, moment: Moment) -> Result<(), RunError> {
        let Moment { step, row, bodies } = moment;
        let Files { trajectory, ledger, contacts, has_work } = &mut self.files;
        let failed = |name| move |error| (name, error);
        write_frame(trajectory, row.time, &self.names, &bodies)
            .map_err(failed(TRAJECTORY))
            .and_then(|()| write_ledger(ledger, &row, *has_work).map_err(failed(LEDGER)))
            .and_then(|()| {
                write_contacts(contacts, row.time, &self.names, &bodies).map_err(failed(CONTACTS))
            })
            .map_err(|(name, error)| RunError::Write(self.folder.file(name), error))?;
        self.memory.recorder.record_frame(still(row.time, &bodies), row);
        self.memory.film.record(step, &row, bodies.into_iter());
        Ok(())
    }

    fn settle(&mut self) -> Result<(), RunError> {
        self.each(|file| file.flush().and_then(|()| file.get_ref().sync_data()))
    }

    fn each(
        &mut self,
        act: impl Fn(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), RunError> {
        let Files { trajectory, ledger, contacts, .. } = &mut self.files;
        for (name, file) in [(TRAJECTORY, trajectory), (LEDGER, ledger), (CONTACTS, contacts)] {
            act(file).map_err(|error| RunError::Write(self.folder.file(name), error))?;
        }
        Ok(())
    }
}

/// Where the bodies are.
pub(super) fn still(time: f64, bodies: &[BodyFrame]) -> Frame {
    let pose = |body: &BodyFrame| Pose { position: body.position, orientation: body.orientation };
    Frame { time, poses: bodies.iter().map(pose).collect() }
}
