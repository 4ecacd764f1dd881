//! Ranges and tick labels for numbers of any magnitude.

/// An axis whose numbers are drawn in units of a power of ten, so that the chart itself only ever
/// meets numbers near one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    /// Values are divided by this.
    pub unit: f64,
    /// The ends of the axis, in units.
    pub low: f64,
    pub high: f64,
}

/// Numbers beyond this are left out: their differences must stay finite.
pub(super) const REACH: f64 = 1e250;

impl Axis {
    /// An axis that holds all values that are finite; `margin` is the part left free at each end.
    pub fn holding(values: impl Iterator<Item = f64>, margin: f64) -> Self {
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for value in values.filter(|value| value.abs() < REACH) {
            low = low.min(value);
            high = high.max(value);
        }
        if low > high {
            (low, high) = (0.0, 0.0);
        }
        let most = low.abs().max(high.abs());
        let unit = if most > 1e-250 { 10f64.powi(most.log10().floor() as i32) } else { 1.0 };
        let (low, high) = (low / unit, high / unit);
        // a constant gets an axis around it, noise in the last digits is shown as constant
        let least = if most > 1e-250 { 1e-9 } else { 2.0 };
        let span = high - low;
        if span < least {
            let middle = 0.5 * (low + high);
            let half = if most > 1e-250 { 0.1 * middle.abs() } else { 1.0 };
            return Self { unit, low: middle - half, high: middle + half };
        }
        Self { unit, low: low - margin * span, high: high + margin * span }
    }

    /// A value in units of the axis, if it can be drawn.
    pub fn place(&self, value: f64) -> Option<f64> {
        (value.abs() < REACH).then_some(value / self.unit)
    }

    /// The label of a tick (in units): as a decimal number where that is short.
    pub fn label(&self, tick: f64) -> String {
        let most = self.low.abs().max(self.high.abs()) * self.unit;
        if !(1e-2..1e5).contains(&most) {
            return self.scientific(tick);
        }
        // two ticks are at least a fifteenth of the axis apart
        let step = (self.high - self.low) * self.unit / 15.0;
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        trimmed(&format!("{:.*}", decimals, tick * self.unit))
    }

    /// The label of a tick (in units) as 1.5e-12.
    pub fn scientific(&self, tick: f64) -> String {
        let span = self.high - self.low;
        if tick.abs() < 1e-6 * span {
            return "0".to_owned();
        }
        let digits = (tick.abs() / (span / 15.0)).log10().ceil().clamp(1.0, 9.0) as usize;
        let text = format!("{:.*e}", digits, tick * self.unit);
        match text.split_once('e') {
            Some((mantissa, "0")) => trimmed(mantissa),
            Some((mantissa, exponent)) => format!("{}e{exponent}", trimmed(mantissa)),
            None => text,
        }
    }
}

/// A decimal number without zeros that say nothing.
fn trimmed(number: &str) -> String {
    let short = match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.'),
        false => number,
    };
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}
