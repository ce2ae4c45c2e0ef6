//! Finds which pixels decide the answers of the network that follows a leader, and whether it follows red pixels, as
//! the paper guesses of its own network.
//!
//! The study changes the network's images in three ways, at one speed. First, each place is covered with grey; the
//! change of the answer says how much the place matters. Second, a red rectangle of the leader's size is put anywhere
//! into the empty road. Third, the throttle is read for a leader at growing distance: red, white, beside the road, or
//! only a rectangle.

mod frames;
mod occlusion;

use crate::cloning::FOLLOW;
use crate::{Done, print, write};
use frames::{Scene, Seen, Studio};
use indicatif::ProgressBar;
use occlusion::{NOTHING, changes, covered, share, touching};
use paracosm::engine::object::Colour;
use paracosm::engine::sensor::Image;
use paracosm::report::{HeatMap, Picture};
use paracosm_neural::{AnswerError, Model};
use std::path::Path;
use thiserror::Error;

const RED: Colour = [190, 25, 30];
const WHITE: Colour = [235, 235, 235];

/// The speed that the network is told, in m/s, and the distance of the leader on the maps, in metres.
const SPEED: f64 = 8.0;
const GAP: f64 = 8.0;
/// The greatest distance at which the throttle is read, in metres.
const FARTHEST: u8 = 30;
/// The side of the grey patch in pixels, an odd number, so that the patch has a middle.
const PATCH: usize = 5;
/// The place of the leader beside the lane's middle, in metres to the left: on the other lane, and on the grass.
const ONCOMING: f64 = 3.5;
const GRASS: f64 = -6.0;

/// The frames that are covered, each with a name and the leader's colour, if there is a leader.
const FRAMES: [(&str, Option<Colour>); 3] =
    [("red leader", Some(RED)), ("white leader", Some(WHITE)), ("nobody", None)];

/// The places of the network's answers.
const STEERING: usize = 0;
const THROTTLE: usize = 1;

/// A frame, and the change of the answer when each of its places is covered.
struct Covered {
    name: &'static str,
    seen: Seen,
    answer: [f32; 2],
    changes: Vec<[f64; 2]>,
}

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    bar.finish_and_clear();
    let model = FOLLOW.network();
    let scene = |colour: Option<Colour>| Scene { gap: colour.map(|_| GAP), beside: 0.0, colour: colour.unwrap_or(RED) };
    let mut studio = Studio::open()?;
    let seen = studio.draw(&FRAMES.map(|(_, colour)| scene(colour)))?;
    let mut all = Vec::new();
    for ((name, _), seen) in FRAMES.into_iter().zip(seen) {
        let answer = model.answer(&seen.image, SPEED)?;
        let changes = changes(&model, &seen.image, SPEED, [PATCH; 2], NOTHING)?;
        all.push(Covered { name, seen, answer, changes });
    }
    let [red, _, nobody] = &all[..] else { unreachable!("there are three frames") };
    let rectangle = rectangle_of(&red.seen)?;
    let red_anywhere = changes(&model, &nobody.seen.image, SPEED, rectangle.size, rectangle.colour)?;

    let picture = Picture::of_images(2, images(&model, &all, &rectangle)?);
    write(&out.join("saliency-images.png"), picture.png()?)?;
    write(&out.join("saliency-maps.csv"), maps(&all, &red_anywhere))?;
    let shares = shares(&all);
    write(&out.join("saliency.csv"), &shares)?;

    let table = by_gap(&model, &mut studio)?;
    write(&out.join("saliency-gap.csv"), &table)?;
    print(&format!("{shares}{}{table}", anywhere(&red_anywhere, &nobody.seen, &rectangle)))
}

/// A rectangle with the leader's size, place and mean colour.
struct Rectangle {
    size: [usize; 2],
    middle: [usize; 2],
    colour: Colour,
}

/// An image in which no pixel shows the leader.
#[derive(Debug, Error)]
#[error("the leader is not to be seen")]
struct Unseen;

fn rectangle_of(seen: &Seen) -> Result<Rectangle, Unseen> {
    let [left, right, top, bottom] = seen.bounds().ok_or(Unseen)?;
    let size = [right - left + 1, bottom - top + 1];
    Ok(Rectangle { size, middle: [left + size[0] / 2, top + size[1] / 2], colour: seen.leaders_colour() })
}

/// Returns the images of all frames, and the empty road with a red rectangle at the place of a leader.
fn images(model: &Model, all: &[Covered], rectangle: &Rectangle) -> Result<Vec<HeatMap>, AnswerError> {
    let image = |name: &str, image: &Image, [steering, throttle]: [f32; 2]| HeatMap {
        title: name.to_owned(),
        note: format!("steering {steering:.2}, throttle {throttle:.2} at {SPEED} m/s"),
        width: image.width,
        rgb: image.rgb.clone(),
        values: Vec::new(),
        most: 1.0,
    };
    let mut images: Vec<HeatMap> = all.iter().map(|frame| image(frame.name, &frame.seen.image, frame.answer)).collect();
    let painted = covered(&all[2].seen.image, rectangle.middle, rectangle.size, rectangle.colour);
    images.push(image("red rectangle", &painted, model.answer(&painted, SPEED)?));
    Ok(images)
}

/// Returns all numbers of the maps as CSV.
fn maps(all: &[Covered], red_anywhere: &[[f64; 2]]) -> String {
    let mut rows = vec!["what,column,row,leader,steering,throttle".to_owned()];
    let mut add = |what: &str, seen: &Seen, changes: &[[f64; 2]]| {
        for (i, [steering, throttle]) in changes.iter().enumerate() {
            let (column, row) = (i % seen.width(), i / seen.width());
            rows.push(format!("{what},{column},{row},{},{steering:.6},{throttle:.6}", u8::from(seen.leader[i])));
        }
    };
    all.iter().for_each(|frame| add(frame.name, &frame.seen, &frame.changes));
    add("red rectangle", &all[2].seen, red_anywhere);
    rows.join("\n") + "\n"
}

/// Returns the leader's share of all changes, beside the leader's share of the places, as CSV.
fn shares(all: &[Covered]) -> String {
    let mut rows = vec!["frame,steering,throttle,share_of_places,share_of_throttle,share_of_steering".to_owned()];
    // In the frame without a leader, the places are those of the red leader.
    let red = touching(&all[0].seen, PATCH);
    for Covered { name, seen, answer: [steering, throttle], changes } in all {
        let places = if seen.leader.contains(&true) { touching(seen, PATCH) } else { red.clone() };
        let area = places.iter().filter(|place| **place).count() as f64 / places.len() as f64;
        let [of_steering, of_throttle] = [STEERING, THROTTLE].map(|output| share(changes, output, &places));
        rows.push(format!("{name},{steering:.4},{throttle:.4},{area:.4},{of_throttle:.4},{of_steering:.4}"));
    }
    rows.join("\n") + "\n"
}

/// Says how a red rectangle changes the throttle at the leader's place, on average, and at most.
fn anywhere(changes: &[[f64; 2]], seen: &Seen, rectangle: &Rectangle) -> String {
    let [column, row] = rectangle.middle;
    let there = changes[row * seen.width() + column][THROTTLE];
    let mean = changes.iter().map(|change| change[THROTTLE]).sum::<f64>() / changes.len() as f64;
    let (at, least) = changes
        .iter()
        .map(|change| change[THROTTLE])
        .enumerate()
        .fold((0, 0.0), |best, (i, change)| if change < best.1 { (i, change) } else { best });
    let (column, row) = (at % seen.width(), at / seen.width());
    format!(
        "a red rectangle changes the throttle by {there:.3} where the leader would be, by {mean:.3} on average over the \
         image, by {least:.3} at most (column {column}, row {row})\n"
    )
}

/// Returns the throttle by the distance of each thing that may be taken for a leader, as CSV.
fn by_gap(model: &Model, studio: &mut Studio) -> Result<String, Box<dyn std::error::Error + Send + Sync>> {
    let gaps: Vec<f64> = (3..=FARTHEST).map(f64::from).collect();
    let scenes = |beside: f64, colour: Colour| -> Vec<Scene> {
        gaps.iter().map(|gap| Scene { gap: Some(*gap), beside, colour }).collect()
    };
    let cases = [
        ("red leader", 0.0, RED),
        ("white leader", 0.0, WHITE),
        ("red, other lane", ONCOMING, RED),
        ("red, on the grass", GRASS, RED),
    ];
    let mut curves: Vec<(String, Vec<f64>)> = Vec::new();
    let mut leaders = Vec::new();
    for (name, beside, colour) in cases {
        let seen = studio.draw(&scenes(beside, colour))?;
        curves.push((name.to_owned(), throttles(model, seen.iter())?));
        if curves.len() == 1 {
            leaders = seen;
        }
    }
    let empty = studio.draw(&[Scene { gap: None, beside: 0.0, colour: RED }])?.remove(0);
    let alone = model.answer(&empty.image, SPEED)?[THROTTLE];
    let mut painted = Vec::new();
    for leader in &leaders {
        let Rectangle { size, middle, colour } = rectangle_of(leader)?;
        painted.push(Seen { image: covered(&empty.image, middle, size, colour), leader: vec![] });
    }
    curves.push(("bare red rectangle".to_owned(), throttles(model, painted.iter())?));
    curves.push(("nobody".to_owned(), vec![f64::from(alone); gaps.len()]));

    let names: Vec<String> = curves.iter().map(|curve| curve.0.replace(", ", "_").replace(' ', "_")).collect();
    let mut rows = vec![format!("gap,pixels,{}", names.join(","))];
    for (i, gap) in gaps.iter().enumerate() {
        let pixels = leaders[i].leader.iter().filter(|mine| **mine).count();
        let numbers: Vec<String> = curves.iter().map(|curve| format!("{:.4}", curve.1[i])).collect();
        rows.push(format!("{gap},{pixels},{}", numbers.join(",")));
    }
    Ok(rows.join("\n") + "\n")
}

fn throttles<'a>(model: &Model, seen: impl Iterator<Item = &'a Seen>) -> Result<Vec<f64>, AnswerError> {
    seen.map(|seen| Ok(f64::from(model.answer(&seen.image, SPEED)?[THROTTLE]))).collect()
}
