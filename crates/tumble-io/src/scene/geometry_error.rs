//! Why the shape of a body cannot be built.

/// A shape that cannot be built: the key in the scene, and what is wrong.
#[derive(Debug)]
pub struct GeometryError {
    /// Key of the body that causes the error.
    pub key: &'static str,
    /// What is wrong and what to do.
    pub message: String,
}

/// An error at a key of the body.
pub fn error(key: &'static str, message: impl std::fmt::Display) -> GeometryError {
    GeometryError { key, message: message.to_string() }
}
