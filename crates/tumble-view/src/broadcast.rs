//! The latest results for all pages, and replies to single pages.
//!
//! The simulation thread publishes, the writer thread of each page waits for the next message. Only the latest
//! header, status and frame are stored, so that a slow page skips the older ones.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tungstenite::protocol::CloseFrame;
use tungstenite::{Bytes, Message, Utf8Bytes};

/// A page with more unsent replies than this is disconnected.
const MAX_REPLIES: usize = 1024;
/// A page with more bytes of unsent replies is disconnected; a single reply may have any length.
const MAX_REPLY_BYTES: usize = 64 << 20;

/// Identifies a connected page; never reused.
pub type PageId = u64;

/// New results for all pages.
#[derive(Debug, Default)]
pub struct Update {
    /// A new header; the first frame with it is published in the same update.
    pub header: Option<String>,
    /// A new status.
    pub status: Option<String>,
    /// A new frame.
    pub frame: Option<Vec<u8>>,
}

/// What a page's writer thread does next.
#[derive(Debug)]
pub enum Outgoing {
    /// Send this message.
    Message(Message),
    /// Nothing to send: the timeout has passed.
    TimedOut,
    /// Close the connection.
    Close(Option<CloseFrame>),
}

/// The versions that a page has received.
#[derive(Debug, Default)]
pub struct Received {
    header: u64,
    status: u64,
    frame: u64,
}

/// Shared by the simulation thread and the threads of all pages.
#[derive(Debug, Default)]
pub struct Broadcast {
    inner: Mutex<Inner>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Inner {
    header: Latest<Utf8Bytes>,
    status: Latest<Utf8Bytes>,
    frame: Latest<Bytes>,
    pages: BTreeMap<PageId, Page>,
    next_page: PageId,
    closed: bool,
}

/// A value with its version, which counts its changes.
#[derive(Debug, Default)]
struct Latest<T> {
    value: T,
    version: u64,
}

#[derive(Debug, Default)]
struct Page {
    replies: VecDeque<Message>,
    reply_bytes: usize,
    /// Set once the connection is to be closed.
    close: Option<Option<CloseFrame>>,
}

impl<T: Clone> Latest<T> {
    fn set(&mut self, value: Option<impl Into<T>>) {
        if let Some(value) = value {
            self.value = value.into();
            self.version += 1;
        }
    }

    /// The value, if it is newer than `received`, which is brought up to date.
    fn newer_than(&self, received: &mut u64) -> Option<T> {
        let is_new = *received < self.version;
        *received = self.version;
        is_new.then(|| self.value.clone())
    }
}

impl Broadcast {
    // no method panics while it holds the lock, so a poisoned lock guards consistent data
    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Number of connected pages.
    pub fn page_count(&self) -> usize {
        self.lock().pages.len()
    }

    /// Adds a page.
    pub fn add_page(&self) -> PageId {
        let mut inner = self.lock();
        let page = inner.next_page;
        inner.next_page += 1;
        inner.pages.insert(page, Page::default());
        page
    }

    /// Closes the connection to a page, after the replies that are queued for it.
    pub fn close_page(&self, page: PageId, close: Option<CloseFrame>) {
        if let Some(page) = self.lock().pages.get_mut(&page) {
            page.close.get_or_insert(close);
        }
        self.changed.notify_all();
    }

    /// Removes a page.
    pub fn remove_page(&self, page: PageId) {
        self.lock().pages.remove(&page);
        self.changed.notify_all();
    }

    /// Closes the connections to all pages.
    pub fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_all();
    }

    /// Replaces the results for all pages, in one step.
    pub fn publish(&self, update: Update) {
        let mut inner = self.lock();
        inner.header.set(update.header);
        inner.status.set(update.status);
        inner.frame.set(update.frame);
        self.changed.notify_all();
    }

    /// Queues a reply to one page. A page with too many unsent replies is disconnected.
    pub fn reply(&self, page: PageId, reply: Message) {
        if let Some(page) = self.lock().pages.get_mut(&page) {
            let bytes = page.reply_bytes.saturating_add(reply.len());
            let is_full = page.replies.len() >= MAX_REPLIES || bytes > MAX_REPLY_BYTES;
            if is_full && !page.replies.is_empty() {
                page.close.get_or_insert(None);
            } else {
                page.reply_bytes = bytes;
                page.replies.push_back(reply);
            }
        }
        self.changed.notify_all();
    }

    /// Waits up to `timeout` for the next message to a page.
    pub fn wait(&self, page: PageId, received: &mut Received, timeout: Duration) -> Outgoing {
        let deadline = Instant::now() + timeout;
        let mut inner = self.lock();
        loop {
            if let Some(next) = inner.next(page, received) {
                return next;
            }
            // replies to other pages wake this thread too
            let remaining = deadline.saturating_duration_since(Instant::now());
            if remaining.is_zero() {
                return Outgoing::TimedOut;
            }
            let result = self.changed.wait_timeout(inner, remaining);
            inner = result.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl Inner {
    fn next(&mut self, page: PageId, received: &mut Received) -> Option<Outgoing> {
        let Some(page) = self.pages.get_mut(&page).filter(|_| !self.closed) else {
            return Some(Outgoing::Close(None));
        };
        // a page needs the header before the frames it describes
        if let Some(header) = self.header.newer_than(&mut received.header) {
            return Some(Outgoing::Message(Message::Text(header)));
        }
        if let Some(reply) = page.replies.pop_front() {
            page.reply_bytes -= reply.len();
            return Some(Outgoing::Message(reply));
        }
        if let Some(close) = &page.close {
            return Some(Outgoing::Close(close.clone()));
        }
        if let Some(status) = self.status.newer_than(&mut received.status) {
            return Some(Outgoing::Message(Message::Text(status)));
        }
        let frame = self.frame.newer_than(&mut received.frame);
        frame.map(|frame| Outgoing::Message(Message::Binary(frame)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn next(broadcast: &Broadcast, page: PageId, received: &mut Received) -> String {
        match broadcast.wait(page, received, Duration::from_millis(1)) {
            Outgoing::Message(Message::Binary(bytes)) => format!("frame {bytes:?}"),
            Outgoing::Message(message) => message.to_string(),
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn a_late_page_receives_only_the_latest_results() {
        let broadcast = Broadcast::default();
        let page = broadcast.add_page();
        let mut received = Received::default();
        assert_eq!(next(&broadcast, page, &mut received), "TimedOut");
        for frame in 0..3 {
            broadcast.publish(Update {
                header: Some(format!("header {frame}")),
                status: Some(format!("status {frame}")),
                frame: Some(vec![frame]),
            });
        }
        broadcast.reply(page, Message::text("reply"));
        broadcast.reply(page + 1, Message::text("to a page that does not exist"));
        let messages: Vec<_> = (0..5).map(|_| next(&broadcast, page, &mut received)).collect();
        assert_eq!(messages, ["header 2", "reply", "status 2", "frame b\"\\x02\"", "TimedOut"]);
        broadcast.close_page(page, None);
        assert_eq!(next(&broadcast, page, &mut received), "Close(None)");
        broadcast.remove_page(page);
        assert_eq!(broadcast.page_count(), 0);
        assert_eq!(next(&broadcast, page, &mut received), "Close(None)");
    }

    #[test]
    fn a_page_with_too_many_unsent_replies_is_disconnected() {
        let broadcast = Broadcast::default();
        let page = broadcast.add_page();
        for _ in 0..2 * MAX_REPLIES {
            broadcast.reply(page, Message::text("x"));
        }
        let mut received = Received::default();
        for _ in 0..MAX_REPLIES {
            assert_eq!(next(&broadcast, page, &mut received), "x");
        }
        assert_eq!(next(&broadcast, page, &mut received), "Close(None)");
    }
}
