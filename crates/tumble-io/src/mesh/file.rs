//! Finds and reads mesh files, and rejects paths that are not regular files.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use super::error::ReadError;
use super::format::Format;

/// Larger files are rejected without reading them.
pub(super) const MAX_BYTES: u64 = 4 << 30;

/// Rejects a path that does not exist or is not a regular file.
pub(super) fn check_exists(path: &Path) -> Result<(), ReadError> {
    match fs::metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(missing(path)),
        Err(error) => Err(ReadError::new(None, format!("the file cannot be read: {error}"))),
        Ok(metadata) if metadata.is_dir() => {
            Err(ReadError::new(None, "this is a folder; give the path of a mesh file in it"))
        }
        Ok(metadata) if !metadata.is_file() => Err(ReadError::new(
            None,
            "this is not a regular file (but a device, pipe or socket); give a mesh file",
        )),
        Ok(metadata) if metadata.len() > MAX_BYTES => Err(ReadError::new(
            None,
            format!(
                "the file has {:.1} GiB; at most 4 GiB are read: simplify the mesh first",
                metadata.len() as f64 / f64::from(1 << 30)
            ),
        )),
        Ok(_) => Ok(()),
    }
}

/// The format of the extension.
pub(super) fn format_of(path: &Path) -> Result<Format, ReadError> {
    let supported = Format::SUPPORTED;
    match path.extension().map(|e| e.to_string_lossy()) {
        None => Err(ReadError::new(
            None,
            format!("the file name has no extension to tell its format; supported are {supported}"),
        )),
        Some(extension) => Format::from_extension(&extension).ok_or_else(|| {
            let message = format!(
                "unknown mesh format .{extension}; supported are {supported}: convert it first"
            );
            ReadError::new(None, message)
        }),
    }
}

/// The bytes of a file that [`check_exists`] has accepted.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes));
    match read {
        Err(error) => Err(ReadError::new(None, format!("the file cannot be read: {error}"))),
        // the file grew in the meantime
        Ok(_) if bytes.len() as u64 > MAX_BYTES => {
            Err(ReadError::new(None, "the file has more than 4 GiB; at most 4 GiB are read"))
        }
        Ok(_) => Ok(bytes),
    }
}

/// The real path of a side file, which must be in the folder of the main file or below it.
pub(super) fn side_file(folder: &Path, name: &str) -> Result<PathBuf, ReadError> {
    let outside = || {
        let message =
            format!("the side file {name:?} must lie beside the file or in a folder below it");
        ReadError::new(None, message)
    };
    let relative = Path::new(name);
    if !relative.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(outside());
    }
    // an empty folder is the current one
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let path = folder.join(relative);
    check_exists(&path).map_err(|error| {
        ReadError::new(None, format!("the side file {name:?}: {}", error.message))
    })?;
    // links must not lead out either
    match (folder.canonicalize(), path.canonicalize()) {
        (Ok(folder), Ok(path)) if path.starts_with(&folder) => Ok(path),
        _ => Err(outside()),
    }
}

/// The error for a missing file, with a suggestion if there is a similar name.
fn missing(path: &Path) -> ReadError {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let message = if !folder.is_dir() {
        format!("no such file: the folder {} does not exist either", folder.display())
    } else if let Some(name) = nearest_name(folder, path) {
        format!("no such file; did you mean {name:?}?")
    } else {
        "no such file".to_owned()
    };
    ReadError::new(None, message)
}

/// The mesh file in the folder with the most similar name, if one is similar enough.
fn nearest_name(folder: &Path, path: &Path) -> Option<String> {
    let wanted: Vec<char> = path.file_name()?.to_str()?.to_lowercase().chars().take(256).collect();
    let near = (wanted.len() / 3).clamp(1, 4);
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_ascii_lowercase());
    fs::read_dir(folder)
        .ok()?
        .take(10_000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| format_of(Path::new(name)).is_ok())
        .map(|name| {
            let chars: Vec<char> = name.to_lowercase().chars().take(256).collect();
            // the same name with another extension counts as one edit
            let same_stem = stem(Path::new(&name)) == stem(path);
            (if same_stem { 1 } else { edit_distance(&wanted, &chars) }, name)
        })
        .filter(|(distance, _)| *distance <= near)
        .min()
        .map(|(_, name)| name)
}

/// The Levenshtein distance between two words.
fn edit_distance(a: &[char], b: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let replace = diagonal + usize::from(from != to);
            diagonal = row[j + 1];
            row[j + 1] = replace.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
