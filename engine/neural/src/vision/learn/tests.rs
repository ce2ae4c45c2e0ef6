//! Tests of the training of networks that see, on images that are simple enough to learn in seconds.

use super::*;
use crate::vision::{Description, Vision};
use paracosm_perception::{Perceiver, Percept, Picture, Rect, suppress};

const RESOLUTION: [u32; 2] = [48, 32];

/// A dark image with a bright rectangle, at a place that depends on the number.
fn image(number: usize) -> (Vec<u8>, [usize; 4]) {
    let [width, height] = RESOLUTION.map(|size| size as usize);
    let at = [2 + 5 * number % 24, 2 + 7 * number % 14, 12 + number % 8, 10 + number % 6];
    let is_bright = |x: usize, y: usize| (at[0]..at[0] + at[2]).contains(&x) && (at[1]..at[1] + at[3]).contains(&y);
    let pixels = (0..width * height).map(|place| if is_bright(place % width, place / width) { 230 } else { 40 });
    (pixels.flat_map(|grey| [grey; 3]).collect(), at)
}

fn recipe(epochs: usize) -> Recipe {
    Recipe { resolution: RESOLUTION, seed: 1, batch: 8, epochs, rates: [3e-3, 3e-4] }
}

fn network(goal: Goal, contents: &[u8]) -> Vision {
    Vision::read(contents, Description::parse(&goal.description(RESOLUTION)).unwrap()).unwrap()
}

fn shown(rgb: &[u8]) -> Picture<'_> {
    Picture { width: RESOLUTION[0], height: RESOLUTION[1], rgb }
}

#[test]
fn a_network_learns_to_mark_bright_pixels_and_its_file_answers_as_it_did() {
    let bright = |rgb: &[u8]| rgb.chunks_exact(3).map(|pixel| pixel[0] > 128).collect::<Vec<bool>>();
    let examples: Vec<Example> =
        (0..64).map(|i| image(i).0).map(|rgb| Example::of_road(rgb.clone(), &bright(&rgb))).collect();
    let mut losses = Vec::new();
    let contents = train(Goal::Road, &recipe(12), &examples, "a test", |_, loss| losses.push(loss));
    assert!(losses[losses.len() - 1] < 0.2 * losses[0], "{losses:?}");
    let mut network = network(Goal::Road, &contents);
    // Places that no example has.
    let (rgb, _) = image(101);
    let Percept::Mask(mask) = network.perceive(&[shown(&rgb)]).unwrap().remove(0) else { panic!("a mask") };
    let right = mask.pixels.iter().zip(bright(&rgb)).filter(|(answered, is_bright)| **answered == *is_bright).count();
    assert!(right as f64 >= 0.97 * mask.pixels.len() as f64, "{right} of {}", mask.pixels.len());
}

#[test]
fn a_single_shot_detector_learns_boxes_around_bright_rectangles() {
    let rect = |at: [usize; 4]| {
        let [left, top, width, height] = at.map(|number| number as f64);
        Rect { left, top, width, height }
    };
    let example = |i: usize| {
        let (rgb, at) = image(i);
        Example::of_vehicles(rgb, RESOLUTION, &[Target { rect: rect(at), crowd: false }])
    };
    let examples: Vec<Example> = (0..64).map(example).collect();
    let contents = train(Goal::Vehicles, &recipe(40), &examples, "a test", |_, _| ());
    let mut network = network(Goal::Vehicles, &contents);
    for number in [100, 101, 102, 103] {
        let (rgb, at) = image(number);
        let Percept::Boxes(boxes) = network.perceive(&[shown(&rgb)]).unwrap().remove(0) else { panic!("boxes") };
        let found = suppress(&boxes, 0.3, 0.5);
        assert!(!found.is_empty() && found[0].rect.overlap(&rect(at)) > 0.6, "{at:?}: {found:?}");
    }
}

#[test]
fn the_same_recipe_makes_the_same_file_and_another_seed_another_one() {
    let examples: Vec<Example> = (0..8).map(|i| Example::of_road(image(i).0, &[true; 48 * 32])).collect();
    let made = |seed: u64| train(Goal::Road, &Recipe { seed, ..recipe(1) }, &examples, "a test", |_, _| ());
    assert!(made(1) == made(1) && made(1) != made(2));
}
