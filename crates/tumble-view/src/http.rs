//! As much of HTTP as a page and a WebSocket need: one request a connection, read with bounds.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// The head of a request may have so many bytes.
const MOST_BYTES: usize = 8 << 10;
/// And so many lines.
const MOST_HEADERS: usize = 64;

/// A request, as far as it matters here.
#[derive(Debug, Default, PartialEq)]
pub struct Request {
    /// The method.
    pub method: String,
    /// What is asked for, without the part after `?`. It is compared with two names and no more.
    pub path: String,
    /// All headers, names in lower case.
    headers: Vec<(String, String)>,
    /// What came after the head.
    pub rest: Vec<u8>,
}

/// A request that is not granted.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The status.
    pub status: u16,
    /// Why, for people.
    pub why: String,
}

impl Refusal {
    fn new(status: u16, why: impl Into<String>) -> Self {
        Self { status, why: why.into() }
    }
}

impl Request {
    /// Reads a request within `patience`.
    ///
    /// # Errors
    /// An answer where one can be given; `None` where nobody is there any more.
    pub fn read(stream: &mut TcpStream, patience: Duration) -> Result<Self, Option<Refusal>> {
        let deadline = Instant::now() + patience;
        let mut bytes = Vec::new();
        let mut room = [0; 1024];
        loop {
            // the whole head has this long, not each of its bytes
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(Some(Refusal::new(408, "the request took too long")));
            }
            stream.set_read_timeout(Some(left)).map_err(|_| None)?;
            match stream.read(&mut room) {
                Ok(0) => return Err(None),
                Ok(count) => bytes.extend(&room[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if is_timeout(&error) => {}
                Err(_) => return Err(None),
            }
            if let Some(request) = Self::parse(&bytes).map_err(Some)? {
                return Ok(request);
            }
            if bytes.len() >= MOST_BYTES {
                return Err(Some(Refusal::new(431, "the head of the request is too long")));
            }
        }
    }

    /// `None` while the head is not complete.
    fn parse(bytes: &[u8]) -> Result<Option<Self>, Refusal> {
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        let mut parsed = httparse::Request::new(&mut headers);
        let length = match parsed.parse(bytes) {
            Ok(httparse::Status::Complete(length)) => length,
            Ok(httparse::Status::Partial) => return Ok(None),
            Err(httparse::Error::TooManyHeaders) => {
                return Err(Refusal::new(431, "the request has too many headers"));
            }
            Err(error) => return Err(Refusal::new(400, format!("this is no request: {error}"))),
        };
        let text = |header: &httparse::Header| {
            let value = String::from_utf8_lossy(header.value).trim().to_owned();
            (header.name.to_ascii_lowercase(), value)
        };
        let target = parsed.path.unwrap_or_default();
        Ok(Some(Self {
            method: parsed.method.unwrap_or_default().to_owned(),
            path: target.split('?').next().unwrap_or_default().to_owned(),
            headers: parsed.headers.iter().map(text).collect(),
            rest: bytes[length..].to_vec(),
        }))
    }

    fn all(&self, name: &str) -> Vec<&str> {
        let named = self.headers.iter().filter(|(key, _)| key == name);
        named.map(|(_, value)| value.as_str()).collect()
    }

    fn one(&self, name: &str) -> Option<&str> {
        self.all(name).first().copied()
    }

    /// Whether this is somebody who has typed our address into a browser here, and not a page from
    /// elsewhere that makes a browser ask us: `Host` and `Origin` name this machine and port.
    ///
    /// # Errors
    /// Status 400 or 403.
    pub fn is_from_here(&self, port: u16) -> Result<(), Refusal> {
        let [host] = self.all("host")[..] else {
            return Err(Refusal::new(400, "the request must name one Host"));
        };
        let is_ours = |name: &str| {
            let name = name.to_ascii_lowercase();
            ["127.0.0.1", "localhost", "[::1]"]
                .iter()
                .any(|host| name == format!("{host}:{port}") || (port == 80 && name == *host))
        };
        let origins = self.all("origin");
        let mut hosts = origins.iter().map(|origin| origin.strip_prefix("http://"));
        if is_ours(host) && hosts.all(|host| host.is_some_and(is_ours)) {
            return Ok(());
        }
        Err(Refusal::new(
            403,
            format!(
                "this server answers to http://127.0.0.1:{port}/ and http://localhost:{port}/ only; \
                 through a tunnel, use the same port at both ends"
            ),
        ))
    }

    /// The key of a request for a WebSocket.
    ///
    /// # Errors
    /// What is missing from such a request.
    pub fn websocket_key(&self) -> Result<&str, Refusal> {
        let has = |name: &str, word: &str| {
            let values = self.all(name);
            values.iter().flat_map(|v| v.split(',')).any(|v| v.trim().eq_ignore_ascii_case(word))
        };
        if !has("upgrade", "websocket") || !has("connection", "upgrade") {
            return Err(Refusal::new(426, "/live is a WebSocket"));
        }
        if self.one("sec-websocket-version") != Some("13") {
            return Err(Refusal::new(426, "/live speaks version 13 of the WebSocket protocol"));
        }
        if self.all("origin").is_empty() {
            return Err(Refusal::new(403, "a WebSocket must name its Origin"));
        }
        // sixteen bytes in base64
        match self.all("sec-websocket-key")[..] {
            [key] if key.len() == 24 && key.is_ascii() => Ok(key),
            _ => Err(Refusal::new(400, "Sec-WebSocket-Key is missing or not one")),
        }
    }
}

/// Whether a read or write has only run out of time.
pub fn is_timeout(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

/// The head of a response, with what keeps a page from being framed, sniffed, kept, or made to load
/// anything from elsewhere.
pub fn response_head(status: u16, port: u16, kind: &str, length: usize) -> String {
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
    let more = match status {
        405 => "Allow: GET, HEAD\r\n",
        426 => "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n",
        _ => "",
    };
    format!(
        "HTTP/1.1 {status} {reason}\r\n\
         Content-Type: {kind}; charset=utf-8\r\n\
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
         {more}\r\n"
    )
}

/// Answers and hangs up. Nobody is left to be told of a failure.
pub fn respond(mut stream: TcpStream, head: &str, body: &[u8]) {
    let sent = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(body));
    if sent.is_ok() {
        hang_up(stream, Duration::from_secs(1));
    }
}

/// Says why not, and hangs up.
pub fn refuse(stream: TcpStream, port: u16, refusal: &Refusal) {
    let body = format!("{}\n", refusal.why);
    let head = response_head(refusal.status, port, "text/plain", body.len());
    respond(stream, &head, body.as_bytes());
}

/// Ends what is sent, and waits a little for the other side to do so: what it has sent and nobody
/// read would otherwise make the system throw away what it has not yet received.
pub fn hang_up(mut stream: TcpStream, patience: Duration) {
    let deadline = Instant::now() + patience;
    let mut room = [0; 4096];
    if stream.shutdown(Shutdown::Write).is_err() {
        return;
    }
    loop {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
            return;
        }
        match stream.read(&mut room) {
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
    fn only_our_own_address_is_from_here() {
        let status = |headers: &str| request(headers).is_from_here(8642).map_err(|r| r.status);
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
    fn what_a_websocket_needs() {
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
        fn any_bytes_are_a_request_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            if let Ok(Some(request)) = Request::parse(&bytes) {
                let _ = (request.is_from_here(1), request.websocket_key());
            }
        }
    }
}
