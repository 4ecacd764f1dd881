//! Chart of the energy ledger over time: energies, losses, work and residual.

use super::axis::Axis;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// One row of the energy ledger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyRow {
    /// Time (s).
    pub time: f64,
    /// Kinetic energy of translation and rotation (J).
    pub kinetic: f64,
    /// Gravitational potential energy, −M g·x (J).
    pub gravitational: f64,
    /// Elastic energy of the contact springs (J).
    pub elastic: f64,
    /// Cumulative energy lost to drag (J).
    pub drag: f64,
    /// Cumulative energy lost to dashpots (J).
    pub dashpot: f64,
    /// Cumulative energy lost to slip (J).
    pub slip: f64,
    /// Cumulative energy lost by the implicit solution of the contact law (J).
    pub numerical: f64,
    /// Cumulative work done by bodies with prescribed motion, and by loads (J).
    pub work: f64,
    /// Elastic energy of the springs of joints (J).
    pub spring: f64,
    /// Cumulative work done by motors (J).
    pub motor: f64,
    /// Cumulative energy lost to friction, dampers and limits of joints (J).
    pub joint_friction: f64,
    /// Sum of energies and losses minus the work (J). It would be constant without numerical
    /// error.
    pub total: f64,
    /// Deviation of `total` from its initial value (J).
    pub residual: f64,
}

/// Error from drawing a chart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlotError(String);

impl std::fmt::Display for PlotError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "cannot draw the chart: {}", self.0)
    }
}

impl std::error::Error for PlotError {}

fn plot_error(error: impl std::fmt::Display) -> PlotError {
    PlotError(error.to_string())
}

/// Size of the chart in CSS pixels: width, height.
const SIZE: (u32, u32) = (1000, 640);
/// Drawing units per pixel. Coordinates are integers, so this sets the resolution of lines.
const UNITS_PER_PIXEL: u32 = 8;
/// Width of the legend at the right, in pixels.
const LEGEND_WIDTH: u32 = 178;
/// Width of the tick labels at the left, in pixels.
const LABEL_WIDTH: u32 = 84;
/// Long curves are reduced to the minimum and maximum in each of this many intervals.
const INTERVALS: usize = 600;

const TEXT_COLOUR: RGBColor = RGBColor(45, 52, 62);
const GRID_COLOUR: RGBColor = RGBColor(226, 230, 236);

/// A curve of the chart. Colours are safe for colour-blind readers (Okabe and Ito 2008).
struct Series {
    name: &'static str,
    colour: RGBColor,
    value: fn(&EnergyRow) -> f64,
}

const TOTAL: Series = Series { name: "total", colour: RGBColor(0, 0, 0), value: |row| row.total };
const RESIDUAL: Series =
    Series { name: "residual", colour: RGBColor(90, 90, 90), value: |row| row.residual };
const TERMS: [Series; 11] = [
    Series { name: "kinetic", colour: RGBColor(0, 114, 178), value: |row| row.kinetic },
    Series { name: "gravitational", colour: RGBColor(230, 159, 0), value: |row| row.gravitational },
    Series { name: "elastic", colour: RGBColor(0, 158, 115), value: |row| row.elastic },
    Series { name: "lost to drag", colour: RGBColor(86, 180, 233), value: |row| row.drag },
    Series { name: "lost to dashpots", colour: RGBColor(204, 121, 167), value: |row| row.dashpot },
    Series { name: "lost to slip", colour: RGBColor(213, 94, 0), value: |row| row.slip },
    Series { name: "numerical", colour: RGBColor(120, 94, 240), value: |row| row.numerical },
    // olive, distinct from the others
    Series { name: "work put in", colour: RGBColor(140, 130, 30), value: |row| row.work },
    Series { name: "joint springs", colour: RGBColor(110, 200, 90), value: |row| row.spring },
    Series { name: "motors", colour: RGBColor(170, 60, 60), value: |row| row.motor },
    Series {
        name: "lost in joints",
        colour: RGBColor(150, 110, 80),
        value: |row| row.joint_friction,
    },
];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws the energy ledger as an SVG chart, with the energies in the upper panel and the residual in the lower.
///
/// Terms that are always zero and values that are not finite are not drawn.
///
/// # Errors
/// [`PlotError`] if the plotting library fails. No input is known to cause this.
pub fn energy_svg(title: &str, rows: &[EnergyRow]) -> Result<String, PlotError> {
    let mut svg = String::new();
    {
        let (width, height) = (SIZE.0 * UNITS_PER_PIXEL, SIZE.1 * UNITS_PER_PIXEL);
        let root = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
        root.fill(&WHITE).map_err(plot_error)?;
        let (header, body) = root.split_vertically(46 * UNITS_PER_PIXEL);
        draw_title(&header, title)?;
        let (upper, lower) = body.split_vertically(390 * UNITS_PER_PIXEL);
        let visible = visible_series(rows);
        let time = Axis::from_values(rows.iter().map(|row| row.time), 0.0);
        draw_panel(&upper, rows, time, &visible, "energy (J)")?;
        draw_panel(&lower, rows, time, &[&RESIDUAL], "residual (J)")?;
        root.present().map_err(plot_error)?;
    }
    // set the displayed size to pixels; the view box keeps the finer drawing units
    let drawn_size =
        format!("width=\"{}\" height=\"{}\"", SIZE.0 * UNITS_PER_PIXEL, SIZE.1 * UNITS_PER_PIXEL);
    let displayed_size = format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1);
    Ok(svg.replacen(&drawn_size, &displayed_size, 1))
}

/// The terms that are not always zero, and the total.
fn visible_series(rows: &[EnergyRow]) -> Vec<&'static Series> {
    let terms = TERMS.iter().filter(|term| rows.iter().any(|row| (term.value)(row) != 0.0));
    terms.chain([&TOTAL]).collect()
}

fn font(size: u32) -> TextStyle<'static> {
    ("sans-serif", size * UNITS_PER_PIXEL).into_font().color(&TEXT_COLOUR)
}

fn draw_title(header: &Area, title: &str) -> Result<(), PlotError> {
    // XML does not allow these characters
    let allowed = |c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    let title: String = title.chars().filter(allowed).take(90).collect();
    let at = (((LABEL_WIDTH + 12) * UNITS_PER_PIXEL) as i32, (24 * UNITS_PER_PIXEL) as i32);
    let style = font(24).pos(Pos::new(HPos::Left, VPos::Center));
    header.draw(&Text::new(title, at, style)).map_err(plot_error)
}

fn draw_panel(
    area: &Area,
    rows: &[EnergyRow],
    time: Axis,
    visible: &[&Series],
    name: &str,
) -> Result<(), PlotError> {
    let (width, _) = area.dim_in_pixel();
    let (plot, legend) = area.split_horizontally(width - LEGEND_WIDTH * UNITS_PER_PIXEL);
    let values = rows.iter().flat_map(|row| visible.iter().map(|series| (series.value)(row)));
    let axis = Axis::from_values(values, 0.05);
    let is_residual = visible.iter().any(|series| series.name == RESIDUAL.name);
    let label =
        |tick: &f64| if is_residual { axis.scientific_label(*tick) } else { axis.label(*tick) };
    let mut chart = ChartBuilder::on(&plot)
        .margin_top(8 * UNITS_PER_PIXEL)
        .margin_left(12 * UNITS_PER_PIXEL)
        .margin_bottom(if is_residual { 8 * UNITS_PER_PIXEL } else { 0 })
        .margin_right(14 * UNITS_PER_PIXEL)
        .set_label_area_size(LabelAreaPosition::Left, LABEL_WIDTH * UNITS_PER_PIXEL)
        .set_label_area_size(
            LabelAreaPosition::Bottom,
            if is_residual { 44 } else { 26 } * UNITS_PER_PIXEL,
        )
        .build_cartesian_2d(time.low..time.high, axis.low..axis.high)
        .map_err(plot_error)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID_COLOUR.stroke_width(UNITS_PER_PIXEL))
        .axis_style(RGBColor(120, 128, 140).stroke_width(UNITS_PER_PIXEL))
        .set_all_tick_mark_size(4 * UNITS_PER_PIXEL)
        .x_labels(10)
        .y_labels(if is_residual { 5 } else { 9 })
        .x_label_formatter(&|tick| time.label(*tick))
        .y_label_formatter(&label)
        .x_desc(if is_residual { "time (s)" } else { "" })
        .y_desc(name)
        .label_style(font(13))
        .axis_desc_style(font(14))
        .draw()
        .map_err(plot_error)?;
    for series in visible {
        let points = downsample(rows, series, time, axis);
        let width = if series.name == TOTAL.name { 5 } else { 4 } * UNITS_PER_PIXEL / 2;
        let style = series.colour.stroke_width(width);
        if let [point] = points[..] {
            let dot = Circle::new(point, 4 * UNITS_PER_PIXEL, series.colour.filled());
            chart.draw_series([dot]).map_err(plot_error)?;
        } else {
            chart.draw_series(LineSeries::new(points, style)).map_err(plot_error)?;
        }
    }
    draw_legend(&legend, visible)
}

/// Draws the names of the curves to the right of the chart.
fn draw_legend(area: &Area, visible: &[&Series]) -> Result<(), PlotError> {
    let scale = UNITS_PER_PIXEL as i32;
    for (row, series) in (0..).zip(visible) {
        let y = (24 + 24 * row) * scale;
        let mark = vec![(4 * scale, y), (28 * scale, y)];
        let stroke = series.colour.stroke_width(3 * UNITS_PER_PIXEL);
        area.draw(&PathElement::new(mark, stroke)).map_err(plot_error)?;
        let style = font(14).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(series.name, (36 * scale, y), style)).map_err(plot_error)?;
    }
    Ok(())
}

/// The points of a curve in units of the axes: all, or the minimum and maximum in each interval if there are many.
fn downsample(rows: &[EnergyRow], series: &Series, time: Axis, axis: Axis) -> Vec<(f64, f64)> {
    let point =
        |row: &EnergyRow| Some((time.to_units(row.time)?, axis.to_units((series.value)(row))?));
    let points: Vec<(f64, f64)> = rows.iter().filter_map(point).collect();
    if points.len() <= 2 * INTERVALS {
        return points;
    }
    let mut reduced = Vec::with_capacity(2 * INTERVALS + 2);
    reduced.extend(points.first());
    for interval in points.chunks(points.len().div_ceil(INTERVALS)) {
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let extremes = interval.iter().min_by(by_value).zip(interval.iter().max_by(by_value));
        let Some((&min, &max)) = extremes else { continue };
        reduced.extend(if min.0 <= max.0 { [min, max] } else { [max, min] });
    }
    reduced.extend(points.last());
    reduced
}
