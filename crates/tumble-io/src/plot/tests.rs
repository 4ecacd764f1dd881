//! Tests of the energy chart and its axes.

use super::axis::Axis;
use super::{EnergyRow, energy_svg};
use proptest::prelude::*;

fn ramp(count: usize) -> Vec<EnergyRow> {
    let row = |i: usize| {
        let time = 0.01 * i as f64;
        EnergyRow { time, kinetic: 5.0 - time, drag: time, total: 5.0, ..EnergyRow::default() }
    };
    (0..count).map(row).collect()
}

/// Asserts that all tags are closed in order and that text contains no unescaped markup.
fn assert_well_formed(svg: &str) {
    let mut open = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        let text = &rest[..start];
        assert!(!text.contains('>'), "bare > in {text:?}");
        let end = rest[start..].find('>').map(|end| start + end).unwrap();
        let tag = &rest[start + 1..end];
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name)),
            None if tag.ends_with('/') => {}
            None => open.push(tag.split_whitespace().next().unwrap()),
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty() && rest.trim().is_empty());
}

#[test]
fn only_nonzero_terms_are_drawn() {
    let svg = energy_svg("throw", &ramp(200)).unwrap();
    assert_well_formed(&svg);
    for name in ["kinetic", "lost to drag", "total", "residual", "time (s)", "energy (J)", "throw"]
    {
        assert!(svg.contains(&format!("\n{name}\n")), "{name}");
    }
    for name in ["elastic", "gravitational", "lost to slip", "lost to dashpots"] {
        assert!(!svg.contains(name), "{name}");
    }
    assert!(svg.contains("sans-serif"));
}

#[test]
fn title_is_escaped() {
    let svg = energy_svg("a <b> & \"c\" \u{1}\u{ffff}", &ramp(3)).unwrap();
    assert_well_formed(&svg);
    assert!(svg.contains("a &lt;b&gt; &amp; "));
}

#[test]
fn downsampling_preserves_peaks_and_limits_size() {
    let mut rows = ramp(1_000_000);
    rows[123_456].elastic = 1e7;
    let svg = energy_svg("long", &rows).unwrap();
    assert!(svg.len() < 500_000, "{} bytes", svg.len());
    assert!(svg.contains("1e7"), "the axis reaches the peak");
}

#[test]
fn short_ledgers_give_well_formed_charts() {
    for rows in [vec![], ramp(1), ramp(2), vec![EnergyRow::default(); 5]] {
        assert_well_formed(&energy_svg("few", &rows).unwrap());
    }
}

#[test]
fn labels_are_short_at_any_magnitude() {
    let axis = |high: f64| Axis::from_values([0.0, high].into_iter(), 0.0);
    assert_eq!(axis(1e7).label(0.5), "5e6");
    assert_eq!(axis(3.0).label(1.5), "1.5");
    assert_eq!(axis(3e-12).label(1.5), "1.5e-12");
    assert_eq!(axis(2000.0).label(0.5), "500");
    assert_eq!(axis(3.0).label(-1e-17), "0");
    assert_eq!(axis(1e-14).scientific_label(0.0), "0");
}

#[test]
fn axis_contains_a_constant() {
    let axis = Axis::from_values([7e5; 4].into_iter(), 0.05);
    assert!(axis.low < 7.0 && axis.high > 7.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn arbitrary_numbers_give_well_formed_charts(values in prop::collection::vec(any::<[f64; 4]>(), 0..5)) {
        let row = |&[time, kinetic, total, residual]: &[f64; 4]| {
            EnergyRow { time, kinetic, total, residual, ..EnergyRow::default() }
        };
        let rows: Vec<EnergyRow> = values.iter().map(row).collect();
        assert_well_formed(&energy_svg("any", &rows).unwrap());
    }

    #[test]
    fn nearly_constant_values_give_well_formed_charts(centre in -1e9f64..1e9, width in 0.0f64..1e-3) {
        let ends = [centre, centre + width];
        let rows = ends.map(|total| EnergyRow { total, time: total, ..EnergyRow::default() });
        assert_well_formed(&energy_svg("near", &rows).unwrap());
    }
}
