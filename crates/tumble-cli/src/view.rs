//! `tumble view`: the viewer, on a live simulation or on a finished run.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

use clap::Args;
use tumble_io::scene::{LoadOptions, builtin};
use tumble_view::{Limits, Server, Session, Show, has_display, open_browser};

use crate::run::{load_scene, stop_on_ctrl_c};
use crate::{Failure, complain, print};

/// The page of a run, in its folder.
const PAGE: &str = "motion.html";

#[derive(Args)]
pub struct ViewArgs {
    /// A scene file, the name of a built-in scene, or the folder of a run
    #[arg(default_value = "task2", value_name = "SCENE or RUN")]
    scene: String,
    /// Port of this machine [default: 8642, or the next that is free; 0: any]
    #[arg(long, value_name = "N")]
    port: Option<u16>,
    /// Do not open a browser
    #[arg(long)]
    no_open: bool,
    /// Change one key of the scene, e.g. dt=1e-4, collision.collision_stiffness=1e5, body.0.scale=0.5
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Accept a dt above the critical one, at the start and from the page
    #[arg(long)]
    force: bool,
}

pub fn view(args: &ViewArgs) -> Result<(), Failure> {
    let show = match page_of_run(&args.scene) {
        Some(_) if !args.set.is_empty() => {
            return Err(Failure::Call(
                "error: --set changes a scene; a run that is over stays as it is".to_owned(),
            ));
        }
        Some(page) => Show::Page(read_page(&page)?),
        None => {
            let options = LoadOptions { sets: args.set.clone(), force: args.force };
            let session = Session::new(load_scene(&args.scene, &options)?);
            Show::Live(Box::new(session.map_err(|why| Failure::Call(format!("error: {why}")))?))
        }
    };
    let stop = stop_on_ctrl_c();
    let listener = Server::bind(args.port).map_err(|error| no_port(args.port, &error))?;
    let server = Server::start(show, listener, Limits::default())
        .map_err(|error| Failure::Run(format!("error: the viewer cannot start: {error}")))?;
    welcome(server.port(), args.no_open)?;
    while !stop.load(Ordering::Relaxed) && server.is_running() {
        std::thread::sleep(Duration::from_millis(50));
    }
    let is_asked = stop.load(Ordering::Relaxed);
    if server.close() && is_asked {
        return Ok(());
    }
    Err(Failure::Run("error: the viewer ended by itself; please report this".to_owned()))
}

/// The page of the run that `name` is the folder of, or the page itself; `None` for a scene.
fn page_of_run(name: &str) -> Option<PathBuf> {
    let path = Path::new(name);
    if builtin(name).is_some() {
        return None;
    }
    let is_page = path.file_name().is_some_and(|name| name == PAGE);
    if path.is_dir() { Some(path.join(PAGE)) } else { is_page.then(|| path.to_owned()) }
}

fn read_page(path: &Path) -> Result<Vec<u8>, Failure> {
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::read(path).map_err(|error| {
        let (shown, scene) = (folder.display(), folder.join("scene.toml"));
        let help = if error.kind() != std::io::ErrorKind::NotFound {
            String::new()
        } else if scene.exists() {
            format!("; `tumble view {}` simulates its scene anew", scene.display())
        } else {
            format!("; {shown} is not the folder of a run")
        };
        Failure::Call(format!("error: cannot read {}: {error}{help}", path.display()))
    })
}

fn no_port(port: Option<u16>, error: &std::io::Error) -> Failure {
    let which = port.map_or_else(|| "a port".to_owned(), |port| format!("port {port}"));
    Failure::Call(format!("error: cannot have {which}: {error}; --port 0 takes any that is free"))
}

/// The address on stdout; what to do with it on stderr.
fn welcome(port: u16, no_open: bool) -> Result<(), Failure> {
    let address = format!("http://127.0.0.1:{port}/");
    print(&format!("{address}\n"))?;
    if has_display() {
        if !no_open {
            open_browser(&address);
        }
    } else {
        complain(&format!(
            "to look from another machine: ssh -L {port}:127.0.0.1:{port} this-host, \
             then open {address} there"
        ));
    }
    complain("Ctrl-C stops the viewer");
    Ok(())
}
