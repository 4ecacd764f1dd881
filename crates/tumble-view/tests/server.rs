//! The server over real sockets of the loopback interface, with a WebSocket client.

#![allow(clippy::unwrap_used)]

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::Value;
use tumble_io::scene::{LoadOptions, Source, load_text};
use tumble_view::{Content, Limits, Server, Session};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

const SCENE: &str = "
dt = 1e-3
[collision]
restitution = 0.6
[[wall]]
normal = [0.0, 1.0, 0.0]
[[body]]
name = \"ball\"
shape = \"sphere\"
subdivisions = 0
position = [0.0, 1.0, 0.0]
initial_velocity = [0.1, 0.0, 0.0]
";

/// Longer than anything in these tests takes.
const TIMEOUT: Duration = Duration::from_secs(5);

fn limits() -> Limits {
    Limits {
        request_timeout: Duration::from_millis(700),
        write_timeout: Duration::from_millis(1500),
        ping_interval: Duration::from_millis(300),
        idle_timeout: Duration::from_millis(1500),
        max_connections: 32,
    }
}

fn session(scene: &str) -> Session {
    let source = Source { name: "test".to_owned(), text: scene.to_owned() };
    let loaded = load_text("test", source, Path::new("."), &LoadOptions::default()).unwrap();
    Session::new(loaded).unwrap()
}

fn serve(scene: &str) -> Server {
    let content = Content::Live(Box::new(session(scene)));
    Server::start(content, Server::bind(Some(0)).unwrap(), limits()).unwrap()
}

/// Sends a request and returns the whole response.
fn send(port: u16, request: &str) -> String {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(TIMEOUT)).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).into_owned()
}

fn get(port: u16, path: &str) -> String {
    send(port, &format!("GET {path} HTTP/1.1\r\nHost: localhost:{port}\r\n\r\n"))
}

fn status(answer: &str) -> u16 {
    answer.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0)
}

/// The client side of a page.
struct Page(WebSocket<TcpStream>);

#[derive(Debug)]
struct Frame {
    time: f64,
    step: f64,
    bytes: Vec<u8>,
}

impl Page {
    fn try_open(port: u16) -> Option<Self> {
        let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.set_read_timeout(Some(TIMEOUT)).unwrap();
        let mut request = format!("ws://127.0.0.1:{port}/live").into_client_request().unwrap();
        let origin = format!("http://127.0.0.1:{port}").parse().unwrap();
        request.headers_mut().insert("Origin", origin);
        tungstenite::client(request, stream).ok().map(|(socket, _)| Self(socket))
    }

    fn open(port: u16) -> Self {
        Self::try_open(port).unwrap()
    }

    fn send(&mut self, text: &str) {
        self.0.send(Message::text(text)).unwrap();
    }

    fn set(&mut self, key: &str, value: &str) {
        self.send(&format!("{{\"type\":\"set\",\"key\":\"{key}\",\"value\":{value}}}"));
    }

    fn next(&mut self) -> Message {
        self.0.read().unwrap()
    }

    /// The next text message of this type; other messages are skipped.
    fn text(&mut self, kind: &str) -> Value {
        self.text_where(kind, |_| true)
    }

    fn text_where(&mut self, kind: &str, matches: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        while start.elapsed() < TIMEOUT {
            if let Message::Text(text) = self.next() {
                let value: Value = serde_json::from_str(&text).unwrap();
                if value["type"] == kind && matches(&value) {
                    return value;
                }
            }
        }
        panic!("no matching {kind} within {TIMEOUT:?}");
    }

    fn frame(&mut self) -> Frame {
        loop {
            if let Message::Binary(bytes) = self.next() {
                let number = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
                return Frame { time: number(0), step: number(8), bytes: bytes.to_vec() };
            }
        }
    }

    fn frame_where(&mut self, matches: impl Fn(&Frame) -> bool) -> Frame {
        let start = Instant::now();
        while start.elapsed() < TIMEOUT {
            let frame = self.frame();
            if matches(&frame) {
                return frame;
            }
        }
        panic!("no matching frame within {TIMEOUT:?}");
    }

    /// Reads until the server closes the connection.
    fn wait_for_close(&mut self) {
        let start = Instant::now();
        while self.0.read().is_ok() {
            assert!(start.elapsed() < TIMEOUT, "the server does not close the connection");
        }
    }
}

#[test]
fn the_page_is_served_with_security_headers() {
    let server = serve(SCENE);
    let answer = get(server.port(), "/");
    assert_eq!(status(&answer), 200);
    let (head, body) = answer.split_once("\r\n\r\n").unwrap();
    assert!(head.contains(&format!("Content-Length: {}", body.len())));
    for header in [
        "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline' data: blob:",
        &format!("connect-src 'self' ws://127.0.0.1:{}", server.port()),
        "frame-ancestors 'none'",
        "X-Content-Type-Options: nosniff",
        "X-Frame-Options: DENY",
        "Cache-Control: no-store",
    ] {
        assert!(head.contains(header), "{header} is missing in\n{head}");
    }
    assert!(body.starts_with("<!doctype html>"));
    assert_eq!(get(server.port(), "/?a=b"), answer);
    let request = format!("HEAD / HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", server.port());
    assert!(send(server.port(), &request).ends_with("\r\n\r\n"));
    assert!(server.close());
}

#[test]
fn a_page_receives_the_header_and_then_frames() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let Message::Text(first) = page.next() else { panic!("no text") };
    let header: Value = serde_json::from_str(&first).unwrap();
    assert_eq!((&header["type"], &header["bodies"][0]["name"]), (&"head".into(), &"ball".into()));
    let first = page.frame();
    assert_eq!(first.bytes.len(), 104 + 88);
    let last = page.frame_where(|frame| frame.time > 0.1);
    assert!(last.step > first.step);
    assert!(server.close());
}

#[test]
fn the_simulation_runs_in_real_time_with_at_most_sixty_frames_per_second() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let (start, first) = (Instant::now(), page.frame().time);
    let mut frames = 0;
    let last = loop {
        let frame = page.frame();
        frames += 1;
        if start.elapsed() > Duration::from_millis(600) {
            break frame.time;
        }
    };
    let (simulated, passed) = (last - first, start.elapsed().as_secs_f64());
    // on a busy machine the simulation may be slower than real time, but never faster
    assert!(simulated < passed + 0.05 && simulated > 0.2, "{simulated} s in {passed} s");
    assert!(frames <= 40, "{frames}");
}

#[test]
fn commands_are_executed() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    page.send("{\"type\":\"pause\"}");
    page.text_where("status", |status| status["playing"] == false);
    page.send("{\"type\":\"reset\"}");
    page.text("head");
    assert_eq!(page.frame().step, 0.0);
    for step in 1..4 {
        page.send("{\"type\":\"step\"}");
        assert_eq!(page.frame().step, f64::from(step));
    }
    page.set("gravity.1", "-1.62");
    assert_eq!(page.text("head")["gravity"][1], -1.62);
    page.set("body.0.initial_velocity", "[0, 3, 0]");
    page.text_where("status", |status| status["pending"][0] == "body.0.initial_velocity");
    page.set("collision.collision_stiffness", "-5");
    let reason = page.text("refused")["why"].to_string();
    assert!(reason.contains("`collision.collision_stiffness`"), "{reason}");
    page.send("{\"type\":\"grab\",\"body\":0,\"particle\":99999999,\"target\":[0,0,0]}");
    assert!(page.text("refused")["why"].to_string().contains("no particle"));
    page.send("{\"type\":\"nonsense\"}");
    assert!(page.text("refused")["why"].to_string().contains("unknown variant"));
    page.0.send(Message::binary(vec![1, 2, 3])).unwrap();
    page.text("refused");
    page.send("{\"type\":\"save\"}");
    let toml = page.text("saved")["toml"].as_str().unwrap().to_owned();
    assert!(toml.contains("gravity = [0.0, -1.62, 0.0]"), "{toml}");
    session(&toml);
    page.send("{\"type\":\"reset\"}");
    let status =
        page.text_where("status", |status| status["pending"].as_array().unwrap().is_empty());
    assert_eq!((&status["speed"], &status["error"]), (&1.0.into(), &Value::Null));
    page.send("{\"type\":\"speed\",\"value\":null}");
    page.send("{\"type\":\"play\"}");
    let status = page.text_where("status", |status| {
        status["playing"] == true && status["steps_per_second"].as_f64() > Some(0.0)
    });
    assert_eq!(status["speed"], Value::Null);
    page.frame_where(|frame| frame.time > 2.0);
    assert!(server.close());
}

#[test]
fn a_failure_is_reported_and_a_reset_recovers_from_it() {
    let scene = SCENE.replace("0.1, 0.0, 0.0]", "0.0, -1e5, 0.0]")
        + "[[wall]]\nnormal = [0, -1, 0]\noffset = -2\n";
    let server = serve(&scene);
    let mut page = Page::open(server.port());
    let status = page.text_where("status", |status| !status["error"].is_null());
    assert_eq!(status["playing"], false);
    assert!(status["error"].as_str().unwrap().contains("diverged"));
    page.set("body.0.initial_velocity", "[0, 0, 0]");
    page.send("{\"type\":\"reset\"}");
    page.text_where("status", |status| status["error"].is_null());
    page.send("{\"type\":\"play\"}");
    page.frame_where(|frame| frame.time > 0.05);
}

#[test]
fn two_pages_receive_the_same_frames_and_both_can_send_commands() {
    let server = serve(SCENE);
    let (mut one, mut two) = (Page::open(server.port()), Page::open(server.port()));
    one.frame();
    two.send("{\"type\":\"pause\"}");
    for page in [&mut one, &mut two] {
        page.text_where("status", |status| status["playing"] == false);
    }
    one.send("{\"type\":\"reset\"}");
    for page in [&mut one, &mut two] {
        page.frame_where(|frame| frame.step == 0.0);
    }
    for step in 1..6 {
        if step % 2 == 0 {
            one.send("{\"type\":\"step\"}")
        } else {
            two.send("{\"type\":\"step\"}")
        }
        let seen = [&mut one, &mut two].map(|page| page.frame_where(|f| f.step == f64::from(step)));
        assert_eq!(seen[0].bytes, seen[1].bytes);
    }
    // the other page stays connected when one leaves
    one.0.close(None).unwrap();
    one.wait_for_close();
    two.send("{\"type\":\"step\"}");
    two.frame_where(|frame| frame.step == 6.0);
}

#[test]
fn the_simulation_sleeps_while_no_page_is_connected() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let before = page.frame_where(|frame| frame.time > 0.05);
    drop(page);
    std::thread::sleep(Duration::from_millis(600));
    let after = Page::open(server.port()).frame();
    assert!(after.time < before.time + 0.4, "{} {}", before.time, after.time);
}

/// A server with two pages, of which only the second reads its frames. There are so many bodies that the socket
/// buffers of the first are soon full. Returns the server and the first page after the second has read 100 frames.
fn with_a_page_that_does_not_read(write_timeout: Duration) -> (Server, Page) {
    let many = SCENE.to_owned() + "copies = { count = [40, 1, 40], spacing = [2, 2, 2] }\n";
    let limits = Limits { write_timeout, ..limits() };
    let content = Content::Live(Box::new(session(&many)));
    let server = Server::start(content, Server::bind(Some(0)).unwrap(), limits).unwrap();
    let (unread, mut page) = (Page::open(server.port()), Page::open(server.port()));
    page.send("{\"type\":\"speed\",\"value\":null}");
    for _ in 0..100 {
        page.frame();
    }
    (server, unread)
}

#[test]
fn a_page_that_does_not_read_does_not_slow_other_pages() {
    // if the server waited for it, the other page would receive nothing for a minute
    let (server, unread) = with_a_page_that_does_not_read(Duration::from_secs(60));
    drop(unread);
    assert!(server.close());
}

#[test]
fn a_page_that_does_not_read_is_disconnected() {
    let (server, mut unread) = with_a_page_that_does_not_read(Duration::from_millis(200));
    std::thread::sleep(Duration::from_millis(800));
    unread.wait_for_close();
    assert!(server.close());
}

#[test]
fn requests_from_other_sites_are_refused() {
    let server = serve(SCENE);
    let port = server.port();
    let request_status = |host: &str, origin: &str, path: &str| {
        let origin =
            if origin.is_empty() { String::new() } else { format!("Origin: {origin}\r\n") };
        let upgrade = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n\
                       Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
        let headers = if path == "/live" { upgrade } else { "" };
        let request = format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n{origin}{headers}\r\n");
        let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut start = [0; 12];
        stream.read_exact(&mut start).unwrap();
        status(&String::from_utf8_lossy(&start))
    };
    let (host, origin) = (format!("127.0.0.1:{port}"), format!("http://localhost:{port}"));
    for path in ["/", "/live"] {
        assert_eq!(request_status("evil.example", "", path), 403);
        assert_eq!(request_status(&format!("evil.example:{port}"), &origin, path), 403);
        assert_eq!(request_status(&host, "http://evil.example", path), 403);
        assert_eq!(request_status(&host, "null", path), 403);
    }
    assert_eq!(request_status(&host, "", "/"), 200);
    assert_eq!(request_status(&host, "", "/live"), 403);
    assert_eq!(request_status(&host, &origin, "/live"), 101);
}

#[test]
fn other_paths_and_methods_are_refused() {
    let server = serve(SCENE);
    let port = server.port();
    for path in [
        "/etc/passwd",
        "/../../../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "//etc/passwd",
        "/live/../Cargo.toml",
        "/favicon.ico",
        "http://127.0.0.1/",
    ] {
        let answer = get(port, path);
        assert_eq!(status(&answer), 404, "{path}");
        assert!(answer.ends_with("not found\n"));
    }
    assert_eq!(status(&get(port, "/live")), 426);
    let post = format!("POST / HTTP/1.1\r\nHost: localhost:{port}\r\nContent-Length: 3\r\n\r\nabc");
    assert_eq!(status(&send(port, &post)), 405);
}

#[test]
fn invalid_requests_are_refused() {
    let server = serve(SCENE);
    let port = server.port();
    assert_eq!(status(&send(port, "what?\r\n\r\n")), 400);
    assert_eq!(status(&send(port, "GET / HTTP/1.1\r\n\r\n")), 400);
    assert_eq!(status(&send(port, "\u{0}\u{1}\u{2}")), 400);
    let long =
        format!("GET / HTTP/1.1\r\nHost: localhost:{port}\r\nA: {}\r\n\r\n", "x".repeat(20_000));
    assert_eq!(status(&send(port, &long)), 431);
    let many =
        format!("GET / HTTP/1.1\r\nHost: localhost:{port}\r\n{}\r\n", "A: b\r\n".repeat(100));
    assert_eq!(status(&send(port, &many)), 431);
    // an incomplete request times out
    let start = Instant::now();
    assert_eq!(status(&send(port, "GET / HTTP/1.1\r\nHost: local")), 408);
    assert!(start.elapsed() < Duration::from_secs(3));
    assert_eq!(status(&get(port, "/")), 200);
}

#[test]
fn a_message_that_is_too_long_closes_the_connection() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    page.frame();
    let _ = page.0.send(Message::text("x".repeat(70_000)));
    page.wait_for_close();
    let mut page = Page::open(server.port());
    page.send(&"x".repeat(60_000));
    page.text("refused");
}

#[test]
fn invalid_websocket_data_closes_the_connection() {
    let server = serve(SCENE);
    for bytes in [&b"\xff\xff\xff\xff\xff\xff"[..], b"GET / HTTP/1.1\r\n\r\n", b"\x81\x05hello"] {
        let mut page = Page::open(server.port());
        page.0.get_mut().write_all(bytes).unwrap();
        page.wait_for_close();
    }
    assert_eq!(status(&get(server.port(), "/")), 200);
}

#[test]
fn a_page_that_sends_no_commands_stays_connected() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let start = Instant::now();
    while start.elapsed() < Duration::from_millis(2500) {
        page.frame();
    }
}

#[test]
fn a_connection_that_does_not_answer_is_closed() {
    let server = serve(SCENE);
    // one connection that never sends a request, and one page that stops answering pings
    let mut silent = TcpStream::connect(("127.0.0.1", server.port())).unwrap();
    silent.set_read_timeout(Some(TIMEOUT)).unwrap();
    let mut page = Page::open(server.port());
    page.send("{\"type\":\"pause\"}");
    let start = Instant::now();
    let mut answer = String::new();
    silent.read_to_string(&mut answer).unwrap();
    assert_eq!(status(&answer), 408);
    // a page that answers pings stays connected
    while start.elapsed() < Duration::from_millis(2200) {
        if !matches!(page.next(), Message::Ping(_)) {
            continue;
        }
    }
    page.send("{\"type\":\"step\"}");
    page.frame();
    // and is disconnected when it stops
    std::thread::sleep(Duration::from_millis(2500));
    page.wait_for_close();
}

#[test]
fn the_number_of_connections_is_limited() {
    let server = serve(SCENE);
    let mut pages: Vec<Page> = (0..32).map(|_| Page::open(server.port())).collect();
    for page in &mut pages {
        page.frame();
    }
    for _ in 0..8 {
        assert_eq!(status(&get(server.port(), "/")), 503);
        assert!(Page::try_open(server.port()).is_none());
    }
    drop(pages);
    let start = Instant::now();
    while Page::try_open(server.port()).is_none() {
        assert!(start.elapsed() < TIMEOUT, "the connections are not released");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn closing_the_server_closes_all_pages() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let mut paused = Page::open(server.port());
    page.frame();
    paused.send("{\"type\":\"pause\"}");
    let start = Instant::now();
    assert!(server.is_running());
    let closing = std::thread::spawn(move || server.close());
    page.wait_for_close();
    paused.wait_for_close();
    assert!(closing.join().unwrap());
    assert!(start.elapsed() < Duration::from_secs(2));
}

#[test]
fn the_page_of_a_run_is_served_unchanged() {
    let page = b"<!doctype html><p>a run</p>".to_vec();
    let server =
        Server::start(Content::Page(page.clone()), Server::bind(Some(0)).unwrap(), limits())
            .unwrap();
    let answer = get(server.port(), "/");
    assert!(answer.ends_with("<p>a run</p>"), "{answer}");
    assert_eq!(status(&get(server.port(), "/live")), 404);
    assert!(server.close());
}

#[test]
fn a_port_in_use_is_an_error_unless_none_was_given() {
    let first = Server::bind(Some(0)).unwrap();
    let port = first.local_addr().unwrap().port();
    assert!(Server::bind(Some(port)).is_err());
    // without a port the next free one is taken
    let (one, two) = (Server::bind(None).unwrap(), Server::bind(None).unwrap());
    assert_ne!(one.local_addr().unwrap().port(), two.local_addr().unwrap().port());
}
