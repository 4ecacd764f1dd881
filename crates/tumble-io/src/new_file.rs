//! Files that are made anew.

use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Creates a file. What lies at `path` is removed first: what is written never reaches the target of a link, or another
/// name of an old file.
///
/// # Errors
/// What lies there cannot be removed, or the file cannot be created.
pub(crate) fn create_anew(path: &Path) -> io::Result<File> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => File::create_new(path),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::io::Write;

    use super::*;

    #[cfg(unix)]
    #[test]
    fn links_are_replaced_and_not_followed() {
        let dir = tempfile::tempdir().unwrap();
        let (target, link, name) =
            (dir.path().join("target"), dir.path().join("link"), dir.path().join("name"));
        fs::write(&target, "mine").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        fs::hard_link(&target, &name).unwrap();
        for path in [&link, &name, &dir.path().join("new")] {
            create_anew(path).unwrap().write_all(b"new").unwrap();
            assert_eq!(fs::read_to_string(path).unwrap(), "new");
            assert!(!path.is_symlink());
        }
        assert_eq!(fs::read_to_string(&target).unwrap(), "mine");
        assert!(create_anew(dir.path()).is_err());
    }
}
