//! `tumble view` from outside.

#![allow(clippy::unwrap_used)]

mod common;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::cargo::cargo_bin;
use common::{BODY, Desk, says};

/// A viewer that is ended with the test.
struct Viewer {
    child: Child,
    port: u16,
}

impl Viewer {
    fn start(desk: &Desk, args: &[&str]) -> Self {
        let mut child = Command::new(cargo_bin("tumble"))
            .current_dir(desk.0.path())
            .args(["view", "--no-open", "--port", "0"])
            .args(args)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
        let port = line.strip_prefix("http://127.0.0.1:").and_then(|l| l.strip_suffix("/\n"));
        let port = port.and_then(|port| port.parse().ok());
        Self { port: port.unwrap_or_else(|| panic!("{line:?} is no address")), child }
    }

    fn get(&self, path: &str) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let host = format!("127.0.0.1:{}", self.port);
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    /// Stops it with Ctrl-C; its exit status and what it said on stderr.
    fn stop(mut self) -> (Option<i32>, String) {
        let pid = self.child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
        let start = Instant::now();
        while self.child.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < Duration::from_secs(10), "Ctrl-C does not stop it");
            std::thread::sleep(Duration::from_millis(10));
        }
        let mut said = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        (self.child.wait().unwrap().code(), said)
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(unix)]
#[test]
fn a_live_scene_until_ctrl_c() {
    let desk = Desk::new();
    desk.write("s.toml", BODY);
    let viewer = Viewer::start(&desk, &["s.toml", "--set", "dt=2e-3"]);
    says(&viewer.get("/"), &["HTTP/1.1 200 OK\r\n", "<!doctype html>"]);
    says(&viewer.get("/live"), &["426"]);
    says(&viewer.get("/s.toml"), &["404"]);
    let tunnel = format!("ssh -L {0}:127.0.0.1:{0} ", viewer.port);
    let (status, said) = viewer.stop();
    assert_eq!(status, Some(0), "{said}");
    says(&said, &["Ctrl-C", &tunnel]);
    assert_eq!(desk.files(""), ["s.toml"]);
}

#[cfg(unix)]
#[test]
fn the_page_of_a_run() {
    let desk = Desk::new();
    desk.write("first/motion.html", "<p>a run</p>");
    for name in ["first", "first/motion.html"] {
        let viewer = Viewer::start(&desk, &[name]);
        assert!(viewer.get("/").ends_with("\r\n\r\n<p>a run</p>"));
        says(&viewer.get("/live"), &["404"]);
        assert_eq!(viewer.stop().0, Some(0));
    }
}

#[test]
fn what_cannot_be_viewed() {
    let desk = Desk::new();
    let refused = |args: &[&str]| {
        let said = desk.tumble(&[&["view", "--no-open"], args].concat()).ends_with(2);
        assert_eq!(said.out, "");
        said.err
    };
    says(&refused(&["taks2"]), &["taks2", "did you mean `task2`?"]);
    desk.write("s.toml", BODY);
    says(&refused(&["s.toml", "--set", "dt=0"]), &["`dt`", "--set"]);
    desk.write("old/scene.toml", BODY);
    let told =
        format!("`tumble view {}`", std::path::Path::new("old").join("scene.toml").display());
    says(&refused(&["old"]), &["motion.html", &told]);
    desk.write("other/readme", "");
    says(&refused(&["other"]), &["not the folder of a run"]);
    desk.write("first/motion.html", "<p>a run</p>");
    says(&refused(&["first", "--set", "dt=1e-4"]), &["--set"]);
    let many = format!("{BODY}copies = {{ count = [30, 30, 30], spacing = [1, 1, 1] }}\n");
    desk.write("many.toml", many);
    says(&refused(&["many.toml"]), &["27000", "at most 20000 bodies"]);
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    says(&refused(&["s.toml", "--port", &port]), &["port", &port, "--port 0"]);
}
