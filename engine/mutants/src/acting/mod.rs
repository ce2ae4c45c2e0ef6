//! Defects that change what the driver does to the car.

pub(crate) mod brakes;
pub(crate) mod braking;
pub(crate) mod pedals;

use paracosm_engine::Control;

/// The throttle below which the driver brakes. Speed controls slow down with less.
const BRAKING: f64 = -0.1;

/// Takes the brakes from a control, and leaves the rest.
fn release(control: &mut Control) {
    limit(control, 0.0);
}

/// Limits the brakes of a control to a throttle, which is at most 0.
fn limit(control: &mut Control, strongest: f64) {
    if control.throttle < strongest {
        control.throttle = strongest;
    }
}
