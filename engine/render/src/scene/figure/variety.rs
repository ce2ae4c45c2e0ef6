//! Chooses what bodies look like in the look `textured`: the lot follows from the id of a body, so that a car or a person
//! looks the same from image to image, and in every test of a scenario.
//!
//! A body that has the usual colour of its class has no colour of its own, and gets one by lot. The colour that a scenario
//! gives to a body stays.

use crate::mesh::cars::paints;
use paracosm_engine::object::{Body, Class, Colour};

/// The lots of a body, each independent of the others.
pub(super) const KIND: u32 = 1;
const COLOUR: u32 = 2;

/// The colours of jackets.
const JACKETS: [Colour; 16] = [
    [28, 30, 36],
    [44, 48, 58],
    [22, 30, 56],
    [60, 72, 96],
    [92, 96, 100],
    [140, 142, 140],
    [216, 214, 208],
    [120, 96, 70],
    [176, 152, 118],
    [70, 78, 50],
    [40, 72, 60],
    [122, 30, 34],
    [176, 44, 40],
    [190, 120, 40],
    [96, 66, 104],
    [64, 110, 150],
];
/// The colours of vans, lorries, motorcycles and bicycles.
const VANS: [Colour; 8] = [
    [232, 233, 232],
    [232, 233, 232],
    [226, 227, 226],
    [236, 236, 232],
    [150, 154, 158],
    [74, 78, 84],
    [30, 54, 104],
    [150, 30, 30],
];
const TRUCKS: [Colour; 7] =
    [[228, 229, 228], [222, 222, 220], [44, 74, 128], [140, 30, 30], [62, 66, 72], [40, 92, 70], [206, 160, 50]];
const CYCLES: [Colour; 6] = [[24, 24, 26], [60, 62, 66], [150, 24, 28], [24, 60, 120], [220, 220, 216], [40, 100, 70]];

/// Returns a pseudorandom number that depends only on the id of a body and on the purpose (Steele et al., Fast splittable
/// pseudorandom number generators, 2014).
pub(in crate::scene) fn lot(id: u16, purpose: u32) -> u32 {
    let mut mixed = (u64::from(id) << 32 | u64::from(purpose)).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((mixed ^ (mixed >> 31)) >> 33) as u32
}

/// Returns the colour in which a body is drawn.
pub(super) fn colour(body: &Body, id: u16) -> Colour {
    let usual = Body::disc(body.class, 1.0, 1.0).colour;
    if body.colour != usual {
        return body.colour;
    }
    let lot = lot(id, COLOUR);
    let one_of = |colours: &[Colour]| colours[lot as usize % colours.len()];
    match body.class {
        Class::Car => paints::paint(lot),
        Class::Van => one_of(&VANS),
        Class::Truck => one_of(&TRUCKS),
        Class::Motorcycle | Class::Bicycle => one_of(&CYCLES),
        Class::Pedestrian => one_of(&JACKETS),
        Class::Bus | Class::Building | Class::Tree | Class::Sign | Class::Prop => usual,
    }
}
