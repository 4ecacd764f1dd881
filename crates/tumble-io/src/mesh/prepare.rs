//! Puts the triangles of a mesh right: duplicates, winding and, on request, holes.

use tumble::{Closed, Deduplicated, Hole, HoleError, Mesh, Oriented};

use crate::counted::counted;

/// What is done to a mesh on request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repair {
    /// Nothing.
    #[default]
    None,
    /// Its holes are closed.
    Close,
}

impl Repair {
    /// The names in scenes and on the command line.
    pub const NAMES: [&'static str; 2] = ["none", "close"];

    /// Its name in scenes and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Close => "close",
        }
    }

    /// The one of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::None, Self::Close].into_iter().find(|repair| repair.name() == name)
    }
}

/// A mesh whose triangles have been put right, and what was done.
#[derive(Clone, Debug, PartialEq)]
pub struct Prepared {
    /// The mesh, with the vertices of the file in their order.
    pub mesh: Mesh,
    /// The number of triangles that were left out as copies of others.
    pub copies: usize,
    /// The number of triangles that were left out because there was another one with opposite winding.
    pub opposite: usize,
    /// How the surfaces of the mesh were wound; its own mesh is empty.
    pub orientation: Oriented,
    /// The holes that were closed.
    pub closed: Vec<Hole>,
    /// The number of triangles that close them.
    pub added: usize,
}

/// Leaves out duplicate triangles, closes holes if asked to, and winds closed surfaces outwards, those of cavities inwards.
/// See [`Mesh::without_duplicates`], [`Mesh::with_closed_holes`] and [`Mesh::oriented`].
///
/// # Errors
/// [`HoleError`] if a hole should be closed and cannot be.
pub fn prepare(mesh: &Mesh, repair: Repair) -> Result<Prepared, HoleError> {
    let Deduplicated { mesh, copies, opposite } = mesh.without_duplicates();
    let mut orientation = mesh.oriented();
    let (mut closed, mut added) = (Vec::new(), 0);
    if repair == Repair::Close {
        let found: Closed = orientation.mesh.with_closed_holes()?;
        (closed, added) = (found.holes, found.added);
        if added > 0 {
            // what is closed now may be wound inwards
            let before = orientation;
            orientation = found.mesh.oriented();
            orientation.rewound += before.rewound;
            orientation.turned += before.turned;
        }
    }
    let mesh = std::mem::take(&mut orientation.mesh);
    Ok(Prepared { mesh, copies, opposite, orientation, closed, added })
}

impl Prepared {
    /// What was done to the triangles without being asked for, one sentence each.
    pub fn notes(&self) -> Vec<String> {
        let o = &self.orientation;
        let surfaces = |n| counted(n, "closed surface", "closed surfaces");
        let triangles = |n| counted(n, "triangle", "triangles");
        let mut notes = Vec::new();
        if self.copies > 0 {
            let what = triangles(self.copies);
            notes.push(format!("{what} left out: copies of others"));
        }
        if self.opposite > 0 {
            let what = triangles(self.opposite);
            notes.push(format!("{what} left out: a sheet without thickness, there once each way"));
        }
        if o.rewound > 0 {
            let what = triangles(o.rewound);
            notes.push(format!("{what} wound against their neighbours: turned"));
        }
        if o.turned > 0 {
            let what = surfaces(o.turned);
            notes.push(format!("{what} of {} wound the wrong way: turned", o.shells));
        }
        if o.cavities > 0 {
            let what = surfaces(o.cavities);
            notes.push(format!("{what} of {} inside others: taken as cavities", o.shells));
        }
        if o.crossing > 0 {
            let what = surfaces(o.crossing);
            notes.push(format!(
                "{what} of {} cross others: the volume in common counts twice",
                o.shells
            ));
        }
        if o.is_undecided {
            notes.push(
                "too many closed surfaces in one place to tell cavities: none is taken as one"
                    .to_owned(),
            );
        }
        notes
    }

    /// What was done to holes, if they were to be closed.
    pub fn repair_note(&self) -> Option<String> {
        let first = self.closed.first()?;
        let holes = counted(self.closed.len(), "hole", "holes");
        let triangles = counted(self.added, "triangle", "triangles");
        let (at, more) = (place(first), if self.closed.len() > 1 { ", …" } else { "" });
        Some(format!("{holes} closed with {triangles}, at {at}{more}"))
    }
}

/// The centre of a hole, short.
fn place(hole: &Hole) -> String {
    let short = |x: f64| {
        let size = hole.centre.abs().max_element().max(hole.perimeter);
        // digits below a ten thousandth of the size say nothing
        let digits = (4.0 - size.log10().floor()).clamp(0.0, 12.0) as usize;
        let text = format!("{x:.digits$}");
        let text = if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            &text
        };
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    };
    format!("({}, {}, {})", short(hole.centre.x), short(hole.centre.y), short(hole.centre.z))
}
