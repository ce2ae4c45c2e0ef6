//! The kinds of defects, and the one list of them.

use crate::defect::DefectError;
use crate::{acting, sensing, timing};
use paracosm_engine::driver::Driver;
use paracosm_space::nearest;

/// A kind of defect: its name, its sizes, its source, and the function that puts it into a driver.
#[derive(Debug)]
pub struct Kind {
    /// The name of the kind.
    pub name: &'static str,
    /// A sentence about a driver with the defect, which says the meaning of the size.
    pub about: &'static str,
    /// The unit of the size.
    pub unit: &'static str,
    /// The sizes that a set of mutants uses, from slight to gross. Every number between the first and the last is a size.
    pub sizes: &'static [f64],
    /// The published fault or limit that the kind follows. "fault model" means that the kind has no such source.
    pub source: &'static str,
    pub(crate) make: fn(f64, Box<dyn Driver>) -> Box<dyn Driver>,
}

impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Kind {
    /// Returns the least and the greatest size of the kind.
    pub fn range(&self) -> (f64, f64) {
        let [first, .., last] = *self.sizes else { panic!("`{}` has fewer than two sizes", self.name) };
        (first.min(last), first.max(last))
    }
}

/// The kinds of all defects. Lists show the kinds in this order, and sets of mutants take them in turns.
pub const ALL: &[&Kind] = &[
    // What the driver does not see.
    &sensing::unseen::SHORT_RANGE,
    &sensing::unseen::NARROW_VIEW,
    &sensing::unseen::BLIND_LEFT,
    &sensing::unseen::BLIND_RIGHT,
    &sensing::unseen::BLIND_NEAR,
    &sensing::unseen::BLIND_SPEEDS,
    &sensing::unseen::NARROW_CORRIDOR,
    &sensing::unseen::UNSEEN_STANDING,
    &sensing::unseen::UNSEEN_CROSSING,
    &sensing::unseen::UNSEEN_ONCOMING,
    &sensing::unseen::UNSEEN_SMALL,
    &sensing::classes::UNSEEN_PEDESTRIANS,
    &sensing::classes::UNSEEN_TWO_WHEELERS,
    &sensing::classes::UNSEEN_CARS,
    &sensing::classes::UNSEEN_LORRIES,
    &sensing::classes::UNSEEN_THINGS,
    &sensing::nearest::NEAREST_ONLY,
    // What it sees too late, or not always.
    &sensing::late::LATE_DETECTION,
    &sensing::late::LOST_IN_TURNS,
    &sensing::late::RECLASSIFIED,
    &sensing::late::STALE_WORLD,
    &sensing::gaps::LOST_FRAMES,
    &sensing::gaps::LOST_BODIES,
    &sensing::gaps::OUTAGES,
    &sensing::gaps::FROZEN_SENSOR,
    // What it sees wrongly.
    &sensing::wrong::POSITION_NOISE,
    &sensing::wrong::SPEED_NOISE,
    &sensing::wrong::FAR_DISTANCES,
    &sensing::wrong::SLOW_OTHERS,
    &sensing::wrong::FAST_OTHERS,
    &sensing::wrong::NO_SIDEWAYS,
    &sensing::wrong::SLOW_SELF,
    &sensing::wrong::THIN_BODIES,
    &sensing::wrong::MISALIGNED,
    &sensing::places::MIXED_UNITS,
    &sensing::places::FLIPPED_SIDE,
    &sensing::places::OFF_BY_ONE_LANE,
    &sensing::places::MISLOCATED,
    &sensing::places::PHANTOM,
    // What it does wrongly.
    &acting::brakes::WEAK_BRAKES,
    &acting::brakes::NO_BRAKES_ABOVE,
    &acting::brakes::NO_BRAKES_BELOW,
    &acting::brakes::NO_BRAKES_IN_BENDS,
    &acting::braking::SLOW_BRAKES,
    &acting::braking::FADING_BRAKES,
    &acting::braking::FEW_BRAKINGS,
    &acting::braking::SUPPRESSED_BRAKING,
    &acting::pedals::BIASED_THROTTLE,
    &acting::pedals::WEAK_STEERING,
    &acting::pedals::BIASED_STEERING,
    // What it does too late.
    &timing::LATE_REACTION,
    &timing::BUSY,
    &timing::SLOW_CYCLE,
    &timing::FROZEN_OUTPUT,
    &timing::LOST_ANSWERS,
];

/// Finds the kind of defect with the given name.
///
/// # Errors
/// No kind has the given name. The error suggests the nearest name.
pub fn find(name: &str) -> Result<&'static Kind, DefectError> {
    ALL.iter().copied().find(|kind| kind.name == name).ok_or_else(|| DefectError::Unknown {
        name: name.to_owned(),
        nearest: nearest(name, ALL.iter().map(|kind| kind.name)),
    })
}
