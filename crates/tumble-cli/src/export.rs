//! `tumble export`: converts the results of a run to another format.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::Args;
use tumble_io::export::{Export, ExportError, ExportOptions};
use tumble_io::picture::View;
use tumble_io::replay::{Replay, ReplayError};

use crate::console::{print_error, progress_bar};
use crate::failure::{Failure, print};
use crate::format::count;
use crate::interrupt::stop_flag;

#[derive(Args)]
#[command(after_help = "Formats, selected by the extension of FILE:\n  \
    .glb   glTF 2.0, e.g. for Blender          .csv  trajectory\n  \
    .usda  USD                                 .png  motion in one picture\n  \
    .pvd   VTK, for ParaView and PyVista       .gif  animation\n  \
    .mp4   video (requires ffmpeg)")]
pub struct ExportArgs {
    /// Folder of the run
    run: PathBuf,
    /// Output file
    #[arg(long, value_name = "FILE")]
    to: PathBuf,
    /// Frames per simulated second [default: all recorded frames; .gif and .mp4: about 30]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    fps: Option<f64>,
    /// Image size in pixels [default: .png 1600x1000, .gif 800x500, .mp4 1280x800]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Start time (s) [default: the start of the run]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    from: Option<f64>,
    /// End time (s) [default: the end of the run]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    to_time: Option<f64>,
    /// Camera of images: yaw and pitch in degrees, and zoom factor (1 shows everything)
    #[arg(long, value_name = "YAW,PITCH[,ZOOM]", value_parser = view, allow_hyphen_values = true)]
    camera: Option<View>,
    /// Draw only the state at this time (s); .png only
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    at: Option<f64>,
    /// Overwrite FILE
    #[arg(long)]
    force: bool,
}

pub fn export(args: &ExportArgs) -> Result<(), Failure> {
    let ExportArgs { fps, size, from, to_time, camera: view, at, force, .. } = *args;
    let options = ExportOptions { fps, size, from, to_time, view, at, force };
    let export = Export::new(&args.to, options).map_err(|error| failure(&error))?;
    let replay = Replay::open(&args.run).map_err(|error| match &error {
        ReplayError::Scene(error) => Failure::from(error),
        _ => Failure::call(&error),
    })?;
    let stop = stop_flag();
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
        print_error(&error.to_string());
        return Failure::Interrupted;
    }
    if error.is_invalid_request() {
        Failure::call(error)
    } else {
        Failure::Run(format!("error: {error}"))
    }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X', '×']);
    let sides = sides.and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    sides.ok_or_else(|| "must be width and height in pixels, as in 800x500".to_owned())
}

fn view(text: &str) -> Result<View, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    let (yaw, pitch, zoom) = match numbers.as_deref() {
        Some(&[yaw, pitch]) => (yaw, pitch, 1.0),
        Some(&[yaw, pitch, zoom]) => (yaw, pitch, zoom),
        _ => return Err("must be angles in degrees, as in 30,20 or with zoom 30,20,1.5".to_owned()),
    };
    Ok(View { yaw: f64::to_radians(yaw), pitch: f64::to_radians(pitch), zoom })
}
