//! The part of HTTP/1.1 that the page and its WebSocket need: one request per connection, of limited size.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// Largest request head, in bytes.
const MAX_HEAD_BYTES: usize = 8 << 10;
/// Largest number of headers in a request.
const MAX_HEADERS: usize = 64;

/// The head of a request.
#[derive(Debug, Default, PartialEq)]
pub struct Request {
    /// The method.
    pub method: String,
    /// The target without its query.
    pub path: String,
    /// All headers, with names in lower case.
    headers: Vec<(String, String)>,
    /// The bytes received after the head.
    pub rest: Vec<u8>,
}

/// A request that is refused.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The HTTP status.
    pub status: u16,
    /// The reason, sent as the body of the response.
    pub reason: String,
}

impl Refusal {
    fn new(status: u16, reason: impl Into<String>) -> Self {
        Self { status, reason: reason.into() }
    }
}

impl Request {
    /// Reads a request head, which must be complete within `timeout`.
    ///
    /// # Errors
    /// The refusal to answer with, or `None` if the connection is closed.
    pub fn read(stream: &mut TcpStream, timeout: Duration) -> Result<Self, Option<Refusal>> {
        let deadline = Instant::now() + timeout;
        let mut bytes = Vec::new();
        let mut buffer = [0; 1024];
        loop {
            // the deadline is for the whole head: a client that sends byte by byte does not extend it
            let remaining = deadline.saturating_duration_since(Instant::now());
            if remaining.is_zero() {
                return Err(Some(Refusal::new(408, "the request took too long")));
            }
            stream.set_read_timeout(Some(remaining)).map_err(|_| None)?;
            match stream.read(&mut buffer) {
                Ok(0) => return Err(None),
                Ok(count) => bytes.extend(&buffer[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if is_timeout(&error) => {}
                Err(_) => return Err(None),
            }
            if let Some(request) = Self::parse(&bytes).map_err(Some)? {
                return Ok(request);
            }
            if bytes.len() >= MAX_HEAD_BYTES {
                return Err(Some(Refusal::new(431, "the head of the request is too long")));
            }
        }
    }

    /// Parses a request head; `None` while it is incomplete.
    fn parse(bytes: &[u8]) -> Result<Option<Self>, Refusal> {
        let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
        let mut parsed = httparse::Request::new(&mut headers);
        let length = match parsed.parse(bytes) {
            Ok(httparse::Status::Complete(length)) => length,
            Ok(httparse::Status::Partial) => return Ok(None),
            Err(httparse::Error::TooManyHeaders) => {
                return Err(Refusal::new(431, "the request has too many headers"));
            }
            Err(error) => return Err(Refusal::new(400, format!("not an HTTP request: {error}"))),
        };
        let owned = |header: &httparse::Header| {
            let value = String::from_utf8_lossy(header.value).trim().to_owned();
            (header.name.to_ascii_lowercase(), value)
        };
        let target = parsed.path.unwrap_or_default();
        Ok(Some(Self {
            method: parsed.method.unwrap_or_default().to_owned(),
            path: target.split('?').next().unwrap_or_default().to_owned(),
            headers: parsed.headers.iter().map(owned).collect(),
            rest: bytes[length..].to_vec(),
        }))
    }

    fn values(&self, name: &str) -> Vec<&str> {
        let matching = self.headers.iter().filter(|(key, _)| key == name);
        matching.map(|(_, value)| value.as_str()).collect()
    }

    fn first_value(&self, name: &str) -> Option<&str> {
        self.values(name).first().copied()
    }

    /// Checks that `Host` and `Origin` name this machine and port.
    ///
    /// This keeps out pages of other sites: they could otherwise make a browser on this machine connect to the
    /// server, also under a host name that resolves to the loopback address (DNS rebinding).
    ///
    /// # Errors
    /// Status 400 or 403.
    pub fn check_same_origin(&self, port: u16) -> Result<(), Refusal> {
        let [host] = self.values("host")[..] else {
            return Err(Refusal::new(400, "the request must have exactly one Host header"));
        };
        let is_own = |name: &str| {
            let name = name.to_ascii_lowercase();
            ["127.0.0.1", "localhost", "[::1]"]
                .iter()
                .any(|host| name == format!("{host}:{port}") || (port == 80 && name == *host))
        };
        let origins = self.values("origin");
        let mut hosts = origins.iter().map(|origin| origin.strip_prefix("http://"));
        if is_own(host) && hosts.all(|host| host.is_some_and(is_own)) {
            return Ok(());
        }
        Err(Refusal::new(
            403,
            format!(
                "the address of this server is http://127.0.0.1:{port}/ or http://localhost:{port}/; \
                 through a tunnel, use the same port at both ends"
            ),
        ))
    }

    /// The key of a WebSocket request (RFC 6455, section 4.2.1).
    ///
    /// # Errors
    /// What is wrong with the request.
    pub fn websocket_key(&self) -> Result<&str, Refusal> {
        let has_token = |name: &str, token: &str| {
            let values = self.values(name);
            values.iter().flat_map(|v| v.split(',')).any(|v| v.trim().eq_ignore_ascii_case(token))
        };
        if !has_token("upgrade", "websocket") || !has_token("connection", "upgrade") {
            return Err(Refusal::new(426, "/live accepts WebSocket connections only"));
        }
        if self.first_value("sec-websocket-version") != Some("13") {
            return Err(Refusal::new(
                426,
                "/live supports version 13 of the WebSocket protocol only",
            ));
        }
        if self.values("origin").is_empty() {
            return Err(Refusal::new(403, "a WebSocket request must have an Origin header"));
        }
        // 16 bytes in base64
        match self.values("sec-websocket-key")[..] {
            [key] if key.len() == 24 && key.is_ascii() => Ok(key),
            _ => Err(Refusal::new(400, "Sec-WebSocket-Key is missing or invalid")),
        }
    }
}

/// Whether a read or write has timed out.
pub fn is_timeout(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

/// The head of a response. Its headers forbid framing, MIME sniffing, caching, and loading anything from other
/// servers.
pub fn response_head(status: u16, port: u16, content_type: &str, length: usize) -> String {
    let reason = match status {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        426 => "Upgrade Required",
        431 => "Request Header Fields Too Large",
        503 => "Service Unavailable",
        _ => "Error",
    };
    let extra = match status {
        405 => "Allow: GET, HEAD\r\n",
        426 => "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n",
        _ => "",
    };
    format!(
        "HTTP/1.1 {status} {reason}\r\n\
         Content-Type: {content_type}; charset=utf-8\r\n\
         Content-Length: {length}\r\n\
         Connection: close\r\n\
         Cache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\n\
         X-Frame-Options: DENY\r\n\
         Referrer-Policy: no-referrer\r\n\
         Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline' data: blob:; \
         worker-src data: blob:; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; \
         connect-src 'self' ws://127.0.0.1:{port} ws://localhost:{port}; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\
         {extra}\r\n"
    )
}

/// Sends a response and closes the connection. Failures are ignored, since the client is gone then.
pub fn respond(mut stream: TcpStream, head: &str, body: &[u8]) {
    let sent = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(body));
    if sent.is_ok() {
        shut_down(stream, Duration::from_secs(1));
    }
}

/// Sends a refusal and closes the connection.
pub fn refuse(stream: TcpStream, port: u16, refusal: &Refusal) {
    let body = format!("{}\n", refusal.reason);
    let head = response_head(refusal.status, port, "text/plain", body.len());
    respond(stream, &head, body.as_bytes());
}

/// Closes the write side of a connection and waits up to `timeout` for the other side to close.
///
/// Unread input at the time of closing makes TCP reset the connection, and the other side may then lose data that
/// it has not received yet.
pub fn shut_down(mut stream: TcpStream, timeout: Duration) {
    let deadline = Instant::now() + timeout;
    let mut buffer = [0; 4096];
    if stream.shutdown(Shutdown::Write).is_err() {
        return;
    }
    loop {
        let remaining = deadline.saturating_duration_since(Instant::now());
        if remaining.is_zero() || stream.set_read_timeout(Some(remaining)).is_err() {
            return;
        }
        match stream.read(&mut buffer) {
            Ok(0) | Err(_) => return,
            Ok(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn request(headers: &str) -> Request {
        let text = format!("GET /live?a=/../b HTTP/1.1\r\n{headers}\r\n");
        Request::parse(text.as_bytes()).unwrap().unwrap()
    }

    #[test]
    fn only_the_servers_own_address_is_accepted() {
        let status = |headers: &str| request(headers).check_same_origin(8642).map_err(|r| r.status);
        for host in ["127.0.0.1:8642", "localhost:8642", "LOCALHOST:8642", "[::1]:8642"] {
            assert_eq!(status(&format!("Host: {host}\r\n")), Ok(()), "{host}");
            let both = format!("Host: {host}\r\nOrigin: http://127.0.0.1:8642\r\n");
            assert_eq!(status(&both), Ok(()), "{host}");
        }
        for host in ["evil.example:8642", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:8642.evil", ""] {
            assert_eq!(status(&format!("Host: {host}\r\n")), Err(403), "{host}");
        }
        for origin in ["null", "http://evil.example", "https://localhost:8642", "localhost:8642"] {
            let both = format!("Host: localhost:8642\r\nOrigin: {origin}\r\n");
            assert_eq!(status(&both), Err(403), "{origin}");
        }
        assert_eq!(status(""), Err(400));
        assert_eq!(status("Host: localhost:8642\r\nHost: localhost:8642\r\n"), Err(400));
        assert_eq!(request("").path, "/live");
    }

    #[test]
    fn a_websocket_request_must_have_all_headers() {
        let good = "Upgrade: WebSocket\r\nConnection: keep-alive, Upgrade\r\nOrigin: x\r\n\
                    Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
        assert_eq!(request(good).websocket_key(), Ok("dGhlIHNhbXBsZSBub25jZQ=="));
        for (from, to, status) in [
            ("WebSocket\r\nC", "h2c\r\nC", 426),
            ("Upgrade\r\nO", "close\r\nO", 426),
            ("13", "8", 426),
            ("Origin: x\r\n", "", 403),
            ("nonce", "n", 200),
            ("dGhlIHNhbXBsZSBub25jZQ==", "short", 400),
        ] {
            let answer =
                request(&good.replacen(from, to, 1)).websocket_key().map_err(|r| r.status).err();
            assert_eq!(answer.unwrap_or(200), status, "{from}");
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_parsed_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            if let Ok(Some(request)) = Request::parse(&bytes) {
                let _ = (request.check_same_origin(1), request.websocket_key());
            }
        }
    }
}
