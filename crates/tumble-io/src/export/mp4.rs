//! `.mp4`: a video in real time, encoded by the program `ffmpeg`.

use std::io::{self, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::{self, JoinHandle};

use super::error::ExportError;
use super::images::with_renderer;
use super::job::{Exported, Job, Progress, report};
use super::partial_file::PartialFile;

/// Maximum length of the error message of `ffmpeg` (bytes).
const MAX_MESSAGE: u64 = 1 << 16;

pub(super) fn write(job: &Job, progress: &mut Progress) -> Result<Exported, ExportError> {
    let (width, height) = job.options.image_size(job.format);
    // H.264 with 4:2:0 chroma subsampling requires even sides
    let size = (width.next_multiple_of(2), height.next_multiple_of(2));
    let file = job.create_file()?;
    let mut encoder = Ffmpeg::start(&file, size, job.selection.rate)?;
    let indices = &job.selection.indices;
    with_renderer(job, size, |renderer| {
        for (done, &index) in indices.iter().enumerate() {
            report(progress, done, indices.len())?;
            if let Err(error) = encoder.write_frame(&renderer.render_animation_frame(index).pixels)
            {
                // Ctrl-C also ends ffmpeg: report that the export was stopped, not a broken pipe
                report(progress, done, indices.len())?;
                return Err(encoder.failure(&error.to_string()));
            }
        }
        Ok(())
    })?;
    encoder.finish()?;
    Ok(Exported { frames: indices.len(), bytes: file.finish()? })
}

/// A running `ffmpeg` process, killed on drop.
struct Ffmpeg {
    child: Child,
    frames: Option<ChildStdin>,
    /// Reads the error messages.
    messages: Option<JoinHandle<String>>,
}

impl Ffmpeg {
    /// Starts the program, for frames of `size` (width and height in pixels) at `rate` (1/s).
    fn start(file: &PartialFile, size: (u32, u32), rate: f64) -> Result<Self, ExportError> {
        let mut command = Command::new("ffmpeg");
        command.args(["-hide_banner", "-loglevel", "error", "-y"]);
        command.args(["-f", "rawvideo", "-pix_fmt", "rgb24"]);
        command.args(["-s", &format!("{}x{}", size.0, size.1), "-r", &format!("{rate:.6}")]);
        command.args(["-i", "pipe:0", "-an", "-c:v", "libx264", "-crf", "18"]);
        command.args(["-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"]);
        // without the prefix, a name with a leading dash would be an option
        let mut target = std::ffi::OsString::from("file:");
        target.push(file.temporary());
        command.arg(target);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => ExportError::NoFfmpeg,
            _ => ExportError::Ffmpeg(error.to_string()),
        })?;
        let frames = child.stdin.take();
        // read continuously, because the program blocks when the pipe is full
        let messages = child.stderr.take().map(|mut stderr| {
            thread::spawn(move || {
                let mut message = Vec::new();
                let _ = stderr.by_ref().take(MAX_MESSAGE).read_to_end(&mut message);
                let _ = io::copy(&mut stderr, &mut io::sink());
                String::from_utf8_lossy(&message).into_owned()
            })
        });
        Ok(Self { child, frames, messages })
    }

    fn write_frame(&mut self, pixels: &[u8]) -> io::Result<()> {
        self.frames.as_mut().map_or(Ok(()), |frames| frames.write_all(pixels))
    }

    /// Closes the input and waits until the video is written.
    fn finish(mut self) -> Result<(), ExportError> {
        drop(self.frames.take());
        match self.child.wait() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(self.failure(&status.to_string())),
            Err(error) => Err(self.failure(&error.to_string())),
        }
    }

    /// Ends the process. Returns an error with its message, or with `default` if it wrote none.
    fn failure(&mut self, default: &str) -> ExportError {
        self.kill();
        let message =
            self.messages.take().and_then(|thread| thread.join().ok()).unwrap_or_default();
        let message = message.trim();
        ExportError::Ffmpeg(if message.is_empty() { default } else { message }.to_owned())
    }

    fn kill(&mut self) {
        drop(self.frames.take());
        // fails if the process has ended already
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        self.kill();
    }
}
