//! What a case is, and how it is judged.

use std::fmt;

/// Something that went wrong instead of being measured.
pub type Outcome = Result<Vec<Check>, Box<dyn std::error::Error>>;

/// A case: one piece of physics with a known answer.
#[derive(Clone, Copy)]
pub struct Case {
    /// Its name.
    pub name: &'static str,
    /// What is done, and where the answer comes from.
    pub about: &'static str,
    /// Measures it.
    pub run: fn() -> Outcome,
    /// Takes more than a few seconds without optimisation.
    pub slow: bool,
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Case").field("name", &self.name).finish()
    }
}

/// One measured number against the one that theory gives.
#[derive(Clone, Debug)]
pub struct Check {
    /// What is measured, with its setting.
    pub quantity: String,
    /// What theory says.
    pub expected: f64,
    /// What came out.
    pub measured: f64,
    /// How far apart they may be.
    pub bound: f64,
    /// The unit of all three.
    pub unit: &'static str,
    /// What it cost, or anything else worth knowing.
    pub remark: String,
}

impl Check {
    /// `measured` must be within `bound` of `expected`, all in `unit`.
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

    /// An error that must be below `bound`.
    pub fn error(
        quantity: impl Into<String>,
        measured: f64,
        bound: f64,
        unit: &'static str,
    ) -> Self {
        Self::new(quantity, 0.0, measured, bound, unit)
    }

    /// Adds a remark.
    pub fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remark = remark.into();
        self
    }

    /// Whether it is within its bound; NaN never is.
    pub fn passed(&self) -> bool {
        (self.measured - self.expected).abs() <= self.bound
    }
}
