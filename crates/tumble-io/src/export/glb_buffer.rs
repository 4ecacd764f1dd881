//! The binary part of a `.glb`: arrays, and what says what they are.

use serde_json::{Value, json};

/// Numbers of the specification: what an array is used for, and of what it is made.
pub(super) const VERTICES: u32 = 34962;
pub(super) const INDICES: u32 = 34963;
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

/// The arrays of a `.glb`, one after the other.
#[derive(Default)]
pub(super) struct Arrays {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Arrays {
    /// Vectors of `N` numbers; with their least and greatest where `bounds` says so. Returns the
    /// number of the accessor; `None` if a number is not finite in single precision.
    pub fn vectors<const N: usize>(
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
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let mut accessor = json!({
            "bufferView": self.view(start, target),
            "componentType": FLOAT, "count": vectors.len(), "type": kind,
        });
        if bounds {
            accessor["min"] = json!(low.as_slice());
            accessor["max"] = json!(high.as_slice());
        }
        self.accessors.push(accessor);
        Some(self.accessors.len() - 1)
    }

    /// Indices of vertices.
    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
        let view = self.view(start, Some(INDICES));
        self.accessors.push(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR",
        }));
        self.accessors.len() - 1
    }

    fn view(&mut self, start: usize, target: Option<u32>) -> usize {
        let length = self.bytes.len() - start;
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.views.len() - 1
    }
}
