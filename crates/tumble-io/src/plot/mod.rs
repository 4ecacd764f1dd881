//! Charts of a run as SVG, drawn without system fonts.
//!
//! | file | contents |
//! |---|---|
//! | `energy` | chart of the energy ledger over time |
//! | `axis` | axis ranges and tick labels |

mod axis;
mod energy;
#[cfg(test)]
mod tests;

pub use energy::{EnergyRow, PlotError, energy_svg};
