//! The order of the drawing: surfaces, bodies at several times, paths, then the words.

use super::camera::{Camera, Viewport};
use super::figure::{self, Figure, Light, Paint};
use super::image::Image;
use super::legend::Trail;
use super::raster::Layer;
use super::surface::{self, Edge, Surface};
use super::{MotionPicture, Pose, View, drawable, legend, moments};
use crate::appearance::KINEMATIC_COLOUR;
use glam::DVec3;

/// Colours that the colour-blind can tell apart (Okabe and Ito 2008), without the black.
const COLOURS: [[f32; 3]; 7] = [
    [0.0, 114.0, 178.0],
    [230.0, 159.0, 0.0],
    [0.0, 158.0, 115.0],
    [204.0, 121.0, 167.0],
    [86.0, 180.0, 233.0],
    [213.0, 94.0, 0.0],
    [240.0, 228.0, 66.0],
];
/// The edges of boxes.
const FRAME: [u8; 3] = [158, 34, 34];
/// Where in a pixel the samples lie: no two in one row or column.
const SAMPLES: [(f64, f64); 8] = [
    (-0.4375, -0.0625),
    (-0.3125, 0.3125),
    (-0.1875, -0.3125),
    (-0.0625, 0.1875),
    (0.0625, -0.4375),
    (0.1875, 0.0625),
    (0.3125, -0.1875),
    (0.4375, 0.4375),
];
/// Half as many for the frames of a film, where each is seen for a moment only.
const FILM_SAMPLES: [(f64, f64); 4] =
    [(-0.375, -0.125), (-0.125, 0.375), (0.125, -0.375), (0.375, 0.125)];
/// Angles (rad) from which a scene may be seen, when nobody says from which.
const YAWS: [f64; 4] = [0.55, -0.55, 1.02, -1.02];
/// How far the viewer then looks down (rad).
const PITCH: f64 = 0.38;
/// A picture of one frame shows so many pieces of all paths at most, the latest, so that a later
/// frame of an animation costs no more than an earlier one.
const MOST_PIECES: usize = 8192;

/// The colour of a body.
pub(crate) fn colour(body: usize) -> [f32; 3] {
    let round = (body / COLOURS.len()) % 3;
    // further rounds of the same hues are a little darker
    COLOURS[body % COLOURS.len()].map(|c| c * (1.0 - 0.16 * round as f32))
}

/// How much a driven body hides of what is behind it, out of 255.
const VEIL: u8 = 96;

/// The colour of a body of a picture.
pub(super) fn colour_of(picture: &MotionPicture, body: usize) -> [f32; 3] {
    let is_kinematic = picture.bodies.get(body).is_some_and(|body| body.is_kinematic);
    if is_kinematic { KINEMATIC_COLOUR } else { colour(body) }
}

/// The bodies at one time, and how they are painted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub frame: usize,
    pub paleness: f32,
    pub alpha: u8,
}

/// A path in the picture: the frame of each point, and the point (m).
type Path = Vec<(usize, DVec3)>;

/// The view on a run: what all of its pictures share.
pub struct Studio<'a> {
    picture: MotionPicture<'a>,
    up: DVec3,
    width: u32,
    height: u32,
    camera: Camera,
    figures: Vec<Figure>,
    surfaces: Vec<Vec<Surface>>,
    edges: Vec<Edge>,
    paths: Vec<Path>,
    chosen: Vec<usize>,
}

impl<'a> Studio<'a> {
    /// Finds the view that frames the walls and the whole motion, and prepares the bodies.
    #[must_use]
    pub fn new(picture: &MotionPicture<'a>) -> Self {
        Self::seen_from(picture, None)
    }

    /// As [`Studio::new`], seen from where the caller says.
    #[must_use]
    pub fn seen_from(picture: &MotionPicture<'a>, direction: Option<View>) -> Self {
        let (width, height) = (picture.size.0.clamp(1, 16384), picture.size.1.clamp(1, 16384));
        let up = if drawable(picture.up) { picture.up } else { DVec3::Y };
        let up = up.try_normalize().unwrap_or(DVec3::Y);
        let radii: Vec<f64> = picture.bodies.iter().map(figure::radius).collect();
        let view = legend::viewport(width, height);
        let camera = match direction {
            Some(direction) => {
                let points = landmarks(picture, &radii, up).0;
                Camera::framing(&points, up, direction, view)
            }
            None => best_view(picture, &radii, up, view),
        };
        let pixel = camera.pixel_length();
        let bodies = picture.bodies.iter().zip(&radii);
        let figures: Vec<Figure> =
            bodies.map(|(body, &radius)| Figure::new(body, radius, pixel)).collect();
        let (surfaces, edges) = surface::build(picture.boundary, &camera, up);
        let paths = (0..radii.len()).map(|body| path(picture, body, &camera)).collect();
        let chosen = moments::choose(picture.frames, &figures, &camera);
        let picture = *picture;
        Self { picture, up, width, height, camera, figures, surfaces, edges, paths, chosen }
    }

    /// The whole motion: several times, the earlier the paler.
    #[must_use]
    pub fn motion(&self) -> Image {
        let count = self.chosen.len();
        let moment = |(i, &frame): (usize, &usize)| {
            let age = if count > 1 { 1.0 - i as f32 / (count - 1) as f32 } else { 0.0 };
            let (paleness, alpha) =
                if i + 1 == count { (0.0, 255) } else { (0.14 + 0.46 * age, 215) };
            Moment { frame, paleness, alpha }
        };
        let moments: Vec<Moment> = self.chosen.iter().enumerate().map(moment).collect();
        let mut image = self.draw(&moments, &SAMPLES);
        let trail = self.trail(&moments);
        legend::motion(&mut image, &self.picture, &moments, &trail, &self.camera, self.grid());
        image
    }

    /// One frame in the view of the whole motion, with the paths so far; without bodies if there
    /// is no such frame.
    #[must_use]
    pub fn frame(&self, frame: usize) -> Image {
        self.sampled_frame(frame, &SAMPLES)
    }

    /// As [`Studio::frame`], in half the time: for films.
    #[must_use]
    pub fn film_frame(&self, frame: usize) -> Image {
        self.sampled_frame(frame, &FILM_SAMPLES)
    }

    fn sampled_frame(&self, frame: usize, samples: &[(f64, f64)]) -> Image {
        let moments = [Moment { frame, paleness: 0.0, alpha: 255 }];
        let mut image = self.draw(&moments, samples);
        legend::frame(&mut image, &self.picture, frame, &self.camera, self.grid());
        image
    }

    /// Where a point of the world (m) lies in the pictures: pixels from the upper left corner.
    #[must_use]
    pub fn pixel_of(&self, point: DVec3) -> Option<(f64, f64)> {
        self.camera.project(point).map(|at| (f64::from(at.x), f64::from(at.y)))
    }

    /// The direction from the middle of the pictures to the viewer, of length one.
    #[must_use]
    pub fn toward_viewer(&self) -> DVec3 {
        (self.camera.eye() - self.camera.centre()).normalize_or(DVec3::Z)
    }

    /// The distance of the lines on the floor (m), if there are any.
    fn grid(&self) -> Option<f64> {
        self.surfaces.iter().flatten().map(|surface| surface.grid).find(|&grid| grid > 0.0)
    }

    fn draw(&self, moments: &[Moment], samples: &[(f64, f64)]) -> Image {
        let surfaces = self.shaded_surfaces(moments);
        let threads = std::thread::available_parallelism().map_or(1, usize::from).min(4);
        let part = |thread| {
            let samples: Vec<_> = samples.iter().copied().skip(thread).step_by(threads).collect();
            self.sum_samples(&samples, moments, &surfaces)
        };
        let mut sums = vec![[0u16; 3]; self.width as usize * self.height as usize];
        std::thread::scope(|scope| {
            let part = &part;
            let others: Vec<_> =
                (1..threads).map(|thread| scope.spawn(move || part(thread))).collect();
            let others = others.into_iter().enumerate();
            let own = part(0);
            // whole numbers: the sum does not depend on how many threads share it
            add(&mut sums, &own);
            for (index, other) in others {
                add(&mut sums, &other.join().unwrap_or_else(|_| part(index + 1)));
            }
        });
        let mean = |sum: u16| ((usize::from(sum) + samples.len() / 2) / samples.len()) as u8;
        let pixels = sums.iter().flat_map(|rgb| rgb.map(mean)).collect();
        Image { width: self.width, height: self.height, pixels }
    }

    /// The sum of the samples that fall to one of several threads.
    fn sum_samples(
        &self,
        samples: &[(f64, f64)],
        moments: &[Moment],
        surfaces: &[Vec<Surface>],
    ) -> Vec<[u16; 3]> {
        let mut layers = self.layers(moments);
        let mut sums = vec![[0u16; 3]; self.width as usize * self.height as usize];
        for &(x, y) in samples {
            let camera = self.camera.shifted(x, y);
            layers.iter_mut().for_each(Layer::clear);
            self.draw_sample(&camera, moments, surfaces, &mut layers);
            self.add_up(&layers, &mut sums);
        }
        sums
    }

    /// Where the only body of a picture is at each of the times, and its path.
    fn trail(&self, moments: &[Moment]) -> Trail {
        let ([figure], [path]) = (self.figures.as_slice(), self.paths.as_slice()) else {
            return Trail::default();
        };
        let at = |moment: &Moment| {
            let pose = self.picture.frames.get(moment.frame)?.pose(0)?;
            figure.outline(&pose, &self.camera)
        };
        let outlines = moments.iter().map(|m| at(m).unwrap_or([i32::MIN / 4; 4])).collect();
        let places = path.iter().filter_map(|(_, point)| self.camera.project(*point));
        Trail { outlines, path: places.map(|at| (at.x as i32, at.y as i32)).collect() }
    }

    /// The surfaces with the shadows of the bodies at these times.
    fn shaded_surfaces(&self, moments: &[Moment]) -> Vec<Vec<Surface>> {
        let mut groups = self.surfaces.clone();
        for surface in groups.iter_mut().flatten() {
            let Some(mut shadow) = surface.shadow.take() else { continue };
            for moment in moments {
                let weight = 0.5 * (1.0 - moment.paleness) * (1.0 - moment.paleness);
                let Some(frame) = self.picture.frames.get(moment.frame) else { continue };
                for (body, figure) in self.figures.iter().enumerate() {
                    // what one sees through lets the light through
                    if let Some(pose) =
                        frame.pose(body).filter(|_| !self.picture.bodies[body].is_kinematic)
                    {
                        shadow.cast(surface, self.up, &self.camera, figure, &pose, weight);
                    }
                }
            }
            surface.shadow = Some(shadow);
        }
        groups
    }

    /// The solid layer, one for each see-through time, one for the front of the frame and what
    /// else is thin, one for each group of surfaces.
    fn layers(&self, moments: &[Moment]) -> Vec<Layer> {
        let whole = (self.width as i32, self.height as i32);
        let mut layers = vec![Layer::new((0, 0), whole)];
        for moment in moments.iter().filter(|moment| moment.alpha < 255) {
            let [x0, y0, x1, y1] = self.reach(moment);
            let low = (x0.clamp(0, whole.0), y0.clamp(0, whole.1));
            layers.push(Layer::new(low, (x1.clamp(0, whole.0), y1.clamp(0, whole.1))));
        }
        layers.push(Layer::new((0, 0), whole));
        layers.extend(self.surfaces.iter().map(|_| Layer::new((0, 0), whole)));
        layers
    }

    /// The rectangle of pixels that the bodies at one time can cover.
    fn reach(&self, moment: &Moment) -> [i32; 4] {
        let mut all = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];
        for (body, figure) in self.figures.iter().enumerate() {
            let pose = self.picture.frames[moment.frame].pose(body);
            let Some(one) = pose.and_then(|pose| figure.reach(&pose, &self.camera)) else {
                continue;
            };
            all = [all[0].min(one[0]), all[1].min(one[1]), all[2].max(one[2]), all[3].max(one[3])];
        }
        all
    }

    fn draw_sample(
        &self,
        camera: &Camera,
        moments: &[Moment],
        surfaces: &[Vec<Surface>],
        layers: &mut [Layer],
    ) {
        let light = Light::new(camera, self.up);
        let Some((solid, veils)) = layers.split_first_mut() else { return };
        let ghosts = veils.len().saturating_sub(surfaces.len() + 1);
        let (ghosts, rest) = veils.split_at_mut(ghosts);
        let Some((thin, grounds)) = rest.split_first_mut() else { return };
        for (group, layer) in surfaces.iter().zip(grounds) {
            group.iter().for_each(|surface| surface.draw(camera, layer));
        }
        self.draw_edges(camera, solid, thin);
        self.draw_paths(camera, moments, if self.figures.len() > 8 { thin } else { solid });
        let mut ghosts = ghosts.iter_mut();
        for moment in moments {
            let layer = if moment.alpha < 255 { ghosts.next() } else { Some(&mut *solid) };
            let (Some(layer), Some(frame)) = (layer, self.picture.frames.get(moment.frame)) else {
                continue;
            };
            for (body, figure) in self.figures.iter().enumerate() {
                let Some(pose) = frame.pose(body) else { continue };
                let Moment { paleness, alpha, .. } = *moment;
                if alpha < 255 && self.ends_at(body, figure, &pose) {
                    continue;
                }
                let colour = colour_of(&self.picture, body);
                if !self.picture.bodies[body].is_kinematic {
                    figure.draw(&pose, camera, &light, Paint { colour, paleness, alpha }, layer);
                } else if alpha == 255 {
                    // where it is at last, and so that one sees what is in it
                    let paint = Paint { colour, paleness, alpha: VEIL };
                    figure.draw(&pose, camera, &light, paint, thin);
                }
            }
        }
    }

    /// Whether a body stands at the last moment where it stands here: the one would shine through the other in patches.
    fn ends_at(&self, body: usize, figure: &Figure, pose: &Pose) -> bool {
        let last = self.chosen.last().and_then(|&frame| self.picture.frames[frame].pose(body));
        last.is_some_and(|last| {
            let moved = last.position.distance(pose.position) > 0.1 * figure.spread;
            // the cosine of half an angle of 0.1 rad
            let turned = last.orientation.dot(pose.orientation).abs() < 0.99875;
            !moved && !turned
        })
    }

    /// The smaller the picture, the thinner its lines.
    fn unit(&self) -> f32 {
        (self.width as f32 / 1600.0).min(self.height as f32 / 1000.0).max(0.4)
    }

    fn draw_edges(&self, camera: &Camera, solid: &mut Layer, thin: &mut Layer) {
        let [r, g, b] = FRAME;
        for edge in &self.edges {
            let [start, end] = edge.ends.map(|end| camera.project(end));
            let (Some(mut start), Some(mut end)) = (start, end) else { continue };
            // just in front of the faces that meet in it
            start.nearness *= 1.001;
            end.nearness *= 1.001;
            if edge.front {
                thin.line(start, end, 1.8 * self.unit(), [r, g, b, 90]);
            } else {
                solid.line(start, end, 2.2 * self.unit(), [r, g, b, 255]);
            }
        }
    }

    fn draw_paths(&self, camera: &Camera, moments: &[Moment], layer: &mut Layer) {
        let until = moments.iter().map(|moment| moment.frame).max().unwrap_or(0);
        let most =
            if moments.len() > 1 { usize::MAX } else { MOST_PIECES / self.paths.len().max(1) };
        let (width, alpha) = match self.paths.len() {
            0..=3 => (3.0, 255),
            4..=8 => (2.0, 255),
            9..=40 => (1.5, 140),
            _ => (1.2, 50),
        };
        for (body, path) in self.paths.iter().enumerate() {
            let [r, g, b] = colour_of(&self.picture, body).map(|c| (0.88 * c) as u8);
            let shown = path.partition_point(|(frame, _)| *frame <= until);
            let mut last = None;
            for &(_, point) in &path[shown.saturating_sub(most.max(2))..shown] {
                let at = camera.project(point);
                if let (Some(last), Some(at)) = (last, at) {
                    layer.line(last, at, width * self.unit(), [r, g, b, alpha]);
                }
                last = at;
            }
        }
    }

    /// Lays the see-through layers over the solid one, the farthest first, and adds the colours.
    fn add_up(&self, layers: &[Layer], sums: &mut [[u16; 3]]) {
        let Some((solid, veils)) = layers.split_first() else { return };
        let width = self.width as usize;
        let mut seen: Vec<(f32, [u8; 4])> = Vec::with_capacity(veils.len());
        for (y, row) in (0..).zip(sums.chunks_exact_mut(width)) {
            let part = y as f32 / self.height as f32;
            let background = [252.0, 253.0, 254.0].map(|c| c - 11.0 * part);
            let veils: Vec<&Layer> = veils.iter().filter(|veil| veil.has_row(y)).collect();
            for (x, sum) in (0..).zip(row) {
                let (nearness, [r, g, b, _]) = solid.at(x, y);
                let mut colour = background;
                if nearness > 0.0 {
                    colour = [r, g, b].map(f32::from);
                }
                seen.clear();
                let there = veils.iter().filter(|veil| veil.has_column(x)).map(|v| v.at(x, y));
                seen.extend(there.filter(|(near, _)| *near > nearness));
                if seen.len() > 1 {
                    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
                }
                for (_, [r, g, b, a]) in &seen {
                    let alpha = f32::from(*a) / 255.0;
                    for (below, above) in colour.iter_mut().zip([r, g, b]) {
                        *below += (f32::from(*above) - *below) * alpha;
                    }
                }
                for (sum, c) in sum.iter_mut().zip(colour) {
                    *sum += (c + 0.5) as u16;
                }
            }
        }
    }
}

fn add(sums: &mut [[u16; 3]], more: &[[u16; 3]]) {
    for (sum, more) in sums.iter_mut().flatten().zip(more.iter().flatten()) {
        *sum += more;
    }
}

/// The path of a body's centre of mass, as fine as can be seen.
fn path(picture: &MotionPicture, body: usize, camera: &Camera) -> Path {
    let mut path = Path::new();
    let mut last: Option<(f32, f32)> = None;
    for (index, frame) in picture.frames.iter().enumerate() {
        let Some(pose) = frame.pose(body) else { continue };
        let Some(at) = camera.project(pose.position) else { continue };
        let near = last.is_some_and(|(x, y)| (x - at.x).hypot(y - at.y) < 0.8);
        if !near {
            path.push((index, pose.position));
            last = Some((at.x, at.y));
        }
    }
    path
}

/// Points that the view must hold, and where the bodies are at a few times.
fn landmarks(picture: &MotionPicture, radii: &[f64], up: DVec3) -> (Vec<DVec3>, Vec<DVec3>) {
    let mut points: Vec<DVec3> = picture.boundary.iter().flat_map(surface::corners).collect();
    let mut centres = Vec::new();
    let stride = (picture.frames.len() * radii.len() / 100_000).max(1);
    let sparse = (picture.frames.len() * radii.len() / 300).max(1);
    let last = picture.frames.len().saturating_sub(1);
    for (index, frame) in picture.frames.iter().enumerate() {
        if !index.is_multiple_of(stride) && index != last {
            continue;
        }
        for (body, &radius) in radii.iter().enumerate() {
            let Some(pose) = frame.pose(body) else { continue };
            let (u, v) = up.any_orthonormal_pair();
            let around = [u, -u, v, -v, up, -up];
            points.extend(around.map(|way| pose.position + way * radius));
            if (index * radii.len() + body).is_multiple_of(sparse) {
                centres.push(pose.position);
            }
        }
    }
    (points, centres)
}

/// The view, of a few, in which the motion spreads out the most.
fn best_view(picture: &MotionPicture, radii: &[f64], up: DVec3, view: Viewport) -> Camera {
    let (points, centres) = landmarks(picture, radii, up);
    let cameras =
        YAWS.map(|yaw| Camera::framing(&points, up, View { yaw, pitch: PITCH, zoom: 1.0 }, view));
    let spread = |camera: &Camera| {
        let places: Vec<_> = centres.iter().filter_map(|&c| camera.project(c)).collect();
        let pairs = places.iter().enumerate().flat_map(|(i, a)| {
            places[i + 1..].iter().map(move |b| f64::from((a.x - b.x).hypot(a.y - b.y)))
        });
        pairs.sum::<f64>()
    };
    let spreads = cameras.each_ref().map(spread);
    let mut best = 0;
    for other in 1..cameras.len() {
        // a steady view is worth more than a slightly better one
        if spreads[other] > spreads[best] * 1.12 {
            best = other;
        }
    }
    cameras[best].clone()
}
