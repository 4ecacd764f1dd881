//! `tumble view`: serves a live simulation or a finished run.

#![allow(clippy::unwrap_used)]

mod common;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::cargo::cargo_bin;
use common::{BODY, TestDir, assert_contains};

/// A viewer process, killed when dropped.
struct Viewer {
    child: Child,
    port: u16,
}

impl Viewer {
    fn start(dir: &TestDir, args: &[&str]) -> Self {
        let mut child = Command::new(cargo_bin("tumble"))
            .current_dir(dir.0.path())
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
        Self { port: port.unwrap_or_else(|| panic!("{line:?} is not an address")), child }
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

    /// Stops the viewer with Ctrl-C and returns its exit status and stderr.
    fn stop(mut self) -> (Option<i32>, String) {
        let pid = self.child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
        let start = Instant::now();
        while self.child.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < Duration::from_secs(10), "Ctrl-C does not stop it");
            std::thread::sleep(Duration::from_millis(10));
        }
        let mut stderr = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut stderr).unwrap();
        (self.child.wait().unwrap().code(), stderr)
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
fn a_live_scene_is_served_until_ctrl_c() {
    let dir = TestDir::new();
    dir.write("s.toml", BODY);
    let viewer = Viewer::start(&dir, &["s.toml", "--set", "dt=2e-3"]);
    assert_contains(&viewer.get("/"), &["HTTP/1.1 200 OK\r\n", "<!doctype html>"]);
    assert_contains(&viewer.get("/live"), &["426"]);
    assert_contains(&viewer.get("/s.toml"), &["404"]);
    let tunnel = format!("ssh -L {0}:127.0.0.1:{0} ", viewer.port);
    let (status, stderr) = viewer.stop();
    assert_eq!(status, Some(0), "{stderr}");
    assert_contains(&stderr, &["Ctrl-C", &tunnel]);
    assert_eq!(dir.files(""), ["s.toml"]);
}

#[cfg(unix)]
#[test]
fn the_page_of_a_run_is_served() {
    let dir = TestDir::new();
    dir.write("first/motion.html", "<p>a run</p>");
    for name in ["first", "first/motion.html"] {
        let viewer = Viewer::start(&dir, &[name]);
        assert!(viewer.get("/").ends_with("\r\n\r\n<p>a run</p>"));
        assert_contains(&viewer.get("/live"), &["404"]);
        assert_eq!(viewer.stop().0, Some(0));
    }
}

#[test]
fn invalid_arguments_are_status_2() {
    let dir = TestDir::new();
    let rejected = |args: &[&str]| {
        let outcome = dir.tumble(&[&["view", "--no-open"], args].concat()).expect_status(2);
        assert_eq!(outcome.stdout, "");
        outcome.stderr
    };
    assert_contains(&rejected(&["taks2"]), &["taks2", "did you mean `task2`?"]);
    dir.write("s.toml", BODY);
    assert_contains(&rejected(&["s.toml", "--set", "dt=0"]), &["`dt`", "--set"]);
    dir.write("old/scene.toml", BODY);
    let advice =
        format!("`tumble view {}`", std::path::Path::new("old").join("scene.toml").display());
    assert_contains(&rejected(&["old"]), &["motion.html", &advice]);
    dir.write("other/readme", "");
    assert_contains(&rejected(&["other"]), &["not the folder of a run"]);
    dir.write("first/motion.html", "<p>a run</p>");
    assert_contains(&rejected(&["first", "--set", "dt=1e-4"]), &["--set"]);
    let many = format!("{BODY}copies = {{ count = [30, 30, 30], spacing = [1, 1, 1] }}\n");
    dir.write("many.toml", many);
    assert_contains(&rejected(&["many.toml"]), &["27000", "at most 20000 bodies"]);
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port().to_string();
    assert_contains(&rejected(&["s.toml", "--port", &port]), &["port", &port, "--port 0"]);
}
