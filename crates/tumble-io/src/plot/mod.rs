//! Charts of a run as SVG: text and lines that any browser shows, drawn without system fonts.
//!
//! | file | does |
//! |---|---|
//! | `energy` | the energy ledger over time |
//! | `axis` | ranges and tick labels for any magnitude |

mod axis;
mod energy;
#[cfg(test)]
mod tests;

pub use energy::{EnergyRow, PlotError, energy_svg};
