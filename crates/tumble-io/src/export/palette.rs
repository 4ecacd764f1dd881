//! 255 colours for an animated picture.

use std::collections::HashMap;

use color_quant::NeuQuant;

/// How many colours a picture may have; one more number is left for "as before".
pub(super) const COLOURS: usize = 255;
/// So many colours at most are kept as they are, each with at least this part of all pixels: a
/// smooth background would show steps.
const KEPT: usize = 40;
const KEPT_SHARE: u64 = 500;
/// Any other colour is taken to heart at most so many times.
const MOST: u32 = 64;

/// The colours of an animated picture, the same in all frames, so that nothing flickers.
pub(super) struct Palette {
    kept: Vec<[u8; 3]>,
    quantiser: NeuQuant,
    found: HashMap<[u8; 3], u8>,
}

impl Palette {
    /// Learns from the pixels of some frames.
    pub fn learn<'a>(frames: impl Iterator<Item = &'a [u8]>) -> Self {
        let mut counts: HashMap<[u8; 3], u32> = HashMap::new();
        for pixel in frames.flat_map(|pixels| pixels.chunks_exact(3)) {
            *counts.entry([pixel[0], pixel[1], pixel[2]]).or_default() += 1;
        }
        // in a fixed order, so that the same run gives the same file
        let mut counts: Vec<_> = counts.into_iter().collect();
        counts.sort_unstable_by_key(|&(colour, count)| (std::cmp::Reverse(count), colour));
        let all: u64 = counts.iter().map(|&(_, count)| u64::from(count)).sum();
        let is_large = |count: u32| u64::from(count) * KEPT_SHARE > all;
        let kept = counts.iter().take(KEPT).filter(|&&(_, count)| is_large(count));
        let kept: Vec<[u8; 3]> = kept.map(|&(colour, _)| colour).collect();
        // by the root of its share: a small body needs as many shades as a large floor
        let weight = |count: u32| f64::from(count).sqrt().ceil().min(f64::from(MOST)) as usize;
        let mut pixels = Vec::new();
        for ([r, g, b], count) in counts.split_off(kept.len()) {
            for _ in 0..weight(count) {
                pixels.extend([r, g, b, 255]);
            }
        }
        // the network of the quantiser wants some food
        while pixels.len() < 4 * 1024 {
            let again = pixels.clone();
            pixels.extend(if again.is_empty() { vec![255; 4] } else { again });
        }
        let quantiser = NeuQuant::new(3, COLOURS - kept.len(), &pixels);
        let found = kept.iter().copied().zip(0..).collect();
        Self { kept, quantiser, found }
    }

    /// Red, green and blue of every colour.
    pub fn colours(&self) -> Vec<u8> {
        let learned = self.quantiser.color_map_rgb();
        self.kept.iter().flatten().copied().chain(learned).collect()
    }

    /// The numbers of the colours nearest to these pixels.
    pub fn numbers(&mut self, pixels: &[u8]) -> Vec<u8> {
        let Self { kept, quantiser, found } = self;
        let first = kept.len();
        let number = |pixel: &[u8]| {
            let rgba = [pixel[0], pixel[1], pixel[2], 255];
            let find = || (first + quantiser.index_of(&rgba)) as u8;
            *found.entry([pixel[0], pixel[1], pixel[2]]).or_insert_with(find)
        };
        pixels.chunks_exact(3).map(number).collect()
    }
}
