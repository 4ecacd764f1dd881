//! Labels of a picture: title, times, names of bodies, axes and grid spacing.

use super::camera::{Camera, Viewport};
use super::colour::{BACKGROUND, picture_colour};
use super::image::Image;
use super::input::{Frame, PictureInput};
use super::snapshots::Snapshot;
use super::text::{Font, SECONDARY_TEXT_COLOUR, TEXT_COLOUR, format_length, format_time};
use glam::DVec3;

/// Fonts and margins, in pixels.
#[derive(Clone, Copy)]
struct Layout {
    text: Font,
    title: Font,
    side: i32,
    top: i32,
    bottom: i32,
}

/// The parts of the picture, in pixels, that time labels should not cover.
#[derive(Debug, Default)]
pub(super) struct LabelObstacles {
    /// Rectangle of the body in each snapshot: left, top, right, bottom.
    pub bodies: Vec<[i32; 4]>,
    /// Points on the path of the body.
    pub path: Vec<(i32, i32)>,
}

/// The layout for a picture of this size. `None` if it is too small for text.
fn layout(width: u32, height: u32) -> Option<Layout> {
    if width < 320 || height < 200 {
        return None;
    }
    let unit = (f64::from(width) / 1600.0).min(f64::from(height) / 1000.0);
    let text = Font::from_height(25.0 * unit, false);
    let title = Font::from_height(36.0 * unit, true);
    let side = (34.0 * unit).max(8.0) as i32;
    let top = side + title.height() + text.height() / 2;
    Some(Layout { text, title, side, top, bottom: side + 2 * text.height() })
}

/// The part of the picture without text around the edges.
pub(super) fn viewport(width: u32, height: u32) -> Viewport {
    let (width_all, height_all) = (f64::from(width), f64::from(height));
    let (side, top, bottom) = match layout(width, height) {
        Some(m) => (f64::from(2 * m.side), f64::from(m.top), f64::from(m.bottom)),
        None => (0.05 * width_all, 0.05 * height_all, 0.05 * height_all),
    };
    let (width, height) = (width_all - 2.0 * side, height_all - top - bottom);
    Viewport { left: side, top, width, height }
}

/// Draws the labels of a picture of the whole motion.
pub(super) fn draw_motion_labels(
    image: &mut Image,
    input: &PictureInput,
    snapshots: &[Snapshot],
    obstacles: &LabelObstacles,
    camera: &Camera,
    grid: Option<f64>,
) {
    let Some(m) = layout(image.width, image.height) else { return };
    let times: Vec<f64> =
        snapshots.iter().map(|snapshot| input.frames[snapshot.frame].time).collect();
    let step = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::MAX, f64::min);
    let labels: Vec<String> = times.iter().map(|&t| format_time(t, step)).collect();
    let title_right = draw_names(image, input, m);
    draw_title(image, input, &format_duration(input, step), m, title_right);
    draw_snapshot_times(image, input, snapshots, &labels, m);
    if input.bodies.len() == 1 && snapshots.len() > 1 {
        draw_time_labels(image, obstacles, &labels, m);
    }
    draw_axes(image, camera, grid, m);
}

/// Draws the labels of a picture of one frame.
pub(super) fn draw_frame_labels(
    image: &mut Image,
    input: &PictureInput,
    frame: usize,
    camera: &Camera,
    grid: Option<f64>,
) {
    let Some(m) = layout(image.width, image.height) else { return };
    let (first, last) = (input.frames.first(), input.frames.last());
    let span = first.zip(last).map_or(0.0, |(a, b)| b.time - a.time);
    let step = span / (input.frames.len().max(2) - 1) as f64;
    let time = input.frames.get(frame).map(|f| format!("t = {}", format_time(f.time, step)));
    let title_right = draw_names(image, input, m);
    draw_title(image, input, "", m, title_right);
    if let Some(time) = time {
        let at = (m.side, image.height as i32 - m.side - m.text.height());
        m.text.draw(image, at, &time, TEXT_COLOUR);
    }
    draw_axes(image, camera, grid, m);
}

fn format_duration(input: &PictureInput, step: f64) -> String {
    let finite = |frame: &&Frame| frame.time.is_finite();
    let first = input.frames.iter().find(finite);
    let last = input.frames.iter().rev().find(finite);
    match first.zip(last) {
        Some((a, b)) if b.time > a.time => {
            format!("duration {}", format_time(b.time - a.time, step))
        }
        _ => String::new(),
    }
}

/// Draws the title and the duration, left of the pixel `right`.
fn draw_title(image: &mut Image, input: &PictureInput, duration: &str, m: Layout, right: i32) {
    let width = right - 2 * m.side - m.text.width(duration);
    let title = m.title.truncate(input.title, width);
    m.title.draw(image, (m.side, m.side), &title, TEXT_COLOUR);
    // the duration shares the baseline of the title
    let baseline_shift = (f64::from(m.title.height() - m.text.height()) * 0.8) as i32;
    let gap = if title.is_empty() { 0 } else { m.title.width(&title) + m.side / 2 };
    m.text.draw(image, (m.side + gap, m.side + baseline_shift), duration, SECONDARY_TEXT_COLOUR);
}

/// Draws the names of the bodies at the upper right. Returns the right limit of the title.
fn draw_names(image: &mut Image, input: &PictureInput, m: Layout) -> i32 {
    let right = image.width as i32 - m.side;
    if !(2..=8).contains(&input.bodies.len()) {
        return right;
    }
    let size = m.text.height() * 3 / 4;
    let max_width = image.width as i32 / 4;
    let names: Vec<String> =
        input.bodies.iter().map(|b| m.text.truncate(b.name, max_width)).collect();
    let widest = names.iter().map(|name| m.text.width(name)).max().unwrap_or(0);
    let left = right - widest - size - size / 2;
    for (body, name) in names.iter().enumerate() {
        let top = m.side + body as i32 * (m.text.height() + size / 3);
        let rgb = picture_colour(input, body).map(|c| c as u8);
        image.fill_rectangle(left, top + (m.text.height() - size) / 2, (size, size), rgb);
        m.text.draw(image, (left + size + size / 2, top), name, TEXT_COLOUR);
    }
    left
}

/// Colours of the first bodies, at most four, in a snapshot.
fn snapshot_colours(input: &PictureInput, snapshot: &Snapshot) -> Vec<[u8; 3]> {
    let blended = |body: usize| {
        let colour = picture_colour(input, body);
        let mix = |c: usize| {
            let faded = colour[c] + (BACKGROUND[c] - colour[c]) * snapshot.fade;
            faded + (BACKGROUND[c] - faded) * (1.0 - f32::from(snapshot.alpha) / 255.0)
        };
        [mix(0) as u8, mix(1) as u8, mix(2) as u8]
    };
    let free = (0..input.bodies.len()).filter(|&body| !input.bodies[body].is_kinematic);
    let mut colours: Vec<_> = free.take(4).map(blended).collect();
    if colours.is_empty() {
        colours.push(blended(0));
    }
    colours
}

/// Draws the times of the snapshots with their colours along the lower edge.
fn draw_snapshot_times(
    image: &mut Image,
    input: &PictureInput,
    snapshots: &[Snapshot],
    labels: &[String],
    m: Layout,
) {
    let size = m.text.height() * 3 / 4;
    let top = image.height as i32 - m.side - m.text.height();
    let mut x = m.side;
    if !snapshots.is_empty() {
        m.text.draw(image, (x, top), "t =", SECONDARY_TEXT_COLOUR);
        x += m.text.width("t = ");
    }
    let widest = labels.iter().map(|label| m.text.width(label)).max().unwrap_or(0);
    let available = image.width as i32 - 2 * m.side - axes_width(m);
    for (i, (snapshot, label)) in snapshots.iter().zip(labels).enumerate() {
        let colours = snapshot_colours(input, snapshot);
        let part = (size / colours.len() as i32).max(size / 2);
        let swatch_width = part * colours.len() as i32;
        // if space is short, keep some for the last time
        let last = i + 1 == snapshots.len();
        if !last && x + 2 * (swatch_width + size / 2 + widest + size) > available {
            continue;
        }
        for (j, colour) in (0..).zip(colours) {
            let at = (x + j * part, top + (m.text.height() - size) / 2);
            image.fill_rectangle(at.0, at.1, (part, size), colour);
        }
        m.text.draw(image, (x + swatch_width + size / 2, top), label, TEXT_COLOUR);
        x += swatch_width + size / 2 + m.text.width(label) + size * 4 / 3;
    }
}

/// Draws the time beside each snapshot of the body, where there is space.
fn draw_time_labels(image: &mut Image, obstacles: &LabelObstacles, labels: &[String], m: Layout) {
    let LabelObstacles { bodies, path } = obstacles;
    let mut labelled: Vec<[i32; 4]> = Vec::new();
    let last = bodies.len().saturating_sub(1);
    for i in [last].into_iter().chain(0..last) {
        let (Some(&[x0, y0, x1, y1]), Some(label)) = (bodies.get(i), labels.get(i)) else {
            continue;
        };
        let (width, height) = (m.text.width(label), m.text.height());
        let (x, y) = ((x0 + x1 - width) / 2, (y0 + y1 - height) / 2);
        let (left, right, top, bottom) = (x0 - 8 - width, x1 + 8, y0 - height - 4, y1 + 4);
        let beside = [(x, top), (right, y), (left, y), (x, bottom)];
        let diagonal = [(right, top), (left, top), (right, bottom), (left, bottom)];
        let rectangle = |(left, top): (i32, i32)| [left, top, left + width, top + height];
        let is_free = |r: &[i32; 4]| {
            let padded = [r[0] - 8, r[1] - 2, r[2] + 8, r[3] + 2];
            r[0] >= m.side
                && r[1] >= m.top
                && r[2] <= image.width as i32 - m.side
                && r[3] <= image.height as i32 - m.bottom
                && !labelled.iter().any(|other| overlap(padded, *other))
        };
        // labels should cover neither bodies nor the path
        let cost = |r: &[i32; 4]| {
            let others = (0..bodies.len()).filter(|&other| other != i);
            let covered = others.filter(|&other| overlap(*r, bodies[other])).count();
            let on_path = |p: &&(i32, i32)| overlap(*r, [p.0 - 3, p.1 - 3, p.0 + 3, p.1 + 3]);
            40 * covered + path.iter().filter(on_path).count()
        };
        let candidates = beside.into_iter().chain(diagonal).map(rectangle).filter(is_free);
        let Some(label_rectangle) = candidates.min_by_key(cost) else { continue };
        m.text.draw_with_outline(
            image,
            (label_rectangle[0], label_rectangle[1]),
            label,
            TEXT_COLOUR,
        );
        labelled.push(label_rectangle);
    }
}

/// Whether two rectangles (left, top, right, bottom) overlap.
fn overlap(a: [i32; 4], b: [i32; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Width of the area of the axes and the grid spacing, in pixels.
fn axes_width(m: Layout) -> i32 {
    m.text.width("grid 0.005 mm") + 4 * m.text.height()
}

/// Draws the world axes and the grid spacing (m) at the lower right.
fn draw_axes(image: &mut Image, camera: &Camera, grid: Option<f64>, m: Layout) {
    let size = 1.6 * m.text.height() as f32;
    let right = image.width as i32 - m.side;
    let bottom = image.height as i32 - m.side;
    let centre = (right as f32 - 1.5 * size, bottom as f32 - 0.9 * size);
    for (axis, name) in [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")] {
        let direction = camera.rotate_to_view(axis).as_vec3();
        let tip = |part: f32| {
            (centre.0 + size * part * direction.x, centre.1 - size * part * direction.y)
        };
        image.draw_line(centre, tip(0.85), (0.045 * size).max(1.2), SECONDARY_TEXT_COLOUR);
        let (x, y) = tip(1.12);
        let at = (x as i32 - m.text.width(name) / 2, y as i32 - m.text.height() / 2);
        m.text.draw(image, at, name, SECONDARY_TEXT_COLOUR);
    }
    if let Some(grid) = grid {
        let label = format!("grid {}", format_length(grid));
        let left = right - (2.8 * size) as i32 - m.text.width(&label);
        m.text.draw(image, (left, bottom - m.text.height()), &label, SECONDARY_TEXT_COLOUR);
    }
}
