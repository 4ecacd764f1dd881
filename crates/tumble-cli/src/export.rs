//! `tumble export`: a run in another format.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::Args;
use tumble_io::export::{Export, ExportError, ExportOptions};
use tumble_io::picture::View;
use tumble_io::replay::{Replay, ReplayError};

use crate::run::{bad_scene, progress_bar, stop_on_ctrl_c};
use crate::table::count;
use crate::{Failure, complain, print};

#[derive(Args)]
#[command(after_help = "The ending of FILE tells the format:\n  \
    .glb   glTF, for Blender and the web      .csv  the trajectory\n  \
    .usda  USD, for film tools                .png  the whole motion in one picture\n  \
    .pvd   VTK, for ParaView and PyVista      .gif  an animated picture\n  \
    .mp4   a film; needs the program ffmpeg")]
pub struct ExportArgs {
    /// The folder of a run
    run: PathBuf,
    /// The file to write
    #[arg(long, value_name = "FILE")]
    to: PathBuf,
    /// Frames for each simulated second [default: every recorded one, about 30 in films]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    fps: Option<f64>,
    /// Size of pictures in pixels [default: .png 1600x1000, .gif 800x500, .mp4 1280x800]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Leave out what was before this time (s)
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    from: Option<f64>,
    /// Leave out what was after this time (s)
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    to_time: Option<f64>,
    /// Where pictures are seen from, in degrees: how far around, how far from above; and how near (1: all of it)
    #[arg(long, value_name = "YAW,PITCH[,ZOOM]", value_parser = view, allow_hyphen_values = true)]
    camera: Option<View>,
    /// Draw this moment (s) alone, in a .png
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    at: Option<f64>,
    /// Write over FILE if it is there
    #[arg(long)]
    force: bool,
}

pub fn export(args: &ExportArgs) -> Result<(), Failure> {
    let ExportArgs { fps, size, from, to_time, camera: view, at, force, .. } = *args;
    let options = ExportOptions { fps, size, from, to_time, view, at, force };
    let export = Export::new(&args.to, options).map_err(|error| failure(&error))?;
    let replay = Replay::open(&args.run).map_err(|error| match &error {
        ReplayError::Scene(error) => bad_scene(error),
        _ => Failure::Call(format!("error: {error}")),
    })?;
    let stop = stop_on_ctrl_c();
    let bar = progress_bar();
    let exported = export.write(&replay, &mut |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        !stop.load(Ordering::Relaxed)
    });
    bar.finish_and_clear();
    let exported = exported.map_err(|error| failure(&error))?;
    let frames = exported.frames;
    let plural = if frames == 1 { "" } else { "s" };
    let (kilobytes, file) = (exported.bytes.div_ceil(1000), args.to.display());
    print(&format!("{file}: {} frame{plural}, {} kB\n", count(frames as u64), count(kilobytes)))
}

fn failure(error: &ExportError) -> Failure {
    if let ExportError::Stopped = error {
        complain(&error.to_string());
        return Failure::Interrupted;
    }
    let message = format!("error: {error}");
    if error.is_wrong_call() { Failure::Call(message) } else { Failure::Run(message) }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X', '×']);
    let sides = sides.and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    sides.ok_or_else(|| "width and height in pixels, as in 800x500".to_owned())
}

fn view(text: &str) -> Result<View, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    let (yaw, pitch, zoom) = match numbers.as_deref() {
        Some(&[yaw, pitch]) => (yaw, pitch, 1.0),
        Some(&[yaw, pitch, zoom]) => (yaw, pitch, zoom),
        _ => return Err("degrees, as in 30,20 or with a zoom 30,20,1.5".to_owned()),
    };
    Ok(View { yaw: f64::to_radians(yaw), pitch: f64::to_radians(pitch), zoom })
}
