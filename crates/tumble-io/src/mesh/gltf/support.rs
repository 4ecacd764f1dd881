//! What a document needs beyond what is read: other versions of glTF, compression and other extensions.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::super::error::ReadError;
use super::data::error;
use super::schema::Document;

/// Supported extensions that affect vertices.
const SUPPORTED: [&str; 1] = ["KHR_mesh_quantization"];
/// Families of extensions that do not affect geometry.
const IGNORED: [&str; 6] =
    ["KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_xmp", "MSFT_texture_"];
/// Extensions that add to the geometry, even where a document does not require them.
const ADDING: [&str; 1] = ["EXT_mesh_gpu_instancing"];

/// Rejects other versions, and extensions without which the geometry would not be that of the file.
pub(super) fn check(document: &Document<'_>) -> Result<(), ReadError> {
    let version = &document.asset.version;
    if version != "2" && !version.starts_with("2.") {
        return Err(wrong_version(version));
    }
    let is_known = |name: &str| {
        SUPPORTED.contains(&name) || IGNORED.iter().any(|family| name.starts_with(family))
    };
    let mut required = document.extensions_required.iter();
    if let Some(name) = required.find(|name| !is_known(name)) {
        return Err(match compression(name) {
            Some(method) => error(format!(
                "the mesh is compressed with {method} ({name:.80}), which is not supported: export it without compression"
            )),
            None => error(format!(
                "the file requires the extension {name:.80}, which is not supported: export it without"
            )),
        });
    }
    match document.extensions_used.iter().find(|name| ADDING.contains(&name.as_str())) {
        None => Ok(()),
        Some(name) => Err(error(format!(
            "the file uses the extension {name}, which is not supported: export each instance as a node"
        ))),
    }
}

/// A note for errors in the data of a document that may be compressed, without requiring that the reader knows how.
pub(super) fn compression_note(document: &Document<'_>) -> String {
    document
        .extensions_used
        .iter()
        .find_map(|name| Some((name, compression(name)?)))
        .map(|(name, method)| {
            format!(" (the file uses compression with {method}, {name:.80}, which is not supported: export it without)")
        })
        .unwrap_or_default()
}

fn compression(extension: &str) -> Option<&'static str> {
    match extension {
        "KHR_draco_mesh_compression" => Some("Draco"),
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => Some("meshopt"),
        _ => None,
    }
}

/// The error for JSON that does not fit the schema of glTF 2, if it is another version.
pub(super) fn other_version(json: &[u8]) -> Option<ReadError> {
    #[derive(Deserialize)]
    struct Versioned {
        asset: Asset,
    }
    #[derive(Deserialize)]
    struct Asset {
        version: String,
    }
    // glTF 1 names its meshes, and need not state its version
    #[derive(Deserialize)]
    struct Named {
        #[serde(rename = "meshes")]
        _meshes: BTreeMap<String, IgnoredAny>,
    }
    match serde_json::from_slice::<Versioned>(json) {
        Ok(Versioned { asset }) if asset.version.starts_with('2') => None,
        Ok(Versioned { asset }) => Some(wrong_version(&asset.version)),
        Err(_) => serde_json::from_slice::<Named>(json).ok().map(|_| wrong_version("1.0")),
    }
}

fn wrong_version(version: &str) -> ReadError {
    error(format!("the file is glTF {version:.20}; only glTF 2 is read: convert it first"))
}
