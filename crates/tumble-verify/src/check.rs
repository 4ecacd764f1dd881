//! What a case is, and how its numbers are judged.

use std::fmt;

/// Any error that keeps a case from running.
pub(crate) type Error = Box<dyn std::error::Error>;

/// The checks of a case, or the error that kept it from running.
pub type Outcome = Result<Vec<Check>, Error>;

/// A case: one physical effect with a known answer.
#[derive(Clone, Copy)]
pub struct Case {
    /// The name, as `tumble verify NAME` takes it.
    pub name: &'static str,
    /// What is simulated, and where the expected values come from.
    pub description: &'static str,
    /// Runs the case.
    pub run: fn() -> Outcome,
    /// Whether the case takes more than a few seconds without optimisation.
    pub slow: bool,
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Case").field("name", &self.name).finish()
    }
}

/// One measured number and the value that theory predicts.
#[derive(Clone, Debug)]
pub struct Check {
    /// What is measured, and with which settings.
    pub quantity: String,
    /// The value that theory predicts.
    pub expected: f64,
    /// The value of the simulation.
    pub measured: f64,
    /// The largest allowed absolute difference of the two.
    pub bound: f64,
    /// The unit of `expected`, `measured` and `bound`; empty for a dimensionless number.
    pub unit: &'static str,
    /// Further information, such as the number of force evaluations; may be empty.
    pub remark: String,
}

impl Check {
    /// A check that `measured` is within `bound` of `expected`, all in `unit`.
    pub fn new(
        quantity: impl Into<String>,
        expected: f64,
        measured: f64,
        bound: f64,
        unit: &'static str,
    ) -> Self {
        let quantity = quantity.into();
        Self { quantity, expected, measured, bound, unit, remark: String::new() }
    }

    /// A check that an error is at most `bound` in absolute value, both in `unit`.
    pub fn error(
        quantity: impl Into<String>,
        measured: f64,
        bound: f64,
        unit: &'static str,
    ) -> Self {
        Self::new(quantity, 0.0, measured, bound, unit)
    }

    /// Sets the remark.
    pub fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remark = remark.into();
        self
    }

    /// Whether the measured value is within its bound; false for NaN.
    pub fn passed(&self) -> bool {
        (self.measured - self.expected).abs() <= self.bound
    }
}
