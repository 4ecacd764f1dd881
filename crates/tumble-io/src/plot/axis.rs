//! Axis ranges and tick labels for numbers of any magnitude.

/// An axis in units of a power of ten, so that the plotting library only handles numbers near one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    /// Power of ten by which values are divided.
    pub unit: f64,
    /// Lower end of the axis, in units.
    pub low: f64,
    /// Upper end of the axis, in units.
    pub high: f64,
}

/// Upper bound on magnitudes that are drawn. It keeps differences finite.
const MAX_MAGNITUDE: f64 = 1e250;

impl Axis {
    /// An axis that contains all finite values. `margin` is the fraction of the range added at each end.
    pub fn from_values(values: impl Iterator<Item = f64>, margin: f64) -> Self {
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for value in values.filter(|value| value.abs() < MAX_MAGNITUDE) {
            low = low.min(value);
            high = high.max(value);
        }
        if low > high {
            (low, high) = (0.0, 0.0);
        }
        let magnitude = low.abs().max(high.abs());
        let unit =
            if magnitude > 1e-250 { 10f64.powi(magnitude.log10().floor() as i32) } else { 1.0 };
        let (low, high) = (low / unit, high / unit);
        // constants, and values that differ only by rounding, get an axis centred on them
        let min_span = if magnitude > 1e-250 { 1e-9 } else { 2.0 };
        let span = high - low;
        if span < min_span {
            let centre = 0.5 * (low + high);
            let half = if magnitude > 1e-250 { 0.1 * centre.abs() } else { 1.0 };
            return Self { unit, low: centre - half, high: centre + half };
        }
        Self { unit, low: low - margin * span, high: high + margin * span }
    }

    /// A value in units of the axis, or `None` if it cannot be drawn.
    pub fn to_units(self, value: f64) -> Option<f64> {
        (value.abs() < MAX_MAGNITUDE).then_some(value / self.unit)
    }

    /// The label of a tick (in units), in decimal notation if that is short.
    pub fn label(&self, tick: f64) -> String {
        let magnitude = self.low.abs().max(self.high.abs()) * self.unit;
        if !(1e-2..1e5).contains(&magnitude) {
            return self.scientific_label(tick);
        }
        // ticks are at least 1/15 of the axis apart
        let step = (self.high - self.low) * self.unit / 15.0;
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        trim_zeros(&format!("{:.*}", decimals, tick * self.unit))
    }

    /// The label of a tick (in units) in scientific notation, such as 1.5e-12.
    pub fn scientific_label(&self, tick: f64) -> String {
        let span = self.high - self.low;
        if tick.abs() < 1e-6 * span {
            return "0".to_owned();
        }
        let digits = (tick.abs() / (span / 15.0)).log10().ceil().clamp(1.0, 9.0) as usize;
        let text = format!("{:.*e}", digits, tick * self.unit);
        match text.split_once('e') {
            Some((mantissa, "0")) => trim_zeros(mantissa),
            Some((mantissa, exponent)) => format!("{}e{exponent}", trim_zeros(mantissa)),
            None => text,
        }
    }
}

/// Removes trailing zeros of a decimal number.
fn trim_zeros(number: &str) -> String {
    let trimmed = match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.'),
        false => number,
    };
    if trimmed == "-0" { "0".to_owned() } else { trimmed.to_owned() }
}
