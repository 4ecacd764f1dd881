//! The properties of a mesh, and what it will work as.

use std::path::Path;

use tumble::{DVec3, MassModel, Mesh, Sampling, Shape, Watertightness};
use tumble_io::mesh::{MeshFile, Prepared, Repair, Weld, WeldReport, prepare, read_mesh};

use crate::failure::{Failure, print};
use crate::format::{count, number, wrapped_columns};
use crate::mesh_verdict::{Verdicts, plural};

/// The most holes, and the most edges of each kind, that are listed.
const MAX_LISTED: usize = 3;

/// How the mesh is read.
#[derive(Clone, Copy, Debug)]
pub struct MeshOptions {
    /// Factor for all coordinates.
    pub scale: f64,
    /// Mass of one particle (kg).
    pub particle_mass: f64,
    /// Which vertices are merged.
    pub weld: Option<Weld>,
    /// What is done to the triangles.
    pub repair: Repair,
}

/// A mesh as a body would have it.
struct Report<'a> {
    file: &'a MeshFile,
    prepared: &'a Prepared,
    shape: &'a Shape,
    options: MeshOptions,
    /// The bounding box of all vertices (m).
    bounds: [DVec3; 2],
}

pub fn mesh_info(path: &Path, options: MeshOptions) -> Result<(), Failure> {
    let MeshOptions { scale, particle_mass, weld, repair } = options;
    for (name, value) in [("--scale", scale), ("--particle-mass", particle_mass)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Failure::call(&format!("{name} must be above 0, but is {value}")));
        }
    }
    let file = read_mesh(path, weld).map_err(|error| Failure::call(&error))?;
    let mut prepared = prepare(&file.mesh, repair).map_err(|error| {
        Failure::call(&format!("{}, in the unit of the file: {error}", path.display()))
    })?;
    for vertex in &mut prepared.mesh.vertices {
        *vertex *= scale;
    }
    let shape = Shape::from_mesh(&prepared.mesh, Sampling::Vertices, MassModel::Particles)
        .map_err(|error| Failure::call(&error))?;
    let infinite = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let vertices = prepared.mesh.vertices.iter();
    let bounds = vertices.fold(infinite, |[low, high], &v| [low.min(v), high.max(v)]);
    let report = Report { file: &file, prepared: &prepared, shape: &shape, options, bounds };
    print(&wrapped_columns(&report.rows()))
}

type Row = (&'static str, String);

impl Report<'_> {
    fn rows(&self) -> Vec<Row> {
        let mut rows = self.of_file();
        rows.extend(self.of_particles());
        rows.extend(self.of_triangles());
        rows.push(("sha256", self.file.sha256.clone()));
        let size = self.bounds[1] - self.bounds[0];
        let verdicts = Verdicts {
            file: self.file,
            mesh: &self.prepared.mesh,
            one_sided: self.prepared.orientation.one_sided > 0,
            scale: self.options.scale,
            size: size.max_element(),
        };
        rows.extend(verdicts.rows(self.shape));
        rows
    }

    fn of_file(&self) -> Vec<Row> {
        let (file, mesh) = (self.file, &self.prepared.mesh);
        let objects = plural(file.object_count, "object", "objects");
        let mut rows = vec![("file", format!("{}, {objects}", file.format))];
        if let Some(unit) = file.header_unit {
            let text =
                format!("the header names {}; numbers are taken as metres times scale", unit.name);
            rows.push(("unit", text));
        }
        rows.push(("particles", particles(file)));
        rows.extend(file.weld.as_ref().map(|weld| ("weld", merged(weld))));
        rows.push(("triangles", count(mesh.triangles.len() as u64)));
        let notes = self.prepared.notes().into_iter().chain(self.prepared.repair_note());
        rows.extend(notes.map(|note| ("", note)));
        rows
    }

    fn of_particles(&self) -> Vec<Row> {
        let (shape, particle_mass) = (self.shape, self.options.particle_mass);
        let mass = particle_mass * shape.moments().count;
        let axes = shape.principal().axes;
        let moments = shape.principal().moments * mass;
        let [low, high] = self.bounds;
        vec![
            ("mass", format!("{} kg ({} kg per particle)", number(mass), number(particle_mass))),
            ("centre of mass", format!("{} m", self.place(shape.centre()))),
            ("size", format!("{} m", self.place(high - low))),
            ("bounds", format!("{} to {} m", self.place(low), self.place(high))),
            ("bounding radius", format!("{} m about the centre of mass", number(shape.radius()))),
            (
                "principal moments",
                format!("{} kg·m²", vector(moments, moments.abs().max_element())),
            ),
            (
                "principal axes",
                [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| vector(axis, 1.0)).join(", "),
            ),
            ("rotational axes", shape.principal().rotation_count().to_string()),
        ]
    }

    fn of_triangles(&self) -> Vec<Row> {
        let mesh = &self.prepared.mesh;
        let mut rows = Vec::new();
        let edges = mesh.watertightness();
        rows.push(("watertight", watertight(&edges)));
        if edges.non_manifold > 0 {
            rows.extend(self.non_manifold(mesh));
        }
        if !edges.is_closed() {
            rows.extend(self.holes(mesh));
        }
        if let Some(place) = self.prepared.orientation.first_one_sided {
            let count = plural(self.prepared.orientation.one_sided, "edge", "edges");
            let at = self.place(place * self.options.scale);
            let text =
                format!("no winding is consistent at {count}, as on a Möbius strip: at {at}");
            rows.push(("one-sided", text));
        }
        if let Ok(solid) = mesh.solid_integrals() {
            let (volume, centre) = (number(solid.measure), self.place(solid.centre));
            rows.push(("volume", format!("{volume} m³, centred at {centre} m")));
        }
        if let Ok(shell) = mesh.shell_integrals() {
            rows.push(("surface area", format!("{} m²", number(shell.measure))));
        }
        rows
    }

    fn non_manifold(&self, mesh: &Mesh) -> Option<Row> {
        let edges = mesh.non_manifold_edges();
        let first: Vec<String> = edges.iter().take(MAX_LISTED).map(|&p| self.place(p)).collect();
        let more = if edges.len() > first.len() { ", …" } else { "" };
        let count = plural(edges.len(), "edge", "edges");
        let text = format!("more than two triangles at {count}: at {}{more}", first.join(", "));
        (!first.is_empty()).then_some(("non-manifold", text))
    }

    fn holes(&self, mesh: &Mesh) -> Vec<Row> {
        let holes = mesh.holes();
        if holes.is_empty() {
            return Vec::new();
        }
        let mut rows = vec![("holes", count(holes.len() as u64))];
        rows.extend(holes.iter().take(MAX_LISTED).map(|hole| {
            let edges = plural(hole.vertices.len(), "edge", "edges");
            let (at, length) = (self.place(hole.centre), number(hole.perimeter));
            let planar = if hole.is_planar { "planar" } else { "not planar" };
            ("", format!("at {at} m: {edges}, {length} m around, {planar}"))
        }));
        if holes.len() > MAX_LISTED {
            rows.push(("", "…".to_owned()));
        }
        rows
    }

    /// A point or a length of the mesh, without the rounding noise of its coordinates.
    fn place(&self, place: DVec3) -> String {
        let [low, high] = self.bounds;
        vector(place, low.abs().max(high.abs()).max_element())
    }
}

fn watertight(edges: &Watertightness) -> String {
    if edges.triangles == 0 {
        return "no: there are no triangles".to_owned();
    }
    if edges.is_closed() {
        return "yes".to_owned();
    }
    let open = (edges.open_edges > 0).then(|| plural(edges.open_edges, "open edge", "open edges"));
    let wound = (edges.wrongly_wound > 0)
        .then(|| plural(edges.wrongly_wound, "wrongly wound edge", "wrongly wound edges"));
    format!("no: {}", open.into_iter().chain(wound).collect::<Vec<_>>().join(", "))
}

fn particles(file: &MeshFile) -> String {
    let (kept, all) = (file.mesh.vertices.len(), file.file_vertex_count);
    if kept == all {
        let mut text = count(kept as u64);
        let repeated = if file.weld.is_none() { file.mesh.welded(Some(0.0)).equal } else { 0 };
        if repeated > 0 {
            let repeated = count(repeated as u64);
            text += &format!(", {repeated} of them where another one is: weld = true merges them");
        }
        return text;
    }
    format!("{} of {} vertices", count(kept as u64), count(all as u64))
}

/// What was merged.
fn merged(weld: &WeldReport) -> String {
    let tolerance = number(weld.tolerance);
    let merged = |n| plural(n, "vertex", "vertices");
    let mut text = match (weld.equal, weld.near) {
        (0, 0) if weld.tolerance == 0.0 => "no vertices are equal".to_owned(),
        (0, 0) => format!("no vertices are equal, nor within {tolerance} at open edges"),
        (equal, 0) => format!("{} merged, equal to others", merged(equal)),
        (equal, near) => format!(
            "{} merged: {} equal to others, {} within {tolerance} of others, at open edges",
            merged(equal + near),
            count(equal as u64),
            count(near as u64)
        ),
    };
    if weld.collapsed > 0 {
        let triangles = plural(weld.collapsed, "triangle", "triangles");
        text += &format!("; {triangles} of no area left out");
    }
    text
}

/// A vector among others of this size; what is rounding beside that is 0.
fn vector(v: DVec3, size: f64) -> String {
    let [x, y, z] = v.to_array().map(|x| number(if x.abs() < 1e-9 * size { 0.0 } else { x }));
    format!("({x}, {y}, {z})")
}
