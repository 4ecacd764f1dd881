//! `.mp4`: a film in real time, by way of the program `ffmpeg`.

use std::io::{self, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::{self, JoinHandle};

use super::draft::Draft;
use super::png::drawn;
use super::{ExportError, Exported, Job, Watch, tell};

/// So much of what ffmpeg says is kept (bytes).
const MOST_SAID: u64 = 1 << 16;

pub(super) fn write(job: &Job, watch: &mut Watch) -> Result<Exported, ExportError> {
    let (width, height) = job.export.options.picture_size(job.export.format);
    // H.264 stores colours for squares of four pixels
    let size = (width.next_multiple_of(2), height.next_multiple_of(2));
    let draft = job.draft()?;
    let mut film = Ffmpeg::start(&draft, size, job.chosen.rate)?;
    let indices = &job.chosen.indices;
    drawn(job, size, |studio| {
        for (done, &index) in indices.iter().enumerate() {
            tell(watch, done, indices.len())?;
            if let Err(error) = film.show(&studio.render_animation_frame(index).pixels) {
                // Ctrl-C reaches ffmpeg, too
                tell(watch, done, indices.len())?;
                return Err(film.complaint(&error.to_string()));
            }
        }
        Ok(())
    })?;
    film.finish()?;
    Ok(Exported { frames: indices.len(), bytes: draft.finish()? })
}

/// A running `ffmpeg`; it is ended when it is dropped.
struct Ffmpeg {
    child: Child,
    frames: Option<ChildStdin>,
    said: Option<JoinHandle<String>>,
}

impl Ffmpeg {
    /// Starts the program; it reads frames of this size (pixels) and rate (1/s).
    fn start(draft: &Draft, size: (u32, u32), rate: f64) -> Result<Self, ExportError> {
        let mut command = Command::new("ffmpeg");
        command.args(["-hide_banner", "-loglevel", "error", "-y"]);
        command.args(["-f", "rawvideo", "-pix_fmt", "rgb24"]);
        command.args(["-s", &format!("{}x{}", size.0, size.1), "-r", &format!("{rate:.6}")]);
        command.args(["-i", "pipe:0", "-an", "-c:v", "libx264", "-crf", "18"]);
        command.args(["-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"]);
        // a name that begins with a dash would be an option
        let mut target = std::ffi::OsString::from("file:");
        target.push(draft.temporary());
        command.arg(target);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => ExportError::NoFfmpeg,
            _ => ExportError::Ffmpeg(error.to_string()),
        })?;
        let frames = child.stdin.take();
        // read all the time, lest the program waits for a reader
        let said = child.stderr.take().map(|mut from| {
            thread::spawn(move || {
                let mut said = Vec::new();
                let _ = from.by_ref().take(MOST_SAID).read_to_end(&mut said);
                let _ = io::copy(&mut from, &mut io::sink());
                String::from_utf8_lossy(&said).into_owned()
            })
        });
        Ok(Self { child, frames, said })
    }

    fn show(&mut self, pixels: &[u8]) -> io::Result<()> {
        self.frames.as_mut().map_or(Ok(()), |frames| frames.write_all(pixels))
    }

    /// Waits for the end of the film.
    fn finish(mut self) -> Result<(), ExportError> {
        drop(self.frames.take());
        match self.child.wait() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(self.complaint(&status.to_string())),
            Err(error) => Err(self.complaint(&error.to_string())),
        }
    }

    /// What the program said, or else `otherwise`.
    fn complaint(&mut self, otherwise: &str) -> ExportError {
        self.end();
        let said = self.said.take().and_then(|said| said.join().ok()).unwrap_or_default();
        let said = said.trim();
        ExportError::Ffmpeg(if said.is_empty() { otherwise } else { said }.to_owned())
    }

    fn end(&mut self) {
        drop(self.frames.take());
        // it may have ended by itself
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        self.end();
    }
}
