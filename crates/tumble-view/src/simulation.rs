//! The simulation thread: executes commands between steps and publishes the results.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use serde::Serialize;
use tungstenite::Message;

use crate::broadcast::{Broadcast, PageId, Update};
use crate::command::Command;
use crate::{Session, frame, header};

/// Capacity of the command queue.
pub const QUEUE_CAPACITY: usize = 256;

/// Longest time of stepping before the command queue is checked.
const TIME_SLICE: Duration = Duration::from_millis(4);
/// Shortest time between two frames.
const FRAME_INTERVAL: Duration = Duration::from_nanos(1_000_000_000 / 60);
/// Shortest time between two statuses that differ only in the measured speed.
const STATUS_INTERVAL: Duration = Duration::from_millis(250);

/// A message to the simulation thread.
#[derive(Debug)]
pub enum Event {
    /// A page has connected.
    Connected,
    /// A page has sent a command.
    Command {
        /// The page.
        page: PageId,
        /// Its command.
        command: Command,
    },
    /// The server shuts down.
    Shutdown,
}

/// The reply to a command that was not executed.
pub fn refusal(reason: &str) -> Message {
    Message::text(serde_json::json!({"type": "refused", "why": reason}).to_string())
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Status {
    #[serde(rename = "type")]
    kind: &'static str,
    playing: bool,
    speed: Option<f64>,
    steps_per_second: f64,
    pending: Vec<String>,
    error: Option<String>,
}

/// Runs the simulation until the server shuts down. It sleeps while it is paused or no page is connected.
pub fn simulate(session: Session, broadcast: &Broadcast, events: &Receiver<Event>) {
    let now = Instant::now();
    let mut simulation = Simulation {
        session,
        broadcast,
        revision: 0,
        status: None,
        next_status: now,
        has_moved: true,
        next_frame: now,
        steps: 0,
        stepping_time: Duration::ZERO,
    };
    simulation.publish();
    let mut last = Instant::now();
    while let Some(events) = simulation.wait(events, &mut last) {
        if !simulation.process(events) {
            break;
        }
        let start = Instant::now();
        simulation.session.add_elapsed(start - last);
        last = start;
        simulation.advance(start);
        simulation.publish();
    }
    broadcast.close();
}

struct Simulation<'a> {
    session: Session,
    broadcast: &'a Broadcast,
    /// Revision of the session in the published header.
    revision: u64,
    status: Option<Status>,
    /// Earliest time of the next status that differs only in the measured speed.
    next_status: Instant,
    /// Whether the state has changed since the published frame.
    has_moved: bool,
    /// Earliest time of the next frame.
    next_frame: Instant,
    /// Steps since the speed was last measured, and the time spent on them.
    steps: u64,
    stepping_time: Duration,
}

impl Simulation<'_> {
    /// Waits until a step or frame is due or an event arrives. Returns the events that have arrived, or `None`
    /// if no more can arrive.
    fn wait(&self, events: &Receiver<Event>, last: &mut Instant) -> Option<Vec<Event>> {
        let due = self.session.time_to_next_step().filter(|_| self.broadcast.page_count() > 0);
        let first = match due {
            None => {
                let event = events.recv().ok()?;
                // time spent asleep is not simulated
                *last = Instant::now();
                Some(event)
            }
            Some(due) => {
                let to_frame = self.next_frame.saturating_duration_since(Instant::now());
                let timeout = match (due.is_zero(), self.has_moved) {
                    (true, _) => Duration::ZERO,
                    (false, true) => to_frame,
                    // a step before the next frame would not be seen
                    (false, false) => due.max(to_frame),
                };
                match events.recv_timeout(timeout) {
                    Ok(event) => Some(event),
                    Err(RecvTimeoutError::Timeout) => None,
                    Err(RecvTimeoutError::Disconnected) => return None,
                }
            }
        };
        Some(first.into_iter().chain(events.try_iter().take(QUEUE_CAPACITY)).collect())
    }

    /// Processes events in order. Returns false if the server shuts down.
    fn process(&mut self, events: Vec<Event>) -> bool {
        let mut events = events.into_iter().peekable();
        while let Some(event) = events.next() {
            let (page, command) = match event {
                Event::Connected => continue,
                Event::Shutdown => return false,
                Event::Command { page, command } => (page, command),
            };
            // of the many values of a dragged slider only the last counts
            if events.peek().is_some_and(|next| next.supersedes(&command)) {
                continue;
            }
            self.has_moved |= matches!(command, Command::Step | Command::Reset | Command::Set(_));
            match self.session.execute(&command) {
                Ok(None) => {}
                Ok(Some(toml)) => {
                    let saved = serde_json::json!({"type": "saved", "toml": toml});
                    self.broadcast.reply(page, Message::text(saved.to_string()));
                }
                Err(reason) => self.broadcast.reply(page, refusal(&reason)),
            }
        }
        true
    }

    /// Takes the steps that are due, for one time slice at most.
    fn advance(&mut self, start: Instant) {
        if self.broadcast.page_count() == 0 {
            return;
        }
        let steps = self.session.advance(&mut || start.elapsed() < TIME_SLICE);
        if steps > 0 {
            self.steps += steps;
            self.stepping_time += start.elapsed();
            self.has_moved = true;
        }
    }

    /// Publishes what has changed, at the allowed rates.
    fn publish(&mut self) {
        let now = Instant::now();
        let mut update = Update { status: self.new_status(now), ..Update::default() };
        let revision = self.session.revision();
        if revision != self.revision {
            update.header = Some(header::json(&self.session));
            self.revision = revision;
        }
        // the last frame before a pause is always shown
        let is_due =
            now >= self.next_frame || update.header.is_some() || !self.session.is_playing();
        if self.has_moved && is_due && frame::is_drawable(self.session.world()) {
            update.frame = Some(frame::record(&self.session));
            self.has_moved = false;
            // encoding frames of many bodies takes at most a fifth of the time
            self.next_frame = now + FRAME_INTERVAL.max(4 * now.elapsed());
        }
        if update.header.is_some() || update.status.is_some() || update.frame.is_some() {
            self.broadcast.publish(update);
        }
    }

    /// The status as JSON, if it has changed.
    fn new_status(&mut self, now: Instant) -> Option<String> {
        let is_due = now >= self.next_status;
        let before = self.status.as_ref();
        let mut status = Status {
            kind: "status",
            playing: self.session.is_playing(),
            speed: self.session.speed(),
            steps_per_second: before.map_or(0.0, |status| status.steps_per_second),
            pending: self.session.pending().to_vec(),
            error: self.session.error().map(str::to_owned),
        };
        // the effect of a command is published at once
        if before == Some(&status) && !is_due {
            return None;
        }
        let seconds = self.stepping_time.as_secs_f64();
        if is_due && seconds > 0.0 {
            status.steps_per_second = (self.steps as f64 / seconds).round();
            (self.steps, self.stepping_time) = (0, Duration::ZERO);
        }
        if before == Some(&status) {
            return None;
        }
        self.next_status = now + STATUS_INTERVAL;
        let text = serde_json::to_string(&status).ok();
        self.status = Some(status);
        text
    }
}

impl Event {
    /// Whether `earlier` need not be executed because this event follows it directly.
    fn supersedes(&self, earlier: &Command) -> bool {
        let Self::Command { command, .. } = self else { return false };
        match (command, earlier) {
            (Command::Set(new), Command::Set(old)) => new.key == old.key,
            (Command::MoveSpring(_), Command::MoveSpring(_))
            | (Command::Speed(_), Command::Speed(_)) => true,
            _ => false,
        }
    }
}
