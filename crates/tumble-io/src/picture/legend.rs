//! Title, times, names and directions: all that is written on a picture.

use super::camera::{Camera, Viewport};
use super::compose::{Moment, colour_of};
use super::figure::PAPER;
use super::image::Image;
use super::text::{FAINT, Font, INK, length, time};
use super::{Frame, MotionPicture};
use glam::DVec3;

/// Room for words, in pixels; none in pictures that are too small for any.
#[derive(Clone, Copy)]
struct Margins {
    text: Font,
    title: Font,
    side: i32,
    top: i32,
    bottom: i32,
}

/// Where the only body of a picture is, in pixels: what words should not cover.
#[derive(Debug, Default)]
pub(super) struct Trail {
    /// The rectangle of the body at each time.
    pub outlines: Vec<[i32; 4]>,
    /// Points on its path.
    pub path: Vec<(i32, i32)>,
}

fn margins(width: u32, height: u32) -> Option<Margins> {
    if width < 320 || height < 200 {
        return None;
    }
    let unit = (f64::from(width) / 1600.0).min(f64::from(height) / 1000.0);
    let text = Font::fitting(25.0 * unit, false);
    let title = Font::fitting(36.0 * unit, true);
    let side = (34.0 * unit).max(8.0) as i32;
    let top = side + title.height() + text.height() / 2;
    Some(Margins { text, title, side, top, bottom: side + 2 * text.height() })
}

/// The part of the picture that is free of words.
pub(super) fn viewport(width: u32, height: u32) -> Viewport {
    let (width_all, height_all) = (f64::from(width), f64::from(height));
    let (side, top, bottom) = match margins(width, height) {
        Some(m) => (f64::from(2 * m.side), f64::from(m.top), f64::from(m.bottom)),
        None => (0.05 * width_all, 0.05 * height_all, 0.05 * height_all),
    };
    let (width, height) = (width_all - 2.0 * side, height_all - top - bottom);
    Viewport { left: side, top, width, height }
}

/// The words of a picture of the whole motion.
pub(super) fn motion(
    image: &mut Image,
    picture: &MotionPicture,
    moments: &[Moment],
    trail: &Trail,
    camera: &Camera,
    grid: Option<f64>,
) {
    let Some(m) = margins(image.width, image.height) else { return };
    let times: Vec<f64> = moments.iter().map(|moment| picture.frames[moment.frame].time).collect();
    let step = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::MAX, f64::min);
    let labels: Vec<String> = times.iter().map(|&t| time(t, step)).collect();
    let names_left = names(image, picture, m);
    title(image, picture, &duration(picture, step), m, names_left);
    swatches(image, picture, moments, &labels, m);
    if picture.bodies.len() == 1 && moments.len() > 1 {
        time_marks(image, trail, &labels, m);
    }
    signs(image, camera, grid, m);
}

/// The words of a picture of one frame.
pub(super) fn frame(
    image: &mut Image,
    picture: &MotionPicture,
    frame: usize,
    camera: &Camera,
    grid: Option<f64>,
) {
    let Some(m) = margins(image.width, image.height) else { return };
    let (first, last) = (picture.frames.first(), picture.frames.last());
    let span = first.zip(last).map_or(0.0, |(a, b)| b.time - a.time);
    let step = span / (picture.frames.len().max(2) - 1) as f64;
    let now = picture.frames.get(frame).map(|f| format!("t = {}", time(f.time, step)));
    let names_left = names(image, picture, m);
    title(image, picture, "", m, names_left);
    if let Some(now) = now {
        let at = (m.side, image.height as i32 - m.side - m.text.height());
        m.text.write(image, at, &now, INK);
    }
    signs(image, camera, grid, m);
}

fn duration(picture: &MotionPicture, step: f64) -> String {
    let finite = |frame: &&Frame| frame.time.is_finite();
    let first = picture.frames.iter().find(finite);
    let last = picture.frames.iter().rev().find(finite);
    match first.zip(last) {
        Some((a, b)) if b.time > a.time => format!("duration {}", time(b.time - a.time, step)),
        _ => String::new(),
    }
}

fn title(image: &mut Image, picture: &MotionPicture, duration: &str, m: Margins, right: i32) {
    let room = right - 2 * m.side - m.text.width(duration);
    let title = m.title.fit(picture.title, room);
    m.title.write(image, (m.side, m.side), &title, INK);
    // the duration stands on the same line of writing
    let drop = (f64::from(m.title.height() - m.text.height()) * 0.8) as i32;
    let gap = if title.is_empty() { 0 } else { m.title.width(&title) + m.side / 2 };
    m.text.write(image, (m.side + gap, m.side + drop), duration, FAINT);
}

/// The names of the bodies at the upper right; returns how far the title may go.
fn names(image: &mut Image, picture: &MotionPicture, m: Margins) -> i32 {
    let right = image.width as i32 - m.side;
    if !(2..=8).contains(&picture.bodies.len()) {
        return right;
    }
    let size = m.text.height() * 3 / 4;
    let most = image.width as i32 / 4;
    let names: Vec<String> = picture.bodies.iter().map(|b| m.text.fit(b.name, most)).collect();
    let widest = names.iter().map(|name| m.text.width(name)).max().unwrap_or(0);
    let left = right - widest - size - size / 2;
    for (body, name) in names.iter().enumerate() {
        let top = m.side + body as i32 * (m.text.height() + size / 3);
        let rgb = colour_of(picture, body).map(|c| c as u8);
        image.fill(left, top + (m.text.height() - size) / 2, (size, size), rgb);
        m.text.write(image, (left + size + size / 2, top), name, INK);
    }
    left
}

/// The colour of a time: of the body if there is one, of the first few side by side if not.
fn time_colours(picture: &MotionPicture, moment: &Moment) -> Vec<[u8; 3]> {
    let pale = |body: usize| {
        let full = colour_of(picture, body);
        let mix = |c: usize| {
            let paled = full[c] + (PAPER[c] - full[c]) * moment.paleness;
            paled + (PAPER[c] - paled) * (1.0 - f32::from(moment.alpha) / 255.0)
        };
        [mix(0) as u8, mix(1) as u8, mix(2) as u8]
    };
    let free = (0..picture.bodies.len()).filter(|&body| !picture.bodies[body].is_kinematic);
    let mut shown: Vec<_> = free.take(4).map(pale).collect();
    if shown.is_empty() {
        shown.push(pale(0));
    }
    shown
}

/// A row of times along the lower edge.
fn swatches(
    image: &mut Image,
    picture: &MotionPicture,
    moments: &[Moment],
    labels: &[String],
    m: Margins,
) {
    let size = m.text.height() * 3 / 4;
    let top = image.height as i32 - m.side - m.text.height();
    let mut x = m.side;
    if !moments.is_empty() {
        m.text.write(image, (x, top), "t =", FAINT);
        x += m.text.width("t = ");
    }
    let widest = labels.iter().map(|label| m.text.width(label)).max().unwrap_or(0);
    let room = image.width as i32 - 2 * m.side - sign_width(m);
    for (i, (moment, label)) in moments.iter().zip(labels).enumerate() {
        let colours = time_colours(picture, moment);
        let part = (size / colours.len() as i32).max(size / 2);
        let wide = part * colours.len() as i32;
        // where not all fit, the last one is worth more than the rest
        let last = i + 1 == moments.len();
        if !last && x + 2 * (wide + size / 2 + widest + size) > room {
            continue;
        }
        for (j, colour) in (0..).zip(colours) {
            let at = (x + j * part, top + (m.text.height() - size) / 2);
            image.fill(at.0, at.1, (part, size), colour);
        }
        m.text.write(image, (x + wide + size / 2, top), label, INK);
        x += wide + size / 2 + m.text.width(label) + size * 4 / 3;
    }
}

/// Times beside the bodies, where there is room between them.
fn time_marks(image: &mut Image, trail: &Trail, labels: &[String], m: Margins) {
    let Trail { outlines, path } = trail;
    let mut taken: Vec<[i32; 4]> = Vec::new();
    let last = outlines.len().saturating_sub(1);
    for i in [last].into_iter().chain(0..last) {
        let (Some(&[x0, y0, x1, y1]), Some(label)) = (outlines.get(i), labels.get(i)) else {
            continue;
        };
        let (width, height) = (m.text.width(label), m.text.height());
        let (x, y) = ((x0 + x1 - width) / 2, (y0 + y1 - height) / 2);
        let (left, right, top, bottom) = (x0 - 8 - width, x1 + 8, y0 - height - 4, y1 + 4);
        let places = [(x, top), (right, y), (left, y), (x, bottom)];
        let corners = [(right, top), (left, top), (right, bottom), (left, bottom)];
        let frame = |(left, top): (i32, i32)| [left, top, left + width, top + height];
        let usable = |own: &[i32; 4]| {
            let wide = [own[0] - 8, own[1] - 2, own[2] + 8, own[3] + 2];
            own[0] >= m.side
                && own[1] >= m.top
                && own[2] <= image.width as i32 - m.side
                && own[3] <= image.height as i32 - m.bottom
                && !taken.iter().any(|other| overlap(wide, *other))
        };
        // best beside all bodies and off the path; never over other words
        let hidden = |own: &[i32; 4]| {
            let others = (0..outlines.len()).filter(|&other| other != i);
            let bodies = others.filter(|&other| overlap(*own, outlines[other])).count();
            let on_path = |p: &&(i32, i32)| overlap(*own, [p.0 - 3, p.1 - 3, p.0 + 3, p.1 + 3]);
            40 * bodies + path.iter().filter(on_path).count()
        };
        let all = places.into_iter().chain(corners).map(frame).filter(usable);
        let Some(own) = all.min_by_key(hidden) else { continue };
        m.text.write_with_halo(image, (own[0], own[1]), label, INK);
        taken.push(own);
    }
}

fn overlap(a: [i32; 4], b: [i32; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

fn sign_width(m: Margins) -> i32 {
    m.text.width("grid 0.005 mm") + 4 * m.text.height()
}

/// At the lower right: the directions of the world, and the distance of the lines on the floor.
fn signs(image: &mut Image, camera: &Camera, grid: Option<f64>, m: Margins) {
    let size = 1.6 * m.text.height() as f32;
    let right = image.width as i32 - m.side;
    let bottom = image.height as i32 - m.side;
    let centre = (right as f32 - 1.5 * size, bottom as f32 - 0.9 * size);
    for (axis, name) in [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")] {
        let seen = camera.turn(axis).as_vec3();
        let tip = |part: f32| (centre.0 + size * part * seen.x, centre.1 - size * part * seen.y);
        image.line(centre, tip(0.85), (0.045 * size).max(1.2), FAINT);
        let (x, y) = tip(1.12);
        let at = (x as i32 - m.text.width(name) / 2, y as i32 - m.text.height() / 2);
        m.text.write(image, at, name, FAINT);
    }
    if let Some(grid) = grid {
        let label = format!("grid {}", length(grid));
        let left = right - (2.8 * size) as i32 - m.text.width(&label);
        m.text.write(image, (left, bottom - m.text.height()), &label, FAINT);
    }
}
