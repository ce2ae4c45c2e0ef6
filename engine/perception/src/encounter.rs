//! Encounters: the times during which an object should be detected, and how long it stays undetected.

use std::collections::BTreeMap;

/// A time during which an object should be detected, from the first image to the last without a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encounter {
    /// The id of the object.
    pub object: u16,
    /// The time of the first image in seconds.
    pub begin: f64,
    /// The time of the last image in seconds.
    pub end: f64,
    /// The time of the first image with a match; `None` if the object was never matched.
    pub detected: Option<f64>,
    /// The time since which the object has had no match; `None` if it has a match in the last image.
    unmatched_since: Option<f64>,
}

/// The encounters of a test, in the order of their beginnings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Encounters {
    all: Vec<Encounter>,
    /// The encounters that have not ended, as places in `all` by the ids of their objects.
    present: BTreeMap<u16, usize>,
}

impl Encounters {
    /// Adds the next image: the objects that should be detected in it, each with `true` if it is matched.
    pub fn see(&mut self, time: f64, objects: impl IntoIterator<Item = (u16, bool)>) {
        let before = std::mem::take(&mut self.present);
        for (object, is_matched) in objects {
            let place = before.get(&object).copied().unwrap_or_else(|| {
                let begun = Encounter { object, begin: time, end: time, detected: None, unmatched_since: Some(time) };
                self.all.push(begun);
                self.all.len() - 1
            });
            let encounter = &mut self.all[place];
            encounter.end = time;
            if is_matched {
                encounter.detected.get_or_insert(time);
                encounter.unmatched_since = None;
            } else {
                encounter.unmatched_since.get_or_insert(time);
            }
            self.present.insert(object, place);
        }
    }

    /// Returns the longest time in seconds for which an object of the last image has had no match, at a time after the
    /// last image. The time counts from the first image without a match.
    pub fn unmatched(&self, time: f64) -> f64 {
        let waiting = self.present.values().filter_map(|place| self.all[*place].unmatched_since);
        waiting.map(|since| time - since).fold(0.0, f64::max)
    }

    /// Returns all encounters.
    pub fn all(&self) -> &[Encounter] {
        &self.all
    }
}

impl Encounter {
    /// Returns the seconds from the beginning to the first match; `None` if the object was never matched.
    pub fn delay(&self) -> Option<f64> {
        self.detected.map(|detected| detected - self.begin)
    }
}
