//! The server over real sockets of the loopback interface, with a WebSocket client of its own.

#![allow(clippy::unwrap_used)]

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::Value;
use tumble_io::scene::{LoadOptions, Source, load_text};
use tumble_view::{Limits, Server, Session, Show};
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

/// Nothing here takes as long as this.
const LONG: Duration = Duration::from_secs(5);

fn limits() -> Limits {
    Limits {
        head_time: Duration::from_millis(700),
        write_time: Duration::from_millis(1500),
        ping_after: Duration::from_millis(300),
        silence: Duration::from_millis(1500),
        connections: 32,
    }
}

fn session(scene: &str) -> Session {
    let source = Source { name: "test".to_owned(), text: scene.to_owned() };
    let loaded = load_text("test", source, Path::new("."), &LoadOptions::default()).unwrap();
    Session::new(loaded).unwrap()
}

fn serve(scene: &str) -> Server {
    let show = Show::Live(Box::new(session(scene)));
    Server::start(show, Server::bind(Some(0)).unwrap(), limits()).unwrap()
}

/// Sends these bytes and returns all that comes back.
fn ask(port: u16, request: &str) -> String {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(LONG)).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).into_owned()
}

fn get(port: u16, path: &str) -> String {
    ask(port, &format!("GET {path} HTTP/1.1\r\nHost: localhost:{port}\r\n\r\n"))
}

fn status(answer: &str) -> u16 {
    answer.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0)
}

/// A page.
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
        stream.set_read_timeout(Some(LONG)).unwrap();
        let mut request = format!("ws://127.0.0.1:{port}/live").into_client_request().unwrap();
        let origin = format!("http://127.0.0.1:{port}").parse().unwrap();
        request.headers_mut().insert("Origin", origin);
        tungstenite::client(request, stream).ok().map(|(socket, _)| Self(socket))
    }

    fn open(port: u16) -> Self {
        Self::try_open(port).unwrap()
    }

    fn say(&mut self, text: &str) {
        self.0.send(Message::text(text)).unwrap();
    }

    fn set(&mut self, key: &str, value: &str) {
        self.say(&format!("{{\"type\":\"set\",\"key\":\"{key}\",\"value\":{value}}}"));
    }

    fn next(&mut self) -> Message {
        self.0.read().unwrap()
    }

    /// The next text of this type, whatever comes before.
    fn text(&mut self, kind: &str) -> Value {
        self.text_that(kind, |_| true)
    }

    fn text_that(&mut self, kind: &str, is_it: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        while start.elapsed() < LONG {
            if let Message::Text(text) = self.next() {
                let value: Value = serde_json::from_str(&text).unwrap();
                if value["type"] == kind && is_it(&value) {
                    return value;
                }
            }
        }
        panic!("no such {kind}");
    }

    fn frame(&mut self) -> Frame {
        loop {
            if let Message::Binary(bytes) = self.next() {
                let number = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
                return Frame { time: number(0), step: number(8), bytes: bytes.to_vec() };
            }
        }
    }

    fn frame_that(&mut self, is_it: impl Fn(&Frame) -> bool) -> Frame {
        let start = Instant::now();
        while start.elapsed() < LONG {
            let frame = self.frame();
            if is_it(&frame) {
                return frame;
            }
        }
        panic!("no such frame");
    }

    /// Reads on until the server says goodbye.
    fn ends(&mut self) {
        let start = Instant::now();
        while self.0.read().is_ok() {
            assert!(start.elapsed() < LONG, "the server does not let go");
        }
    }
}

#[test]
fn the_page_comes_with_its_headers() {
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
    assert!(ask(server.port(), &request).ends_with("\r\n\r\n"));
    assert!(server.close());
}

#[test]
fn a_page_gets_the_head_and_then_frames() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let Message::Text(first) = page.next() else { panic!("no text") };
    let head: Value = serde_json::from_str(&first).unwrap();
    assert_eq!((&head["type"], &head["bodies"][0]["name"]), (&"head".into(), &"ball".into()));
    let first = page.frame();
    assert_eq!(first.bytes.len(), 80 + 88);
    let last = page.frame_that(|frame| frame.time > 0.1);
    assert!(last.step > first.step);
    assert!(server.close());
}

#[test]
fn time_passes_as_the_clock_does_and_frames_at_most_sixty_times_a_second() {
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
    // a machine that is busy may lose time, never gain it
    assert!(simulated < passed + 0.05 && simulated > 0.2, "{simulated} s in {passed} s");
    assert!(frames <= 40, "{frames}");
}

#[test]
fn commands_are_carried_out() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    page.say("{\"type\":\"pause\"}");
    page.text_that("status", |status| status["playing"] == false);
    page.say("{\"type\":\"reset\"}");
    page.text("head");
    assert_eq!(page.frame().step, 0.0);
    for step in 1..4 {
        page.say("{\"type\":\"step\"}");
        assert_eq!(page.frame().step, f64::from(step));
    }
    page.set("gravity.1", "-1.62");
    assert_eq!(page.text("head")["gravity"][1], -1.62);
    page.set("body.0.initial_velocity", "[0, 3, 0]");
    page.text_that("status", |status| status["pending"][0] == "body.0.initial_velocity");
    page.set("collision.collision_stiffness", "-5");
    let why = page.text("refused")["why"].to_string();
    assert!(why.contains("`collision.collision_stiffness`"), "{why}");
    page.say("{\"type\":\"grab\",\"body\":0,\"particle\":99999999,\"target\":[0,0,0]}");
    assert!(page.text("refused")["why"].to_string().contains("no particle"));
    page.say("{\"type\":\"nonsense\"}");
    assert!(page.text("refused")["why"].to_string().contains("unknown variant"));
    page.0.send(Message::binary(vec![1, 2, 3])).unwrap();
    page.text("refused");
    page.say("{\"type\":\"save\"}");
    let toml = page.text("saved")["toml"].as_str().unwrap().to_owned();
    assert!(toml.contains("gravity = [0.0, -1.62, 0.0]"), "{toml}");
    session(&toml);
    page.say("{\"type\":\"reset\"}");
    let status =
        page.text_that("status", |status| status["pending"].as_array().unwrap().is_empty());
    assert_eq!((&status["speed"], &status["error"]), (&1.0.into(), &Value::Null));
    page.say("{\"type\":\"speed\",\"value\":null}");
    page.say("{\"type\":\"play\"}");
    let status = page.text_that("status", |status| {
        status["playing"] == true && status["steps_per_second"].as_f64() > Some(0.0)
    });
    assert_eq!(status["speed"], Value::Null);
    page.frame_that(|frame| frame.time > 2.0);
    assert!(server.close());
}

#[test]
fn a_failure_is_told_and_mended() {
    let scene = SCENE.replace("0.1, 0.0, 0.0]", "0.0, -1e5, 0.0]")
        + "[[wall]]\nnormal = [0, -1, 0]\noffset = -2\n";
    let server = serve(&scene);
    let mut page = Page::open(server.port());
    let status = page.text_that("status", |status| !status["error"].is_null());
    assert_eq!(status["playing"], false);
    assert!(status["error"].as_str().unwrap().contains("diverged"));
    page.set("body.0.initial_velocity", "[0, 0, 0]");
    page.say("{\"type\":\"reset\"}");
    page.text_that("status", |status| status["error"].is_null());
    page.say("{\"type\":\"play\"}");
    page.frame_that(|frame| frame.time > 0.05);
}

#[test]
fn two_pages_see_the_same_and_both_may_command() {
    let server = serve(SCENE);
    let (mut one, mut two) = (Page::open(server.port()), Page::open(server.port()));
    one.frame();
    two.say("{\"type\":\"pause\"}");
    for page in [&mut one, &mut two] {
        page.text_that("status", |status| status["playing"] == false);
    }
    one.say("{\"type\":\"reset\"}");
    for page in [&mut one, &mut two] {
        page.frame_that(|frame| frame.step == 0.0);
    }
    for step in 1..6 {
        if step % 2 == 0 {
            one.say("{\"type\":\"step\"}")
        } else {
            two.say("{\"type\":\"step\"}")
        }
        let seen = [&mut one, &mut two].map(|page| page.frame_that(|f| f.step == f64::from(step)));
        assert_eq!(seen[0].bytes, seen[1].bytes);
    }
    // one goes, the other stays
    one.0.close(None).unwrap();
    one.ends();
    two.say("{\"type\":\"step\"}");
    two.frame_that(|frame| frame.step == 6.0);
}

#[test]
fn without_a_page_time_stands_still() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let before = page.frame_that(|frame| frame.time > 0.05);
    drop(page);
    std::thread::sleep(Duration::from_millis(600));
    let after = Page::open(server.port()).frame();
    assert!(after.time < before.time + 0.4, "{} {}", before.time, after.time);
}

/// So many bodies that the system's own room for frames is soon full, and a page that reads none of them
/// beside one that does: what that one gets.
fn beside_a_lazy_page(write_time: Duration) -> (Server, Page) {
    let many = SCENE.to_owned() + "copies = { count = [40, 1, 40], spacing = [2, 2, 2] }\n";
    let limits = Limits { write_time, ..limits() };
    let show = Show::Live(Box::new(session(&many)));
    let server = Server::start(show, Server::bind(Some(0)).unwrap(), limits).unwrap();
    let (lazy, mut page) = (Page::open(server.port()), Page::open(server.port()));
    page.say("{\"type\":\"speed\",\"value\":null}");
    for _ in 0..100 {
        page.frame();
    }
    (server, lazy)
}

#[test]
fn a_page_that_takes_nothing_slows_nobody() {
    // were it waited for, nothing would come for a minute
    let (server, lazy) = beside_a_lazy_page(Duration::from_secs(60));
    drop(lazy);
    assert!(server.close());
}

#[test]
fn a_page_that_takes_nothing_is_let_go() {
    let (server, mut lazy) = beside_a_lazy_page(Duration::from_millis(200));
    std::thread::sleep(Duration::from_millis(800));
    lazy.ends();
    assert!(server.close());
}

#[test]
fn strangers_are_refused() {
    let server = serve(SCENE);
    let port = server.port();
    let wanted = |host: &str, origin: &str, path: &str| {
        let origin =
            if origin.is_empty() { String::new() } else { format!("Origin: {origin}\r\n") };
        let upgrade = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n\
                       Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
        let more = if path == "/live" { upgrade } else { "" };
        let request = format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n{origin}{more}\r\n");
        let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut room = [0; 12];
        stream.read_exact(&mut room).unwrap();
        status(&String::from_utf8_lossy(&room))
    };
    let (ours, here) = (format!("127.0.0.1:{port}"), format!("http://localhost:{port}"));
    for path in ["/", "/live"] {
        assert_eq!(wanted("evil.example", "", path), 403);
        assert_eq!(wanted(&format!("evil.example:{port}"), &here, path), 403);
        assert_eq!(wanted(&ours, "http://evil.example", path), 403);
        assert_eq!(wanted(&ours, "null", path), 403);
    }
    assert_eq!(wanted(&ours, "", "/"), 200);
    assert_eq!(wanted(&ours, "", "/live"), 403);
    assert_eq!(wanted(&ours, &here, "/live"), 101);
}

#[test]
fn nothing_else_is_here() {
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
        assert!(answer.ends_with("there is nothing here\n"));
    }
    assert_eq!(status(&get(port, "/live")), 426);
    let post = format!("POST / HTTP/1.1\r\nHost: localhost:{port}\r\nContent-Length: 3\r\n\r\nabc");
    assert_eq!(status(&ask(port, &post)), 405);
}

#[test]
fn what_is_no_request_is_answered_and_forgotten() {
    let server = serve(SCENE);
    let port = server.port();
    assert_eq!(status(&ask(port, "what?\r\n\r\n")), 400);
    assert_eq!(status(&ask(port, "GET / HTTP/1.1\r\n\r\n")), 400);
    assert_eq!(status(&ask(port, "\u{0}\u{1}\u{2}")), 400);
    let long =
        format!("GET / HTTP/1.1\r\nHost: localhost:{port}\r\nA: {}\r\n\r\n", "x".repeat(20_000));
    assert_eq!(status(&ask(port, &long)), 431);
    let many =
        format!("GET / HTTP/1.1\r\nHost: localhost:{port}\r\n{}\r\n", "A: b\r\n".repeat(100));
    assert_eq!(status(&ask(port, &many)), 431);
    // one who never finishes a sentence is not listened to for ever
    let start = Instant::now();
    assert_eq!(status(&ask(port, "GET / HTTP/1.1\r\nHost: local")), 408);
    assert!(start.elapsed() < Duration::from_secs(3));
    assert_eq!(status(&get(port, "/")), 200);
}

#[test]
fn a_message_that_is_too_long_ends_the_connection() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    page.frame();
    let _ = page.0.send(Message::text("x".repeat(70_000)));
    page.ends();
    let mut page = Page::open(server.port());
    page.say(&"x".repeat(60_000));
    page.text("refused");
}

#[test]
fn what_is_no_websocket_ends_the_connection() {
    let server = serve(SCENE);
    for bytes in [&b"\xff\xff\xff\xff\xff\xff"[..], b"GET / HTTP/1.1\r\n\r\n", b"\x81\x05hello"] {
        let mut page = Page::open(server.port());
        page.0.get_mut().write_all(bytes).unwrap();
        page.ends();
    }
    assert_eq!(status(&get(server.port(), "/")), 200);
}

#[test]
fn a_page_that_only_looks_is_kept() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let start = Instant::now();
    while start.elapsed() < Duration::from_millis(2500) {
        page.frame();
    }
}

#[test]
fn a_half_open_connection_is_let_go() {
    let server = serve(SCENE);
    // one that says nothing at all, one whose page is there no more but whose socket is
    let mut mute = TcpStream::connect(("127.0.0.1", server.port())).unwrap();
    mute.set_read_timeout(Some(LONG)).unwrap();
    let mut page = Page::open(server.port());
    page.say("{\"type\":\"pause\"}");
    let start = Instant::now();
    let mut answer = String::new();
    mute.read_to_string(&mut answer).unwrap();
    assert_eq!(status(&answer), 408);
    // a page that reads answers the server's questions, and stays
    while start.elapsed() < Duration::from_millis(2200) {
        if !matches!(page.next(), Message::Ping(_)) {
            continue;
        }
    }
    page.say("{\"type\":\"step\"}");
    page.frame();
    // one that does not, goes
    std::thread::sleep(Duration::from_millis(2500));
    page.ends();
}

#[test]
fn there_is_room_for_so_many() {
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
        assert!(start.elapsed() < LONG, "no seat is given back");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn closing_says_goodbye() {
    let server = serve(SCENE);
    let mut page = Page::open(server.port());
    let mut paused = Page::open(server.port());
    page.frame();
    paused.say("{\"type\":\"pause\"}");
    let start = Instant::now();
    assert!(server.is_running());
    let closing = std::thread::spawn(move || server.close());
    page.ends();
    paused.ends();
    assert!(closing.join().unwrap());
    assert!(start.elapsed() < Duration::from_secs(2));
}

#[test]
fn the_page_of_a_run_is_served_as_it_is() {
    let page = b"<!doctype html><p>a run</p>".to_vec();
    let server =
        Server::start(Show::Page(page.clone()), Server::bind(Some(0)).unwrap(), limits()).unwrap();
    let answer = get(server.port(), "/");
    assert!(answer.ends_with("<p>a run</p>"), "{answer}");
    assert_eq!(status(&get(server.port(), "/live")), 404);
    assert!(server.close());
}

#[test]
fn a_port_that_is_taken() {
    let first = Server::bind(Some(0)).unwrap();
    let port = first.local_addr().unwrap().port();
    assert!(Server::bind(Some(port)).is_err());
    // without an order, the next free one is found
    let (one, two) = (Server::bind(None).unwrap(), Server::bind(None).unwrap());
    assert_ne!(one.local_addr().unwrap().port(), two.local_addr().unwrap().port());
}
