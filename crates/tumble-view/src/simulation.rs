//! The thread that steps the simulation, takes commands between steps and publishes what is new.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use serde::Serialize;
use tungstenite::Message;

use crate::command::Command;
use crate::hub::{Hub, News, PageId};
use crate::{Session, frame, head};

/// How many commands may wait.
pub const MOST_WAITING: usize = 256;

/// Commands are looked for after so much stepping.
const SLICE: Duration = Duration::from_millis(4);
/// The least time between two frames.
const FRAME: Duration = Duration::from_nanos(1_000_000_000 / 60);
/// The least time between two statuses that say no more than the speed.
const STATUS: Duration = Duration::from_millis(250);

/// What the simulation is told.
#[derive(Debug)]
pub enum Input {
    /// A page has come.
    Joined,
    /// A page has asked for something.
    Said {
        /// Which page.
        page: PageId,
        /// What it asks for.
        command: Command,
    },
    /// It is over.
    Close,
}

/// The answer to a command that is not carried out.
pub fn refused(why: &str) -> Message {
    Message::text(serde_json::json!({"type": "refused", "why": why}).to_string())
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

/// Steps and tells until it is over. Without a page, or paused, it sleeps.
pub fn simulate(session: Session, hub: &Hub, inputs: &Receiver<Input>) {
    let now = Instant::now();
    let mut simulation = Simulation {
        session,
        hub,
        revision: 0,
        status: None,
        status_at: now,
        has_moved: true,
        frame_at: now,
        steps: 0,
        stepping: Duration::ZERO,
    };
    simulation.publish();
    let mut last = Instant::now();
    while let Some(waiting) = simulation.wait(inputs, &mut last) {
        if !simulation.carry_out(waiting) {
            break;
        }
        let start = Instant::now();
        simulation.session.owe(start - last);
        last = start;
        simulation.advance(start);
        simulation.publish();
    }
    hub.close();
}

struct Simulation<'a> {
    session: Session,
    hub: &'a Hub,
    /// The revision of the head that was published.
    revision: u64,
    status: Option<Status>,
    status_at: Instant,
    /// Whether there are steps that no frame has shown.
    has_moved: bool,
    /// When the next frame may be published.
    frame_at: Instant,
    /// Steps since the last status, and the time they took.
    steps: u64,
    stepping: Duration,
}

impl Simulation<'_> {
    /// Waits for the next step or command; what is to be carried out, `None` when nobody is left to
    /// say anything.
    fn wait(&self, inputs: &Receiver<Input>, last: &mut Instant) -> Option<Vec<Input>> {
        let due = self.session.due_in().filter(|_| self.hub.page_count() > 0);
        let first = match due {
            None => {
                let input = inputs.recv().ok()?;
                // time that passed in sleep is not owed
                *last = Instant::now();
                Some(input)
            }
            Some(due) => {
                let frame = self.frame_at.saturating_duration_since(Instant::now());
                let wait = match (due.is_zero(), self.has_moved) {
                    (true, _) => Duration::ZERO,
                    (false, true) => frame,
                    // no need to wake for a step that no frame would show
                    (false, false) => due.max(frame),
                };
                match inputs.recv_timeout(wait) {
                    Ok(input) => Some(input),
                    Err(RecvTimeoutError::Timeout) => None,
                    Err(RecvTimeoutError::Disconnected) => return None,
                }
            }
        };
        Some(first.into_iter().chain(inputs.try_iter().take(MOST_WAITING)).collect())
    }

    /// Carries out commands in their order; false when it is over.
    fn carry_out(&mut self, waiting: Vec<Input>) -> bool {
        let mut waiting = waiting.into_iter().peekable();
        while let Some(input) = waiting.next() {
            let (page, command) = match input {
                Input::Joined => continue,
                Input::Close => return false,
                Input::Said { page, command } => (page, command),
            };
            // of a slider on its way, only the last place counts
            if waiting.peek().is_some_and(|next| next.outdates(&command)) {
                continue;
            }
            self.has_moved |= matches!(command, Command::Step | Command::Reset | Command::Set(_));
            match self.session.carry_out(&command) {
                Ok(None) => {}
                Ok(Some(toml)) => {
                    let saved = serde_json::json!({"type": "saved", "toml": toml});
                    self.hub.answer(page, Message::text(saved.to_string()));
                }
                Err(why) => self.hub.answer(page, refused(&why)),
            }
        }
        true
    }

    fn advance(&mut self, start: Instant) {
        if self.hub.page_count() == 0 {
            return;
        }
        let steps = self.session.advance(&mut || start.elapsed() < SLICE);
        if steps > 0 {
            self.steps += steps;
            self.stepping += start.elapsed();
            self.has_moved = true;
        }
    }

    /// Tells all pages what is new, where it is time to.
    fn publish(&mut self) {
        let now = Instant::now();
        let mut news = News { status: self.new_status(now), ..News::default() };
        let revision = self.session.revision();
        if revision != self.revision {
            news.head = Some(head::json(&self.session));
            self.revision = revision;
        }
        // the last moment before a pause is always shown
        let is_due = now >= self.frame_at || news.head.is_some() || !self.session.is_playing();
        if self.has_moved && is_due && frame::is_drawable(self.session.world()) {
            news.frame = Some(frame::record(&self.session));
            self.has_moved = false;
            // frames of many bodies leave time for the steps between them
            self.frame_at = now + FRAME.max(4 * now.elapsed());
        }
        if news.head.is_some() || news.status.is_some() || news.frame.is_some() {
            self.hub.publish(news);
        }
    }

    /// The status, if there is something new in it.
    fn new_status(&mut self, now: Instant) -> Option<String> {
        let is_due = now >= self.status_at;
        let before = self.status.as_ref();
        let mut status = Status {
            kind: "status",
            playing: self.session.is_playing(),
            speed: self.session.speed(),
            steps_per_second: before.map_or(0.0, |status| status.steps_per_second),
            pending: self.session.pending().to_vec(),
            error: self.session.error().map(str::to_owned),
        };
        // what a command has changed is told at once
        if before == Some(&status) && !is_due {
            return None;
        }
        let seconds = self.stepping.as_secs_f64();
        if is_due && seconds > 0.0 {
            status.steps_per_second = (self.steps as f64 / seconds).round();
            (self.steps, self.stepping) = (0, Duration::ZERO);
        }
        if before == Some(&status) {
            return None;
        }
        self.status_at = now + STATUS;
        let text = serde_json::to_string(&status).ok();
        self.status = Some(status);
        text
    }
}

impl Input {
    /// Whether a command need not be carried out, because this one comes right after it.
    fn outdates(&self, earlier: &Command) -> bool {
        let Self::Said { command, .. } = self else { return false };
        match (command, earlier) {
            (Command::Set(new), Command::Set(old)) => new.key == old.key,
            (Command::Move(_), Command::Move(_)) | (Command::Speed(_), Command::Speed(_)) => true,
            _ => false,
        }
    }
}
