//! Colour table of a GIF.

use std::cmp::Reverse;
use std::collections::HashMap;

use color_quant::NeuQuant;

/// Number of colours. One more index of the 256 is reserved for transparent pixels.
pub(super) const COLOUR_COUNT: usize = 255;
/// Maximum number of colours that enter the table exactly. Approximated, they would show as bands in
/// a smooth background.
const MAX_EXACT: usize = 40;
/// A colour enters the table exactly if it covers more than one in this many pixels.
const EXACT_SHARE: u64 = 500;
/// Maximum weight of a colour in the quantisation of the other colours.
const MAX_WEIGHT: u32 = 64;
/// Minimum number of bytes that the quantiser needs as input.
const MIN_SAMPLE_BYTES: usize = 4 * 1024;

/// A colour table for all frames; a table per frame would flicker.
pub(super) struct Palette {
    exact: Vec<[u8; 3]>,
    quantiser: NeuQuant,
    /// Index of every colour seen so far.
    indices: HashMap<[u8; 3], u8>,
}

impl Palette {
    /// Computes the table from the pixels (RGB) of some frames.
    pub fn from_frames<'a>(frames: impl Iterator<Item = &'a [u8]>) -> Self {
        let mut counts: HashMap<[u8; 3], u32> = HashMap::new();
        for pixel in frames.flat_map(|pixels| pixels.chunks_exact(3)) {
            *counts.entry([pixel[0], pixel[1], pixel[2]]).or_default() += 1;
        }
        // sorted, so that the same run gives the same file
        let mut counts: Vec<_> = counts.into_iter().collect();
        counts.sort_unstable_by_key(|&(colour, count)| (Reverse(count), colour));
        let total: u64 = counts.iter().map(|&(_, count)| u64::from(count)).sum();
        let is_frequent = |count: u32| u64::from(count) * EXACT_SHARE > total;
        let exact = counts.iter().take(MAX_EXACT).filter(|&&(_, count)| is_frequent(count));
        let exact: Vec<[u8; 3]> = exact.map(|&(colour, _)| colour).collect();
        // the square root of the count, because a small body needs as many shades as a large floor
        let weight =
            |count: u32| f64::from(count).sqrt().ceil().min(f64::from(MAX_WEIGHT)) as usize;
        let mut samples = Vec::new();
        for ([r, g, b], count) in counts.split_off(exact.len()) {
            for _ in 0..weight(count) {
                samples.extend([r, g, b, 255]);
            }
        }
        while samples.len() < MIN_SAMPLE_BYTES {
            let copy = samples.clone();
            samples.extend(if copy.is_empty() { vec![255; 4] } else { copy });
        }
        let quantiser = NeuQuant::new(3, COLOUR_COUNT - exact.len(), &samples);
        let indices = exact.iter().copied().zip(0..).collect();
        Self { exact, quantiser, indices }
    }

    /// Red, green and blue of all colours.
    pub fn colours(&self) -> Vec<u8> {
        let quantised = self.quantiser.color_map_rgb();
        self.exact.iter().flatten().copied().chain(quantised).collect()
    }

    /// The index of the nearest colour for each pixel (RGB).
    pub fn indices(&mut self, pixels: &[u8]) -> Vec<u8> {
        let Self { exact, quantiser, indices } = self;
        let first = exact.len();
        let index = |pixel: &[u8]| {
            let rgba = [pixel[0], pixel[1], pixel[2], 255];
            let nearest = || (first + quantiser.index_of(&rgba)) as u8;
            *indices.entry([pixel[0], pixel[1], pixel[2]]).or_insert_with(nearest)
        };
        pixels.chunks_exact(3).map(index).collect()
    }
}
