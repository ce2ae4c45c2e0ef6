//! The paper's Figures 5 and 6: networks that mark the road were taught at one focal length, and see images of other
//! lengths.
//!
//! One scene is filmed at 21 focal lengths from 10 to 50 mm; only the focal length changes. As in the paper, a true
//! positive is a pixel of the road that is recognised, in percent of the road, and a false positive is another pixel that
//! is taken for road, in percent of the rest. The paper has one network; here five networks were taught with different
//! seeds, and five more with all focal lengths, to see whether that mends it.

use super::road::{COURSES, RESOLUTION, SEEDS};
use super::sheet::{enlarged, mark, pixels, png};
use super::{Failure, LENS, cameras};
use crate::{Done, print, scenario, write};
use indicatif::ProgressBar;
use paracosm::campaign::Metric;
use paracosm::campaign::gallery::Gallery;
use paracosm::perception::{Perceiver, Percept, Segmenter};
use paracosm::space::{Value, Values};
use paracosm::{Campaign, Study, StudyBuilder, Trial};
use paracosm_neural::vision::learn::Goal;
use paracosm_neural::vision::{Description, Vision};
use std::path::Path;

/// The networks, by course and seed. `train-road` made them.
const NETWORKS: [[&[u8]; 5]; 2] = [
    [
        include_bytes!("../../networks/road-one-length-1.onnx"),
        include_bytes!("../../networks/road-one-length-2.onnx"),
        include_bytes!("../../networks/road-one-length-3.onnx"),
        include_bytes!("../../networks/road-one-length-4.onnx"),
        include_bytes!("../../networks/road-one-length-5.onnx"),
    ],
    [
        include_bytes!("../../networks/road-all-lengths-1.onnx"),
        include_bytes!("../../networks/road-all-lengths-2.onnx"),
        include_bytes!("../../networks/road-all-lengths-3.onnx"),
        include_bytes!("../../networks/road-all-lengths-4.onnx"),
        include_bytes!("../../networks/road-all-lengths-5.onnx"),
    ],
];

/// The focal lengths in millimetres: the shortest, the distance between neighbours, and the number of lengths.
const LENGTHS: (f64, f64, usize) = (10.0, 2.0, 21);

/// The share of pixels at a focal length: of the road that is recognised, of the rest that is taken for road, and the
/// intersection over union.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Shares {
    true_positives: f64,
    false_positives: f64,
    overlap: f64,
}

fn lengths() -> impl Iterator<Item = f64> {
    let (first, step, count) = LENGTHS;
    (0..count).map(move |i| first + step * i as f64)
}

/// Begins a study of the scene.
fn scene() -> Result<StudyBuilder, Failure> {
    Ok(scenario("highway-traffic")?.fix("truck_delay", 8.0).fix("truck_speed", 8.0))
}

fn description() -> Result<Description, Failure> {
    Ok(Description::parse(&Goal::Road.description(RESOLUTION))?)
}

/// Returns the study of a network: the scene, seen at focal lengths from 10 to 50 mm.
fn study(network: &'static [u8]) -> Result<Study, Failure> {
    let lengths = (LENGTHS.0, LENGTHS.0 + LENGTHS.1 * (LENGTHS.2 - 1) as f64);
    let vision = Vision::read(network, description()?)?;
    let study = scene()?.own_perceiver("road", cameras(RESOLUTION, lengths)?, move || Box::new(vision.clone()));
    Ok(study.spec("always (perception.overlap >= 0.9)").build()?)
}

/// Returns the test at a focal length.
fn at(length: f64) -> Values {
    [(LENS.to_owned(), Value::Number(length))].into_iter().collect()
}

/// Returns the shares of a network at each focal length.
fn shares(network: &'static [u8], bar: &ProgressBar) -> Result<Vec<Shares>, Failure> {
    let study = study(network)?;
    let mut found = Vec::new();
    Campaign::new(&study)?.run_tests(&lengths().map(at).collect::<Vec<_>>(), 0, |trial| {
        bar.inc(1);
        found.push(of_trial(trial));
        Ok(())
    })?;
    found.into_iter().collect()
}

fn of_trial(trial: &Trial) -> Result<Shares, Failure> {
    let metrics = trial.metrics();
    let number = |name: &str| {
        let found = metrics.iter().find(|(known, _)| known.strip_prefix("perception.") == Some(name));
        match found {
            Some((_, Metric::Number(number))) => Ok(*number),
            _ => Err(format!("test {} has no `{name}`: {}", trial.index, trial.error().unwrap_or_default())),
        }
    };
    let [both, answered, missed, neither] =
        ["true_positives", "false_positives", "false_negatives", "true_negatives"].map(number);
    let (both, answered, missed, neither) = (both?, answered?, missed?, neither?);
    Ok(Shares {
        true_positives: both / (both + missed),
        false_positives: answered / (answered + neither),
        overlap: both / (both + answered + missed),
    })
}

/// The focal lengths of the sheet of images, and the moment of the scene in seconds.
const SAMPLES: [f64; 4] = [10.0, 20.0, 34.0, 50.0];
const MOMENT: f64 = 9.0;

/// Returns the sheet of images, in a row for each focal length: the image, and the answers of the first network of each
/// course.
fn samples() -> Result<Vec<u8>, Failure> {
    let mut networks = Vec::new();
    for course in NETWORKS {
        networks.push(Vision::read(course[0], description()?)?);
    }
    let cameras = cameras(RESOLUTION, (SAMPLES[0], SAMPLES[SAMPLES.len() - 1]))?;
    let study = scene()?.open_cameras(&cameras).driver("planner").build()?;
    let mut gallery = Gallery::new(&study, cameras)?;
    let mut rows = Vec::new();
    for length in SAMPLES {
        let shown = gallery.show(&at(length))?;
        let shown = shown.into_iter().find(|shown| shown.time() >= MOMENT).ok_or("the run ends before the moment")?;
        let picture = shown.picture();
        let truth = shown.mask(&Segmenter::default().is);
        let mut row = vec![enlarged(&pixels(&picture), 2)];
        for network in &mut networks {
            let Percept::Mask(answer) = network.perceive(&[picture])?.remove(0) else { continue };
            let mut image = pixels(&picture);
            mark(&mut image, &answer, &truth);
            row.push(enlarged(&image, 2));
        }
        rows.push(row);
    }
    png(&rows)
}

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    bar.set_length((COURSES.len() * SEEDS.len() * LENGTHS.2) as u64);
    let mut table = vec!["course,seed,focal_mm,true_positives,false_positives,overlap".to_owned()];
    for (course, networks) in COURSES.into_iter().zip(NETWORKS) {
        for (seed, network) in SEEDS.into_iter().zip(networks) {
            let found = shares(network, bar)?;
            for (length, Shares { true_positives, false_positives, overlap }) in lengths().zip(&found) {
                let name = course.name;
                table.push(format!("{name},{seed},{length},{true_positives:.4},{false_positives:.4},{overlap:.4}"));
            }
        }
    }
    bar.finish_and_clear();
    write(&out.join("fig5.png"), samples()?)?;
    write(&out.join("fig6.csv"), table.join("\n") + "\n")?;
    print(&(table.join("\n") + "\n"))
}

#[cfg(test)]
mod tests {
    use super::super::road::TAUGHT;
    use super::*;

    /// Returns the shares of the networks of a course at a focal length, by the table.
    fn of_table(course: &str, length: f64) -> Vec<Shares> {
        let rows = include_str!("../../data/fig6.csv").lines().skip(1).map(|row| row.split(',').collect::<Vec<_>>());
        let chosen = rows.filter(|row| row[0] == course && row[2].parse() == Ok(length));
        let shares = chosen.map(|row| {
            let [true_positives, false_positives, overlap] = [3, 4, 5].map(|column| row[column].parse().unwrap());
            Shares { true_positives, false_positives, overlap }
        });
        shares.collect()
    }

    #[test]
    fn a_network_has_the_row_of_the_table_when_it_is_tested_again() {
        let study = study(NETWORKS[0][0]).unwrap();
        let mut again = None;
        Campaign::new(&study)
            .unwrap()
            .run_tests(&[at(TAUGHT)], 0, |trial| {
                again = Some(of_trial(trial));
                Ok(())
            })
            .unwrap();
        let (again, table) = (again.unwrap().unwrap(), of_table(COURSES[0].name, TAUGHT)[0]);
        let off = [
            again.true_positives - table.true_positives,
            again.false_positives - table.false_positives,
            again.overlap - table.overlap,
        ];
        assert!(off.iter().all(|off| off.abs() < 2e-4), "{again:?}, {table:?}");
        assert!(again.overlap >= 0.95, "{again:?}");
    }
}
