//! Buffers and accessors: checked slices of bytes, and their values.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;

use super::super::error::ReadError;
use super::super::file;
use super::schema::{Accessor, Document, Kind, Sparse, SparsePart};
use crate::counted::counted;

/// The buffers of a document. Each is loaded when it is first needed, a file once.
pub(super) struct Buffers<'a> {
    document: &'a Document<'a>,
    binary_chunk: Option<&'a [u8]>,
    folder: Option<&'a Path>,
    loaded: BTreeMap<usize, Bytes<'a>>,
    side_files: BTreeMap<PathBuf, Rc<Vec<u8>>>,
    /// Their names in the document.
    side_names: BTreeSet<PathBuf>,
}

#[derive(Clone)]
enum Bytes<'a> {
    Chunk(&'a [u8]),
    Owned(Rc<Vec<u8>>),
}

/// Elements of an accessor or of a part of a sparse one, checked to lie within their bytes.
struct Elements<'b> {
    bytes: &'b [u8],
    stride: usize,
    component: Component,
    normalized: bool,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn from_code(code: u32) -> Result<Self, ReadError> {
        match code {
            5120 => Ok(Self::I8),
            5121 => Ok(Self::U8),
            5122 => Ok(Self::I16),
            5123 => Ok(Self::U16),
            5125 => Ok(Self::U32),
            5126 => Ok(Self::F32),
            _ => Err(error(format!(
                "unknown componentType {code}; 5120 to 5126 but 5124 are allowed"
            ))),
        }
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

impl<'a> Buffers<'a> {
    pub(super) fn new(
        document: &'a Document<'a>,
        binary_chunk: Option<&'a [u8]>,
        folder: Option<&'a Path>,
    ) -> Self {
        let (loaded, side_files, side_names) = (BTreeMap::new(), BTreeMap::new(), BTreeSet::new());
        Self { document, binary_chunk, folder, loaded, side_files, side_names }
    }

    /// The number of elements of an accessor, as the document declares it.
    pub(super) fn count(&self, accessor: usize) -> Result<usize, ReadError> {
        Ok(self.accessor(accessor)?.count)
    }

    /// Total size of the side files that have been loaded (bytes).
    pub(super) fn side_bytes(&self) -> usize {
        self.side_files.values().map(|bytes| bytes.len()).sum()
    }

    /// The side files that have been loaded, relative to the folder of the document.
    pub(super) fn into_side_names(self) -> Vec<PathBuf> {
        self.side_names.into_iter().collect()
    }

    /// Loads the buffers of an accessor.
    pub(super) fn load(&mut self, accessor: usize) -> Result<(), ReadError> {
        let document = self.document;
        let accessor = self.accessor(accessor)?;
        let sparse =
            accessor.sparse.iter().flat_map(|s| [s.indices.buffer_view, s.values.buffer_view]);
        for view in sparse.chain(accessor.buffer_view) {
            let view = get(&document.buffer_views, view, "bufferView")?;
            self.load_buffer(view.buffer)?;
        }
        Ok(())
    }

    fn accessor(&self, index: usize) -> Result<&'a Accessor, ReadError> {
        get(&self.document.accessors, index, "accessor")
    }

    /// The positions of an accessor whose buffers are loaded.
    pub(super) fn positions(&self, index: usize) -> Result<Vec<DVec3>, ReadError> {
        let rows = self.rows::<3>(index, "POSITION")?;
        let positions: Vec<DVec3> = rows.into_iter().map(DVec3::from_array).collect();
        match positions.iter().position(|p| !p.is_finite()) {
            None => Ok(positions),
            Some(i) => {
                let what = positions[i];
                Err(error(format!("position {i} of accessor {index} is {what}; it must be finite")))
            }
        }
    }

    /// The elements of an accessor whose buffers are loaded, of `W` components each. `what` they are is for messages.
    pub(super) fn rows<const W: usize>(
        &self,
        index: usize,
        what: &str,
    ) -> Result<Vec<[f64; W]>, ReadError> {
        let accessor = self.accessor(index)?;
        let (kind, name) = match W {
            3 => (Kind::Vec3, "VEC3"),
            4 => (Kind::Vec4, "VEC4"),
            _ => (Kind::Mat4, "MAT4"),
        };
        if accessor.kind != kind {
            return Err(error(format!("accessor {index} holds {what} and must be of type {name}")));
        }
        let dense = self.dense(accessor, W, index)?;
        let mut rows = match &dense {
            Some(elements) => (0..accessor.count).map(|i| elements.row(i)).collect(),
            None => vec![[0.0; W]; accessor.count],
        };
        if let Some(sparse) = &accessor.sparse {
            let (places, values) = self.sparse(accessor, sparse, W, index)?;
            for i in 0..sparse.count {
                let place = places.integer(i) as usize;
                *rows.get_mut(place).ok_or_else(|| bad_sparse(index, place))? = values.row(i);
            }
        }
        Ok(rows)
    }

    /// The vertex indices of an accessor whose buffers are loaded.
    pub(super) fn indices(&self, index: usize) -> Result<Vec<u32>, ReadError> {
        let accessor = self.accessor(index)?;
        let component = Component::from_code(accessor.component_type)?;
        let unsigned = matches!(component, Component::U8 | Component::U16 | Component::U32);
        if accessor.kind != Kind::Scalar || !unsigned {
            return Err(error(format!(
                "accessor {index} holds indices and must be SCALAR, of unsigned whole numbers"
            )));
        }
        let dense = self.dense(accessor, 1, index)?;
        let mut indices: Vec<u32> = match &dense {
            Some(elements) => (0..accessor.count).map(|i| elements.integer(i)).collect(),
            None => vec![0; accessor.count],
        };
        if let Some(sparse) = &accessor.sparse {
            let (places, values) = self.sparse(accessor, sparse, 1, index)?;
            for i in 0..sparse.count {
                let place = places.integer(i) as usize;
                *indices.get_mut(place).ok_or_else(|| bad_sparse(index, place))? =
                    values.integer(i);
            }
        }
        Ok(indices)
    }

    /// The dense elements of an accessor; `None` if it has only sparse values, whose base is zero.
    fn dense(
        &self,
        accessor: &Accessor,
        width: usize,
        index: usize,
    ) -> Result<Option<Elements<'_>>, ReadError> {
        let component = Component::from_code(accessor.component_type)?;
        match (accessor.buffer_view, &accessor.sparse) {
            (None, None) => {
                Err(error(format!("accessor {index} has no bufferView, that is, no data")))
            }
            (None, Some(_)) => Ok(None),
            (Some(view), _) => {
                let part = SparsePart {
                    buffer_view: view,
                    byte_offset: accessor.byte_offset,
                    component_type: accessor.component_type,
                };
                let mut elements = self.elements(&part, component, width, accessor.count)?;
                elements.normalized = accessor.normalized;
                Ok(Some(elements))
            }
        }
    }

    fn sparse(
        &self,
        accessor: &Accessor,
        sparse: &Sparse,
        width: usize,
        index: usize,
    ) -> Result<(Elements<'_>, Elements<'_>), ReadError> {
        let place = Component::from_code(sparse.indices.component_type)?;
        if !matches!(place, Component::U8 | Component::U16 | Component::U32) {
            return Err(error(format!("the sparse indices of accessor {index} must be unsigned")));
        }
        if sparse.count > accessor.count {
            return Err(error(format!("accessor {index} has more sparse values than values")));
        }
        let component = Component::from_code(accessor.component_type)?;
        let places = self.elements(&sparse.indices, place, 1, sparse.count)?;
        let mut values = self.elements(&sparse.values, component, width, sparse.count)?;
        values.normalized = accessor.normalized;
        Ok((places, values))
    }

    /// Checks that `count` elements of `width` components lie within their view, and the view within its buffer.
    fn elements(
        &self,
        part: &SparsePart,
        component: Component,
        width: usize,
        count: usize,
    ) -> Result<Elements<'_>, ReadError> {
        let view = get(&self.document.buffer_views, part.buffer_view, "bufferView")?;
        let bytes = match self.loaded.get(&view.buffer) {
            Some(Bytes::Chunk(bytes)) => bytes,
            Some(Bytes::Owned(bytes)) => bytes.as_slice(),
            None => return Err(error(format!("buffer {} is not loaded", view.buffer))),
        };
        let view_bytes = view
            .byte_offset
            .checked_add(view.byte_length)
            .and_then(|end| bytes.get(view.byte_offset..end))
            .ok_or_else(|| {
                error(format!(
                    "bufferView {} reaches beyond the {} of buffer {}",
                    part.buffer_view,
                    counted(bytes.len(), "byte", "bytes"),
                    view.buffer
                ))
            })?;
        let size = component.size() * width;
        let stride = view.byte_stride.unwrap_or(size);
        if stride < size {
            return Err(error(format!(
                "bufferView {} has a byteStride of {stride}, but each element takes {}",
                part.buffer_view,
                counted(size, "byte", "bytes")
            )));
        }
        let needed = count.saturating_sub(1).checked_mul(stride).and_then(|n| n.checked_add(size));
        needed
            .and_then(|needed| part.byte_offset.checked_add(needed))
            .and_then(|end| view_bytes.get(part.byte_offset..end))
            .map(|bytes| Elements { bytes, stride, component, normalized: false })
            .ok_or_else(|| {
                error(format!(
                    "an accessor with {} reaches beyond the {} of bufferView {}",
                    counted(count, "element", "elements"),
                    counted(view.byte_length, "byte", "bytes"),
                    part.buffer_view
                ))
            })
    }

    fn load_buffer(&mut self, index: usize) -> Result<(), ReadError> {
        if self.loaded.contains_key(&index) {
            return Ok(());
        }
        let buffer = get(&self.document.buffers, index, "buffer")?;
        let bytes = match buffer.uri.as_deref() {
            None => Bytes::Chunk(self.binary_chunk.filter(|_| index == 0).ok_or_else(|| {
                error(format!(
                    "buffer {index} has no uri; only the first one of a .glb may do without"
                ))
            })?),
            Some(uri) => match uri.strip_prefix("data:") {
                Some(data) => Bytes::Owned(Rc::new(decode(data, index)?)),
                None => Bytes::Owned(self.side_file(uri)?),
            },
        };
        let length = match &bytes {
            Bytes::Chunk(bytes) => bytes.len(),
            Bytes::Owned(bytes) => bytes.len(),
        };
        if length < buffer.byte_length {
            return Err(error(format!(
                "buffer {index} promises {} bytes, but only {length} are there: it is truncated",
                buffer.byte_length
            )));
        }
        self.loaded.insert(index, bytes);
        Ok(())
    }

    fn side_file(&mut self, uri: &str) -> Result<Rc<Vec<u8>>, ReadError> {
        let name = percent_decode(uri)
            .ok_or_else(|| error(format!("the buffer uri {uri:.80?} is not well formed")))?;
        let folder = self.folder.ok_or_else(|| {
            error(format!("the side file {name:.80?} is needed, but there is no folder to look in"))
        })?;
        let path = file::side_file(folder, &name)?;
        self.side_names.insert(PathBuf::from(name));
        if let Some(known) = self.side_files.get(&path) {
            return Ok(known.clone());
        }
        let bytes = Rc::new(file::read(&path)?);
        self.side_files.insert(path, bytes.clone());
        if self.side_bytes() as u64 > file::MAX_BYTES {
            return Err(error("the side files have more than 4 GiB together"));
        }
        Ok(bytes)
    }
}

impl Elements<'_> {
    /// Component `k` of element `i`, which must be within the checked count.
    fn component<const N: usize>(&self, i: usize, k: usize) -> [u8; N] {
        let at = i * self.stride + k * N;
        self.bytes[at..].first_chunk().copied().unwrap_or([0; N])
    }

    fn integer(&self, i: usize) -> u32 {
        match self.component.size() {
            1 => u8::from_le_bytes(self.component(i, 0)).into(),
            2 => u16::from_le_bytes(self.component(i, 0)).into(),
            _ => u32::from_le_bytes(self.component(i, 0)),
        }
    }

    fn row<const W: usize>(&self, i: usize) -> [f64; W] {
        std::array::from_fn(|k| self.number(i, k))
    }

    /// A component as a number; normalised integers are fractions (KHR_mesh_quantization).
    fn number(&self, i: usize, k: usize) -> f64 {
        let (value, largest): (f64, f64) = match self.component {
            Component::I8 => (i8::from_le_bytes(self.component(i, k)).into(), 127.0),
            Component::U8 => (u8::from_le_bytes(self.component(i, k)).into(), 255.0),
            Component::I16 => (i16::from_le_bytes(self.component(i, k)).into(), 32767.0),
            Component::U16 => (u16::from_le_bytes(self.component(i, k)).into(), 65535.0),
            Component::U32 => (u32::from_le_bytes(self.component(i, k)).into(), 1.0),
            Component::F32 => (f32::from_le_bytes(self.component(i, k)).into(), 1.0),
        };
        if self.normalized { (value / largest).max(-1.0) } else { value }
    }
}

/// An entry of one of the document's lists.
pub(super) fn get<'d, T>(list: &'d [T], index: usize, name: &str) -> Result<&'d T, ReadError> {
    list.get(index).ok_or_else(|| {
        error(format!("the file refers to {name} {index}, but has only {} of them", list.len()))
    })
}

pub(super) fn error(message: impl Into<String>) -> ReadError {
    ReadError::new(None, message)
}

fn bad_sparse(accessor: usize, place: usize) -> ReadError {
    error(format!("a sparse index of accessor {accessor} is {place}, beyond its count"))
}

/// The bytes of a data URI, behind its `data:`.
fn decode(data: &str, buffer: usize) -> Result<Vec<u8>, ReadError> {
    let encoded =
        data.split_once(',').and_then(|(kind, body)| kind.ends_with(";base64").then_some(body));
    let Some(encoded) = encoded else {
        return Err(error(format!("the data URI of buffer {buffer} must be base64")));
    };
    STANDARD
        .decode(encoded)
        .map_err(|e| error(format!("the data URI of buffer {buffer} is no base64: {e}")))
}

/// Decodes percent-encoded characters.
fn percent_decode(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if *first == b'%' {
            let (digits, tail) = tail.split_at_checked(2)?;
            bytes.push(u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?);
            rest = tail;
        } else {
            bytes.push(*first);
        }
    }
    String::from_utf8(bytes).ok()
}
