//! `tumble view`: shows a running simulation or a finished run in the browser.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

use clap::Args;
use tumble_io::scene::{LoadOptions, builtin};
use tumble_view::{Content, Limits, Server, Session, has_display, open_browser};

use crate::console::print_error;
use crate::failure::{Failure, print};
use crate::interrupt::stop_flag;
use crate::scene_argument::load_scene;

/// The page in the folder of a run.
const PAGE: &str = "motion.html";

#[derive(Args)]
#[command(
    after_help = "Prints the address of the page, which only this machine can open. Ctrl-C stops the viewer."
)]
pub struct ViewArgs {
    /// Scene file, name of a built-in scene (see `tumble scenes`), or folder of a run
    #[arg(default_value = "task2", value_name = "SCENE or RUN")]
    scene: String,
    /// Port; 0 for any free port [default: 8642, or the next free port]
    #[arg(long, value_name = "N")]
    port: Option<u16>,
    /// Do not open the browser
    #[arg(long)]
    no_open: bool,
    /// Set a key of the scene, e.g. dt=1e-4 or body.0.scale=0.5; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Accept a dt above the stability limit, here and from the page
    #[arg(long)]
    force: bool,
}

pub fn view(args: &ViewArgs) -> Result<(), Failure> {
    let content = match page_of_run(&args.scene) {
        Some(_) if !args.set.is_empty() => {
            return Err(Failure::call(&"--set needs a scene: a finished run cannot be changed"));
        }
        Some(page) => Content::Page(read_page(&page)?),
        None => {
            let options = LoadOptions { sets: args.set.clone(), force: args.force };
            let session = Session::new(load_scene(&args.scene, &options)?);
            Content::Live(Box::new(session.map_err(|reason| Failure::call(&reason))?))
        }
    };
    let stop = stop_flag();
    let listener = Server::bind(args.port).map_err(|error| cannot_bind(args.port, &error))?;
    let server = Server::start(content, listener, Limits::default())
        .map_err(|error| Failure::Run(format!("error: cannot start the viewer: {error}")))?;
    announce(server.port(), args.no_open)?;
    while !stop.load(Ordering::Relaxed) && server.is_running() {
        std::thread::sleep(Duration::from_millis(50));
    }
    let is_stopped = stop.load(Ordering::Relaxed);
    if server.close() && is_stopped {
        return Ok(());
    }
    Err(Failure::Run(
        "error: the viewer stopped because of an internal error; please report this".to_owned(),
    ))
}

/// The path of the page if `name` is the folder of a run or such a page; `None` for a scene.
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
            format!("; `tumble view {}` simulates its scene again", scene.display())
        } else {
            format!("; {shown} is not the folder of a run")
        };
        Failure::call(&format!("cannot read {}: {error}{help}", path.display()))
    })
}

fn cannot_bind(port: Option<u16>, error: &std::io::Error) -> Failure {
    let which = port.map_or_else(|| "a port".to_owned(), |port| format!("port {port}"));
    Failure::call(&format!("cannot use {which}: {error}; --port 0 selects any free port"))
}

/// Prints the address on stdout and instructions on stderr, and opens the browser.
fn announce(port: u16, no_open: bool) -> Result<(), Failure> {
    let address = format!("http://127.0.0.1:{port}/");
    print(&format!("{address}\n"))?;
    if has_display() {
        if !no_open {
            open_browser(&address);
        }
    } else {
        print_error(&format!(
            "from another machine: ssh -L {port}:127.0.0.1:{port} this-host, \
             then open {address} there"
        ));
    }
    print_error("press Ctrl-C to stop the viewer");
    Ok(())
}
