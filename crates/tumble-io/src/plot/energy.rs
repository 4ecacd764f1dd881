//! The energy ledger over time: where the energy is, where it went, and what is left unexplained.

use super::axis::Axis;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// One row of the ledger, all but the time in J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyRow {
    /// Time (s).
    pub time: f64,
    /// Kinetic energy, of translation and rotation (J).
    pub kinetic: f64,
    /// Gravitational energy, −M g·x (J).
    pub gravitational: f64,
    /// Energy in contact springs (J).
    pub elastic: f64,
    /// Lost to drag so far (J).
    pub drag: f64,
    /// Lost to dashpots so far (J).
    pub dashpot: f64,
    /// Lost to slip so far (J).
    pub slip: f64,
    /// Put in so far by bodies whose motion is prescribed (J).
    pub work: f64,
    /// The sum that should stay constant, less the work (J).
    pub total: f64,
    /// What the sum is off by (J).
    pub residual: f64,
}

/// Why a chart could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlotError(String);

impl std::fmt::Display for PlotError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the chart cannot be drawn: {}", self.0)
    }
}

impl std::error::Error for PlotError {}

fn failed(error: impl std::fmt::Display) -> PlotError {
    PlotError(error.to_string())
}

/// The size of the chart in CSS pixels.
const SIZE: (u32, u32) = (1000, 640);
/// Lines are drawn on whole points: so many of them make a pixel.
const FINE: u32 = 8;
/// Room for the legend at the right, in pixels.
const LEGEND: u32 = 178;
/// Room for the numbers at the left, in pixels.
const NUMBERS: u32 = 84;
/// Each line keeps the least and the greatest value of so many spans of time.
const SPANS: usize = 600;

const INK: RGBColor = RGBColor(45, 52, 62);
const GRID: RGBColor = RGBColor(226, 230, 236);

/// A line of the chart: colours that the colour-blind can tell apart (Okabe and Ito 2008).
struct Series {
    name: &'static str,
    colour: RGBColor,
    value: fn(&EnergyRow) -> f64,
}

const TOTAL: Series = Series { name: "total", colour: RGBColor(0, 0, 0), value: |row| row.total };
const RESIDUAL: Series =
    Series { name: "residual", colour: RGBColor(90, 90, 90), value: |row| row.residual };
const PARTS: [Series; 7] = [
    Series { name: "kinetic", colour: RGBColor(0, 114, 178), value: |row| row.kinetic },
    Series { name: "gravitational", colour: RGBColor(230, 159, 0), value: |row| row.gravitational },
    Series { name: "elastic", colour: RGBColor(0, 158, 115), value: |row| row.elastic },
    Series { name: "lost to drag", colour: RGBColor(86, 180, 233), value: |row| row.drag },
    Series { name: "lost to dashpots", colour: RGBColor(204, 121, 167), value: |row| row.dashpot },
    Series { name: "lost to slip", colour: RGBColor(213, 94, 0), value: |row| row.slip },
    // olive, apart from the six others
    Series { name: "work put in", colour: RGBColor(140, 130, 30), value: |row| row.work },
];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The ledger as an SVG picture: the energies above, the residual on its own scale below.
///
/// Parts that are zero throughout are left out, and so are values that are not finite.
///
/// # Errors
/// [`PlotError`] when the drawing library fails; no data are known to make it fail.
pub fn energy_svg(title: &str, rows: &[EnergyRow]) -> Result<String, PlotError> {
    let mut svg = String::new();
    {
        let (width, height) = (SIZE.0 * FINE, SIZE.1 * FINE);
        let root = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (head, body) = root.split_vertically(46 * FINE);
        write_title(&head, title)?;
        let (upper, lower) = body.split_vertically(390 * FINE);
        let shown = shown(rows);
        let time = Axis::holding(rows.iter().map(|row| row.time), 0.0);
        panel(&upper, rows, time, &shown, "energy (J)")?;
        panel(&lower, rows, time, &[&RESIDUAL], "residual (J)")?;
        root.present().map_err(failed)?;
    }
    // the picture is as large as its pixels say, and as fine as its points
    let fine = format!("width=\"{}\" height=\"{}\"", SIZE.0 * FINE, SIZE.1 * FINE);
    let size = format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1);
    Ok(svg.replacen(&fine, &size, 1))
}

/// The parts that are not zero throughout, and the total.
fn shown(rows: &[EnergyRow]) -> Vec<&'static Series> {
    let parts = PARTS.iter().filter(|part| rows.iter().any(|row| (part.value)(row) != 0.0));
    parts.chain([&TOTAL]).collect()
}

fn font(size: u32) -> TextStyle<'static> {
    ("sans-serif", size * FINE).into_font().color(&INK)
}

fn write_title(head: &Area, title: &str) -> Result<(), PlotError> {
    // letters that XML does not allow would make the file unreadable
    let allowed = |c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    let title: String = title.chars().filter(allowed).take(90).collect();
    let at = (((NUMBERS + 12) * FINE) as i32, (24 * FINE) as i32);
    let style = font(24).pos(Pos::new(HPos::Left, VPos::Center));
    head.draw(&Text::new(title, at, style)).map_err(failed)
}

fn panel(
    area: &Area,
    rows: &[EnergyRow],
    time: Axis,
    shown: &[&Series],
    name: &str,
) -> Result<(), PlotError> {
    let (width, _) = area.dim_in_pixel();
    let (plot, legend) = area.split_horizontally(width - LEGEND * FINE);
    let values = rows.iter().flat_map(|row| shown.iter().map(|series| (series.value)(row)));
    let axis = Axis::holding(values, 0.05);
    let is_residual = shown.iter().any(|series| series.name == RESIDUAL.name);
    let label = |tick: &f64| if is_residual { axis.scientific(*tick) } else { axis.label(*tick) };
    let mut chart = ChartBuilder::on(&plot)
        .margin_top(8 * FINE)
        .margin_left(12 * FINE)
        .margin_bottom(if is_residual { 8 * FINE } else { 0 })
        .margin_right(14 * FINE)
        .set_label_area_size(LabelAreaPosition::Left, NUMBERS * FINE)
        .set_label_area_size(LabelAreaPosition::Bottom, if is_residual { 44 } else { 26 } * FINE)
        .build_cartesian_2d(time.low..time.high, axis.low..axis.high)
        .map_err(failed)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID.stroke_width(FINE))
        .axis_style(RGBColor(120, 128, 140).stroke_width(FINE))
        .set_all_tick_mark_size(4 * FINE)
        .x_labels(10)
        .y_labels(if is_residual { 5 } else { 9 })
        .x_label_formatter(&|tick| time.label(*tick))
        .y_label_formatter(&label)
        .x_desc(if is_residual { "time (s)" } else { "" })
        .y_desc(name)
        .label_style(font(13))
        .axis_desc_style(font(14))
        .draw()
        .map_err(failed)?;
    for series in shown {
        let points = thin_out(rows, series, time, axis);
        let width = if series.name == TOTAL.name { 5 } else { 4 } * FINE / 2;
        let style = series.colour.stroke_width(width);
        if let [point] = points[..] {
            let dot = Circle::new(point, 4 * FINE, series.colour.filled());
            chart.draw_series([dot]).map_err(failed)?;
        } else {
            chart.draw_series(LineSeries::new(points, style)).map_err(failed)?;
        }
    }
    write_legend(&legend, shown)
}

/// Beside the curves, never over them.
fn write_legend(area: &Area, shown: &[&Series]) -> Result<(), PlotError> {
    let fine = FINE as i32;
    for (line, series) in (0..).zip(shown) {
        let y = (24 + 24 * line) * fine;
        let mark = vec![(4 * fine, y), (28 * fine, y)];
        let stroke = series.colour.stroke_width(3 * FINE);
        area.draw(&PathElement::new(mark, stroke)).map_err(failed)?;
        let style = font(14).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(series.name, (36 * fine, y), style)).map_err(failed)?;
    }
    Ok(())
}

/// The points of a line: all of them, or the least and the greatest of each of many spans.
fn thin_out(rows: &[EnergyRow], series: &Series, time: Axis, axis: Axis) -> Vec<(f64, f64)> {
    let point = |row: &EnergyRow| Some((time.place(row.time)?, axis.place((series.value)(row))?));
    let points: Vec<(f64, f64)> = rows.iter().filter_map(point).collect();
    if points.len() <= 2 * SPANS {
        return points;
    }
    let mut kept = Vec::with_capacity(2 * SPANS + 2);
    kept.extend(points.first());
    for span in points.chunks(points.len().div_ceil(SPANS)) {
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let ends = span.iter().min_by(by_value).zip(span.iter().max_by(by_value));
        let Some((&least, &most)) = ends else { continue };
        kept.extend(if least.0 <= most.0 { [least, most] } else { [most, least] });
    }
    kept.extend(points.last());
    kept
}
