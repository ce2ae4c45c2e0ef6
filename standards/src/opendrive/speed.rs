//! Speed limits: where they hold along a road, and along the lanes of the network.

use super::road::{Lane, Road};
use paracosm_engine::road::SpeedLimit;

/// The least speed limit in m/s that a car can keep. A lower limit, such as 0, counts as this limit.
const LEAST: f64 = 1.0;

impl Road {
    /// Returns the speed limit in m/s on a lane at a place in metres along the road; `None` if no limit is known there. The limit
    /// of the lane itself counts, or else the limit of the road.
    pub fn limit(&self, lane: &Lane, s: f64) -> Option<f64> {
        let last = |limits: &[(f64, Option<f64>)]| limits.iter().rev().find(|(from, _)| *from <= s).map(|(_, of)| *of);
        last(&lane.limits).or_else(|| last(&self.limits)).flatten()
    }

    /// Returns the stretches with a speed limit along a lane of a section. `span` is the beginning and the end of the lane in its
    /// direction of traffic, in metres along the road; `length` is the length of the lane in metres.
    pub(super) fn stretches(&self, section: usize, lane: &Lane, span: [f64; 2], length: f64) -> Vec<SpeedLimit> {
        let section = &self.sections[section];
        let changes = self.limits.iter().chain(&lane.limits).map(|(s, _)| *s);
        let inside = changes.filter(|s| section.s < *s && *s < section.end);
        let mut ends: Vec<f64> = inside.chain([section.s, section.end]).collect();
        ends.sort_by(f64::total_cmp);
        let along = |s: f64| (s - span[0]) / (span[1] - span[0]) * length;
        let mut stretches: Vec<SpeedLimit> = Vec::new();
        for pair in ends.windows(2).filter(|pair| pair[0] < pair[1]) {
            let Some(speed) = self.limit(lane, pair[0]).map(|speed| speed.max(LEAST)) else { continue };
            match stretches.last_mut() {
                Some(last) if last.speed == speed && last.to == pair[0] => last.to = pair[1],
                _ => stretches.push(SpeedLimit { from: pair[0], to: pair[1], speed }),
            }
        }
        for stretch in &mut stretches {
            let [from, to] = [stretch.from, stretch.to].map(along);
            (stretch.from, stretch.to) = (from.min(to), from.max(to));
        }
        stretches.sort_by(|a, b| a.from.total_cmp(&b.from));
        stretches
    }
}
