//! Counts the near cars that detectors find by day: recall, false alarms and average precision by size, with frozen
//! thresholds.

use super::detectors::{ALARMS, Found, HOG, Named, OVERLAP, RESOLUTION, Vehicles, all, easy};
use super::{Failure, halton, still};
use crate::{Done, print, scenario, write};
use indicatif::ProgressBar;
use paracosm::analysis::statistics::bootstrap_interval;
use paracosm::campaign::gallery::Shown;
use paracosm::perception::{Areas, Criterion, Object, Rect, Tally, match_boxes};
use std::path::Path;

/// The scenes: five scenarios by day, with 100 images of each. A test gives ten images, evenly over its time, or all images
/// if it has fewer; there are more tests than ten because of these.
const SCENES: [&str; 5] = ["highway-traffic", "grid-traffic", "roundabout-entry", "ncap-ccr", "ncap-ccrb"];
const TESTS: usize = 15;
const IMAGES: usize = 10;
const OF_SCENE: usize = 100;
/// The seed of the tests; the lessons of our detectors have another.
const SEED: u64 = 2;
/// The least visible share of a car that counts.
const VISIBLE: f64 = 0.75;
/// The heights of cars, in pixels: all, and in four parts.
const SIZES: [(f64, f64); 5] = [(48.0, 300.0), (48.0, 75.0), (75.0, 120.0), (120.0, 190.0), (190.0, 300.0)];

/// The results of a detector for cars of a range of heights.
struct Recall {
    cars: usize,
    found: usize,
    interval: [f64; 2],
    precision: Option<f64>,
    false_alarms: usize,
}

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let (mut detectors, absent) = all()?;
    let easy = easy(bar)?;
    let tests = tests(bar)?;
    let images = tests.iter().map(Vec::len).sum::<usize>();
    let header = "detector,threshold,pixels_of,from,to,cars,found,recall,low,high,ap50,false_alarms";
    let mut table = vec![header.to_owned()];
    let mut text = format!("thresholds at {ALARMS} false alarms an image; {images} images of {} tests\n", tests.len());
    for detector in &mut detectors {
        let threshold = detector.freeze(&easy)?;
        let mut seen = Vec::new();
        for test in &tests {
            let answers = test.iter().map(|shown| Ok((shown, detector.find(shown.picture())?)));
            seen.push(answers.collect::<Result<Vec<_>, Failure>>()?);
        }
        let name = detector.name;
        if name == HOG {
            write(&out.join("recall-boxes.csv"), boxes(&seen, detector))?;
        }
        for (pixels_of, scale) in [("input", detector.scale()), ("image", 1.0)] {
            for (from, to) in SIZES {
                let Recall { cars, found, interval: [low, high], precision, false_alarms } =
                    recall(&seen, detector, (from / scale, to / scale), threshold);
                // There may be no car of these sizes.
                let shown = |share: f64| if cars == 0 { String::new() } else { format!("{share:.3}") };
                let share = found as f64 / cars as f64;
                let precision = precision.map_or(String::new(), |precision| format!("{precision:.3}"));
                table.push(format!(
                    "{name},{threshold:.4},{pixels_of},{from},{to},{cars},{found},{},{},{},\
                     {precision},{false_alarms}",
                    shown(share),
                    shown(low),
                    shown(high)
                ));
                if (from, to) == SIZES[0] {
                    text += &format!(
                        "{name:<18}{from} to {to} pixels of the {pixels_of}: {found} of {cars} cars, {:.0} % [{:.0}, {:.0}], \
                         AP50 {precision}, {false_alarms} false alarms\n",
                        100.0 * share,
                        100.0 * low,
                        100.0 * high
                    );
                }
            }
        }
    }
    for name in absent {
        text += &format!("{name:<18}absent: experiments/detectors/fetch.py fetches it\n");
    }
    bar.finish_and_clear();
    write(&out.join("recall.csv"), table.join("\n") + "\n")?;
    print(&text)
}

/// Returns the images of each test.
fn tests(bar: &ProgressBar) -> Result<Vec<Vec<Shown>>, Failure> {
    bar.set_length((SCENES.len() * TESTS) as u64);
    let mut tests = Vec::new();
    for name in SCENES {
        let study = scenario(name)?.driver("planner").build()?;
        let cameras = still(RESOLUTION, 24.0, 2.0);
        let mut left = OF_SCENE;
        for mut test in halton(&study, &cameras, (TESTS, SEED), bar, |shown| shown)?.into_iter().map(thinned) {
            test.truncate(left);
            left -= test.len();
            tests.push(test);
        }
        tests.retain(|test| !test.is_empty());
    }
    Ok(tests)
}

/// Returns the boxes of all cars and of all answers of a detector, so that another program can judge them. The score of a
/// car is the number of its pixels.
fn boxes(tests: &[Vec<(&Shown, Found)>], detector: &Named) -> String {
    let mut table = "image,kind,left,top,width,height,score,crowd\n".to_owned();
    for ((shown, found), image) in tests.iter().flatten().zip(1..) {
        let mut line = |kind: &str, Rect { left, top, width, height }: Rect, score: f64, crowd: bool| {
            let crowd = u8::from(crowd);
            table += &format!("{image},{kind},{left},{top},{width},{height},{score},{crowd}\n");
        };
        let vehicles = Vehicles::of(shown, detector.extent(), |user| user.kind == "car" && user.visible >= VISIBLE);
        vehicles.objects.iter().for_each(|object| line("car", object.rect, object.area, object.crowd));
        found.iter().for_each(|answer| line("answer", answer.rect, answer.score, false));
    }
    table
}

/// Returns ten images, evenly over the time.
fn thinned(test: Vec<Shown>) -> Vec<Shown> {
    let count = test.len();
    let chosen: Vec<usize> = (0..IMAGES).map(|i| i * count / IMAGES).collect();
    test.into_iter().enumerate().filter(|(i, _)| chosen.contains(i)).map(|(_, shown)| shown).collect()
}

/// Returns the results for cars of these heights, in pixels of the images.
fn recall(tests: &[Vec<(&Shown, Found)>], detector: &Named, (from, to): (f64, f64), threshold: f64) -> Recall {
    let has_size = |height: f64| (from..to).contains(&height);
    let (mut curve, mut counts) = (Tally::default(), Vec::new());
    for test in tests {
        let mut frozen = Tally::default();
        for (shown, found) in test {
            let vehicles = Vehicles::of(shown, detector.extent(), |user| {
                user.kind == "car" && user.visible >= VISIBLE && has_size(user.rect.height)
            });
            add(&mut curve, &vehicles.objects, found, has_size);
            let kept: Found = found.iter().filter(|one| one.score >= threshold).copied().collect();
            add(&mut frozen, &vehicles.objects, &kept, has_size);
        }
        counts.push((frozen.matches(), frozen.objects(), frozen.false_alarms()));
    }
    let (found, cars, false_alarms) =
        counts.iter().fold((0, 0, 0), |sum, count| (sum.0 + count.0, sum.1 + count.1, sum.2 + count.2));
    // Images of a test resemble each other, so tests are drawn, not images.
    let interval = bootstrap_interval(counts.len(), |drawn| {
        let (found, cars) = drawn.iter().fold((0, 0), |sum, test| (sum.0 + counts[*test].0, sum.1 + counts[*test].1));
        if cars == 0 { 0.0 } else { found as f64 / cars as f64 }
    });
    Recall { cars, found, interval, precision: curve.average_precision(), false_alarms }
}

/// Adds an image. Boxes of other heights without a car do not count, as COCO counts by size.
fn add(tally: &mut Tally, objects: &[Object], found: &Found, has_size: impl Fn(f64) -> bool) {
    let criterion = Criterion::Overlap(OVERLAP);
    let matching = match_boxes(objects, found, criterion, Areas::ALL);
    let pairs = matching.detections.iter().zip(&matching.objects);
    let counts = pairs.filter(|(place, object)| object.is_some() || has_size(found[**place].rect.height));
    let counting: Found = counts.map(|(place, _)| found[*place]).collect();
    tally.add(objects, &counting, criterion, Areas::ALL);
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_page_has_the_recall_of_the_table() {
        let page = include_str!("../../recall.md");
        let mut rows = 0;
        for row in include_str!("../../data/recall.csv").lines().skip(1) {
            let fields: Vec<&str> = row.split(',').collect();
            let [name, threshold, of, from, to, cars, found, _, low, high, precision, alarms] = fields[..] else {
                panic!("{row}")
            };
            if (from, to) != ("48", "300") {
                continue;
            }
            let percent = |share: &str| format!("{:.0}", 100.0 * share.parse::<f64>().unwrap());
            // The column `recall` is rounded, so its percentage would be rounded twice.
            let recall = 100.0 * found.parse::<f64>().unwrap() / cars.parse::<f64>().unwrap();
            let threshold = threshold.parse::<f64>().unwrap();
            let line = format!(
                "| `{name}` | {of} | {threshold:.2} | {found} of {cars} | {recall:.0} ({} to {}) | {precision} | {alarms} |",
                percent(low),
                percent(high)
            );
            assert!(page.contains(&line), "expected on the page: {line}");
            rows += 1;
        }
        assert_eq!(rows, 12);
    }
}
