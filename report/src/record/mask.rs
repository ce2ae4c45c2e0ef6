//! Writes the visible pixels of objects as run-length encodings of COCO, from which `pycocotools` makes masks.
//!
//! The pixels of an image are counted column by column. The encoding has the lengths of runs in turn, without and with the object. A
//! length is written in groups of five bits, and from the fourth length on as the difference from the length before the last
//! (`maskApi.c` of the COCO API, Lin et al. 2014).

use std::collections::BTreeMap;

/// The first character of the encoding of a group of bits.
const FIRST: u8 = 48;

/// Returns the encoding for each object that an image of ids shows; 0 is the id of pixels without an object.
pub(super) fn masks(ids: &[u16], width: usize) -> BTreeMap<u16, String> {
    let height = ids.len() / width.max(1);
    let mut all: BTreeMap<u16, Runs> = BTreeMap::new();
    for x in 0..width {
        for y in 0..height {
            let id = ids[y * width + x];
            if id != 0 {
                all.entry(id).or_default().add(x * height + y);
            }
        }
    }
    all.into_iter().map(|(id, runs)| (id, runs.encoded(width * height))).collect()
}

/// The runs of an object so far.
#[derive(Default)]
struct Runs {
    lengths: Vec<usize>,
    /// The place behind the last pixel of the object.
    end: usize,
}

impl Runs {
    fn add(&mut self, place: usize) {
        match self.lengths.last_mut() {
            Some(last) if place == self.end => *last += 1,
            _ => self.lengths.extend([place - self.end, 1]),
        }
        self.end = place + 1;
    }

    fn encoded(mut self, pixels: usize) -> String {
        if self.end < pixels {
            self.lengths.push(pixels - self.end);
        }
        let mut text = String::new();
        for (i, length) in self.lengths.iter().enumerate() {
            let before = if i > 2 { self.lengths[i - 2] as i64 } else { 0 };
            encode(*length as i64 - before, &mut text);
        }
        text
    }
}

/// Writes a number in groups of five bits, the lowest first. The sixth bit says that a group follows, and the last group has the sign.
fn encode(mut number: i64, text: &mut String) {
    loop {
        let group = (number & 0x1f) as u8;
        number >>= 5;
        let is_last = if group & 0x10 != 0 { number == -1 } else { number == 0 };
        text.push(char::from(FIRST + if is_last { group } else { group | 0x20 }));
        if is_last {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Decodes as the COCO API does.
    fn decoded(text: &str, pixels: usize) -> Vec<bool> {
        let mut lengths: Vec<i64> = Vec::new();
        let mut bytes = text.bytes();
        while let Some(mut byte) = bytes.next() {
            let (mut number, mut shift) = (0_i64, 0);
            loop {
                let group = byte - FIRST;
                number |= i64::from(group & 0x1f) << shift;
                shift += 5;
                if group & 0x20 == 0 {
                    if group & 0x10 != 0 {
                        number |= -1_i64 << shift;
                    }
                    break;
                }
                byte = bytes.next().expect("a group follows");
            }
            let before = if lengths.len() > 2 { lengths[lengths.len() - 2] } else { 0 };
            lengths.push(number + before);
        }
        let runs = lengths.iter().enumerate().flat_map(|(i, length)| (0..*length).map(move |_| i % 2 == 1));
        let mask: Vec<bool> = runs.collect();
        assert_eq!(mask.len(), pixels);
        mask
    }

    #[test]
    fn known_masks_have_the_encoding_of_pycocotools() {
        // pycocotools.mask.encode(numpy.asfortranarray([[0, 1], [0, 1]], dtype="uint8"))["counts"] is b"22", and of a column of 40 in 3: b"X1X1X1".
        assert_eq!(masks(&[0, 7, 0, 7], 2)[&7], "22");
        let column: Vec<u16> = (0..120).map(|i| u16::from(i % 3 == 1)).collect();
        assert_eq!(masks(&column, 3)[&1], "X1X1X1");
    }

    proptest! {
        #[test]
        fn masks_are_the_pixels_of_their_objects(ids in prop::collection::vec(0_u16..4, 6 * 35), runs in any::<bool>()) {
            let ids: Vec<u16> = if runs { ids.iter().map(|id| id / 2).collect() } else { ids };
            let (width, height) = (35, 6);
            let all = masks(&ids, width);
            for id in 1..4 {
                let shown = |place: usize| ids[(place % height) * width + place / height] == id;
                let expected: Vec<bool> = (0..ids.len()).map(shown).collect();
                match all.get(&id) {
                    Some(text) => prop_assert_eq!(decoded(text, ids.len()), expected),
                    None => prop_assert!(expected.iter().all(|shown| !shown)),
                }
            }
        }
    }
}
