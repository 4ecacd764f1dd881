//! Timeouts of the server and the number of its connections.

use std::time::Duration;

/// Limits of the server.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Time for a complete request head to arrive.
    pub request_timeout: Duration,
    /// Time for a write to make progress.
    pub write_timeout: Duration,
    /// Time between two pings to a page.
    pub ping_interval: Duration,
    /// A page that sends nothing for this long, not even a pong, is disconnected.
    pub idle_timeout: Duration,
    /// Largest number of connections at one time.
    pub max_connections: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            request_timeout: Duration::from_secs(5),
            write_timeout: Duration::from_secs(10),
            ping_interval: Duration::from_secs(20),
            idle_timeout: Duration::from_secs(90),
            max_connections: 32,
        }
    }
}
