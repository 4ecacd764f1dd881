//! stub
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct EnergyRow {
    pub time: f64,
    pub kinetic: f64,
    pub gravitational: f64,
    pub elastic: f64,
    pub drag: f64,
    pub dashpot: f64,
    pub slip: f64,
    pub total: f64,
    pub residual: f64,
}
/// stub
pub fn energy_svg(_: &str, _: &[EnergyRow]) -> Result<String, std::fmt::Error> {
    Ok(String::new())
}
