//! `.png`: one image of the whole motion or of the state at one time.

use std::io::Write;

use super::error::ExportError;
use super::images::with_renderer;
use super::job::{Exported, Job, Progress, report};
use crate::picture::encode_png;

pub(super) fn write(job: &Job, progress: &mut Progress) -> Result<Exported, ExportError> {
    let frame = job.options.at.map(|time| job.selection.frame_at(time)).transpose()?;
    let size = job.options.image_size(job.format);
    let image = with_renderer(job, size, |renderer| match frame {
        Some(frame) => renderer.render_frame(frame),
        None => renderer.render_motion(),
    });
    report(progress, 1, 1)?;
    let bytes = encode_png(&image).map_err(|error| ExportError::Draw(error.to_string()))?;
    let mut out = job.create_file()?;
    out.write_all(&bytes).map_err(|error| job.write_error(error))?;
    Ok(Exported { frames: 1, bytes: out.finish()? })
}
