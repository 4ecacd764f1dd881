//! The mesh formats and how to recognise them.

/// The formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ, text (`.obj`).
    Obj,
    /// STL, text or binary (`.stl`).
    Stl,
    /// Polygon file format, text or binary of either byte order (`.ply`).
    Ply,
    /// glTF 2, text or binary (`.gltf`, `.glb`; the content tells which).
    Gltf,
}

impl Format {
    /// The supported extensions, for messages.
    pub const SUPPORTED: &'static str = ".obj, .stl, .ply, .gltf, .glb";

    /// The format of a file extension without its dot, in upper or lower case.
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }

    /// Whether vertices are welded by default.
    pub fn welds(self) -> bool {
        matches!(self, Self::Stl | Self::Gltf)
    }

    /// The format that the first bytes indicate, if they are distinctive.
    pub(super) fn sniff(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [b'g', b'l', b'T', b'F', ..] => Some(Self::Gltf),
            [b'p', b'l', b'y', b'\n' | b'\r', ..] => Some(Self::Ply),
            [b's', b'o', b'l', b'i', b'd', b' ' | b'\n' | b'\r', ..] => Some(Self::Stl),
            _ => None,
        }
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Ply => "PLY",
            Self::Gltf => "glTF",
        })
    }
}
