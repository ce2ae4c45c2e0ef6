//! The paper's Figures 7 and 8: detectors of vehicles on six lanes of traffic, with a white truck that crosses the road.
//!
//! The car drives along the innermost lane. Every 10 m, the vehicles in the image are counted, those that a detector
//! found, and its false alarms. Thresholds are frozen before, on easy scenes: at 0.1 false alarms an image.

use super::detectors::{ALARMS, Found, RESOLUTION, Vehicles, all, easy};
use super::{Failure, is_crossing_truck, sheet, still};
use crate::{Done, print, scenario, write};
use image::RgbImage;
use indicatif::ProgressBar;
use paracosm::campaign::Worker;
use paracosm::campaign::gallery::{Gallery, Shown};
use paracosm::space::{Value, Values};
use std::path::Path;

/// The distance of neighbouring images in metres.
const EVERY: f64 = 10.0;
/// The distance at which the sample image is taken, in metres: the truck is in the middle of the crossing.
const SAMPLE: f64 = 210.0;

/// The counts of a detector in an image.
#[derive(Debug, Clone, Copy)]
struct Counts {
    travelled: f64,
    visible: usize,
    found: usize,
    false_alarms: usize,
    /// The truck that crosses: `None` if it is not visible, else whether it was found.
    truck: Option<bool>,
}

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let (mut detectors, absent) = all()?;
    let easy = easy(bar)?;
    let drive = drive()?;
    let mut table = vec!["detector,threshold,travelled_m,visible,found,false_alarms,truck".to_owned()];
    let mut text = format!("thresholds at {ALARMS} false alarms an image of {} images of easy scenes\n", easy.len());
    let mut samples = Vec::new();
    for detector in &mut detectors {
        let threshold = detector.freeze(&easy)?;
        let (mut counts, mut is_sampled) = (Vec::new(), false);
        for (travelled, shown) in &drive {
            let (vehicles, found) = detector.see(shown)?;
            if *travelled >= SAMPLE && !is_sampled {
                is_sampled = true;
                samples.push(sheet::answered(shown, &vehicles, &found, threshold));
            }
            counts.push(counted(*travelled, &vehicles, &found, threshold));
        }
        let name = detector.name;
        for Counts { travelled, visible, found, false_alarms, truck } in &counts {
            let truck = truck.map_or("", |found| if found { "found" } else { "missed" });
            table.push(format!("{name},{threshold:.4},{travelled:.1},{visible},{found},{false_alarms},{truck}"));
        }
        let sum = |of: fn(&Counts) -> usize| counts.iter().map(of).sum::<usize>();
        let trucks: Vec<bool> = counts.iter().filter_map(|counts| counts.truck).collect();
        text += &format!(
            "{name:<18}threshold {threshold:.2}: {} of {} vehicles, {} false alarms, the truck in {} of {} images\n",
            sum(|counts| counts.found),
            sum(|counts| counts.visible),
            sum(|counts| counts.false_alarms),
            trucks.iter().filter(|found| **found).count(),
            trucks.len()
        );
    }
    for name in absent {
        text += &format!("{name:<18}absent: experiments/detectors/fetch.py fetches it\n");
    }
    bar.finish_and_clear();
    if !samples.is_empty() {
        let rows: Vec<Vec<RgbImage>> = samples.chunks(2).map(<[RgbImage]>::to_vec).collect();
        write(&out.join("fig7.png"), sheet::png(&rows)?)?;
    }
    write(&out.join("fig8.csv"), table.join("\n") + "\n")?;
    print(&text)
}

/// Returns the images of the drive, one every 10 m, with the distance that the car had travelled.
fn drive() -> Result<Vec<(f64, Shown)>, Failure> {
    let study = scenario("highway-traffic")?.driver("planner").build()?;
    let number = |name: &str, value: f64| (name.to_owned(), Value::Number(value));
    let test: Values = [number("truck_delay", 5.0), number("truck_speed", 8.0)].into_iter().collect();
    let (trial, trace) = Worker::new(&study)?.run(0, &test);
    let trace = trace.ok_or_else(|| trial.error().unwrap_or_default().to_owned())?;
    let travelled: Vec<f64> = trace.signal("car.travelled").into_iter().flatten().collect();
    let shown = Gallery::new(&study, still(RESOLUTION, 24.0, 10.0))?.show(&test)?;
    let mut next = 0.0;
    let mut drive = Vec::new();
    for shown in shown {
        let tick = (shown.time() / trace.dt()).round() as usize;
        let Some(at) = travelled.get(tick).copied().filter(|at| *at >= next) else { continue };
        next = (at / EVERY).floor() * EVERY + EVERY;
        drive.push((at, shown));
    }
    Ok(drive)
}

fn counted(travelled: f64, vehicles: &Vehicles, found: &Found, threshold: f64) -> Counts {
    let matching = vehicles.matched(found, threshold);
    let is_found = |place: &usize| matching.detected[*place].is_some();
    let counting: Vec<usize> = vehicles.counting().collect();
    let truck = counting.iter().find(|place| is_crossing_truck(&vehicles.users[**place]));
    Counts {
        travelled,
        visible: counting.len(),
        found: counting.iter().filter(|place| is_found(place)).count(),
        false_alarms: matching.objects.iter().filter(|object| object.is_none()).count(),
        truck: truck.map(is_found),
    }
}
