//! The one list of all kinds of defects.

use crate::error::DefectError;
use crate::kind::Kind;
use crate::{acting, sensing, timing};
use paracosm_space::nearest;

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
