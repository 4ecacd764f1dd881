//! Between the simulation and the pages: the latest of everything, and answers to single pages.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tungstenite::protocol::CloseFrame;
use tungstenite::{Bytes, Message, Utf8Bytes};

/// A page with more answers waiting than this does not listen.
const MOST_ANSWERS: usize = 1024;
/// Nor does one with more bytes of them; one answer of any length may wait.
const MOST_ANSWER_BYTES: usize = 64 << 20;

/// Which page: a number that is given once.
pub type PageId = u64;

/// What is new to all pages.
#[derive(Debug, Default)]
pub struct News {
    /// A new head; the frame that goes with it comes along.
    pub head: Option<String>,
    /// A new status.
    pub status: Option<String>,
    /// A new frame.
    pub frame: Option<Vec<u8>>,
}

/// The next thing that a page is to be told.
#[derive(Debug)]
pub enum Next {
    /// This message.
    Send(Message),
    /// Nothing for as long as it was waited.
    Nothing,
    /// Goodbye.
    Farewell(Option<CloseFrame>),
}

/// What a page has been told so far.
#[derive(Debug, Default)]
pub struct Seen {
    head: u64,
    status: u64,
    frame: u64,
}

/// See the module's own words.
#[derive(Debug, Default)]
pub struct Hub {
    inner: Mutex<Inner>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Inner {
    head: Latest<Utf8Bytes>,
    status: Latest<Utf8Bytes>,
    frame: Latest<Bytes>,
    pages: BTreeMap<PageId, Page>,
    next_page: PageId,
    closed: bool,
}

/// A value and how often it was replaced.
#[derive(Debug, Default)]
struct Latest<T> {
    value: T,
    number: u64,
}

#[derive(Debug, Default)]
struct Page {
    answers: VecDeque<Message>,
    bytes: usize,
    farewell: Option<Option<CloseFrame>>,
}

impl<T: Clone> Latest<T> {
    fn put(&mut self, value: Option<impl Into<T>>) {
        if let Some(value) = value {
            self.value = value.into();
            self.number += 1;
        }
    }

    /// The value, if it is new.
    fn take(&self, seen: &mut u64) -> Option<T> {
        let is_new = *seen < self.number;
        *seen = self.number;
        is_new.then(|| self.value.clone())
    }
}

impl Hub {
    // nothing here panics half way through a change
    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How many pages look.
    pub fn page_count(&self) -> usize {
        self.lock().pages.len()
    }

    /// A page comes.
    pub fn join(&self) -> PageId {
        let mut inner = self.lock();
        let page = inner.next_page;
        inner.next_page += 1;
        inner.pages.insert(page, Page::default());
        page
    }

    /// A page is to be told goodbye, after the answers that wait for it.
    pub fn dismiss(&self, page: PageId, farewell: Option<CloseFrame>) {
        if let Some(page) = self.lock().pages.get_mut(&page) {
            page.farewell.get_or_insert(farewell);
        }
        self.changed.notify_all();
    }

    /// A page is gone.
    pub fn leave(&self, page: PageId) {
        self.lock().pages.remove(&page);
        self.changed.notify_all();
    }

    /// All pages are told goodbye.
    pub fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_all();
    }

    /// Replaces what all pages are to know, in one move.
    pub fn publish(&self, news: News) {
        let mut inner = self.lock();
        inner.head.put(news.head);
        inner.status.put(news.status);
        inner.frame.put(news.frame);
        self.changed.notify_all();
    }

    /// Tells one page something. A page that lets too much wait is told goodbye.
    pub fn answer(&self, page: PageId, answer: Message) {
        if let Some(page) = self.lock().pages.get_mut(&page) {
            let bytes = page.bytes.saturating_add(answer.len());
            let is_full = page.answers.len() >= MOST_ANSWERS || bytes > MOST_ANSWER_BYTES;
            if is_full && !page.answers.is_empty() {
                page.farewell.get_or_insert(None);
            } else {
                page.bytes = bytes;
                page.answers.push_back(answer);
            }
        }
        self.changed.notify_all();
    }

    /// The next thing that a page is to be told, waited for if need be.
    pub fn next(&self, page: PageId, seen: &mut Seen, patience: Duration) -> Next {
        let deadline = Instant::now() + patience;
        let mut inner = self.lock();
        loop {
            if let Some(next) = inner.next(page, seen) {
                return next;
            }
            // what is news to others wakes this page too
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Next::Nothing;
            }
            let woken = self.changed.wait_timeout(inner, left);
            inner = woken.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl Inner {
    fn next(&mut self, page: PageId, seen: &mut Seen) -> Option<Next> {
        let Some(page) = self.pages.get_mut(&page).filter(|_| !self.closed) else {
            return Some(Next::Farewell(None));
        };
        // a head comes before the frames that it is the head of
        if let Some(head) = self.head.take(&mut seen.head) {
            return Some(Next::Send(Message::Text(head)));
        }
        if let Some(answer) = page.answers.pop_front() {
            page.bytes -= answer.len();
            return Some(Next::Send(answer));
        }
        if let Some(farewell) = &page.farewell {
            return Some(Next::Farewell(farewell.clone()));
        }
        if let Some(status) = self.status.take(&mut seen.status) {
            return Some(Next::Send(Message::Text(status)));
        }
        self.frame.take(&mut seen.frame).map(|frame| Next::Send(Message::Binary(frame)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn next(hub: &Hub, page: PageId, seen: &mut Seen) -> String {
        match hub.next(page, seen, Duration::from_millis(1)) {
            Next::Send(Message::Binary(bytes)) => format!("frame {bytes:?}"),
            Next::Send(message) => message.to_string(),
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn a_late_page_gets_the_latest_of_everything_and_misses_the_rest() {
        let hub = Hub::default();
        let page = hub.join();
        let mut seen = Seen::default();
        assert_eq!(next(&hub, page, &mut seen), "Nothing");
        for frame in 0..3 {
            let (head, status) = (Some(format!("head {frame}")), Some(format!("status {frame}")));
            hub.publish(News { head, status, frame: Some(vec![frame]) });
        }
        hub.answer(page, Message::text("answer"));
        hub.answer(page + 1, Message::text("to nobody"));
        let told: Vec<_> = (0..5).map(|_| next(&hub, page, &mut seen)).collect();
        assert_eq!(told, ["head 2", "answer", "status 2", "frame b\"\\x02\"", "Nothing"]);
        hub.dismiss(page, None);
        assert_eq!(next(&hub, page, &mut seen), "Farewell(None)");
        hub.leave(page);
        assert_eq!(hub.page_count(), 0);
        assert_eq!(next(&hub, page, &mut seen), "Farewell(None)");
    }

    #[test]
    fn a_page_that_does_not_listen_is_let_go() {
        let hub = Hub::default();
        let page = hub.join();
        for _ in 0..2 * MOST_ANSWERS {
            hub.answer(page, Message::text("x"));
        }
        let mut seen = Seen::default();
        for _ in 0..MOST_ANSWERS {
            assert_eq!(next(&hub, page, &mut seen), "x");
        }
        assert_eq!(next(&hub, page, &mut seen), "Farewell(None)");
    }
}
