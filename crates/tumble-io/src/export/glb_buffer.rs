//! The binary buffer of a `.glb`, with its buffer views and accessors.

use serde_json::{Value, json};

/// Buffer view target for vertex attributes (`ARRAY_BUFFER`).
pub(super) const ARRAY_BUFFER: u32 = 34962;
/// Buffer view target for indices.
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
// component types
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

/// Builds the buffer of a `.glb`. BufferBuilder are stored one after the other.
#[derive(Default)]
pub(super) struct BufferBuilder {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl BufferBuilder {
    /// Appends vectors of `N` numbers. `bounds` adds the minimum and maximum of each component, which
    /// glTF requires for positions and times.
    ///
    /// Returns the index of the accessor, or `None` if a number is not finite in single precision.
    pub fn add_vectors<const N: usize>(
        &mut self,
        vectors: &[[f32; N]],
        target: Option<u32>,
        bounds: bool,
    ) -> Option<usize> {
        let start = self.bytes.len();
        let (mut low, mut high) = ([f32::MAX; N], [f32::MIN; N]);
        for vector in vectors {
            for (i, number) in vector.iter().enumerate() {
                if !number.is_finite() {
                    return None;
                }
                low[i] = low[i].min(*number);
                high[i] = high[i].max(*number);
                self.bytes.extend(number.to_le_bytes());
            }
        }
        let element_type = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let mut accessor = json!({
            "bufferView": self.add_view(start, target),
            "componentType": FLOAT, "count": vectors.len(), "type": element_type,
        });
        if bounds {
            accessor["min"] = json!(low.as_slice());
            accessor["max"] = json!(high.as_slice());
        }
        self.accessors.push(accessor);
        Some(self.accessors.len() - 1)
    }

    /// Appends vertex indices. Returns the index of the accessor.
    pub fn add_indices(&mut self, indices: &[u32]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
        let view = self.add_view(start, Some(ELEMENT_ARRAY_BUFFER));
        self.accessors.push(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR",
        }));
        self.accessors.len() - 1
    }

    /// Adds a view of the bytes from `start` to the end of the buffer.
    fn add_view(&mut self, start: usize, target: Option<u32>) -> usize {
        let length = self.bytes.len() - start;
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.views.len() - 1
    }
}
