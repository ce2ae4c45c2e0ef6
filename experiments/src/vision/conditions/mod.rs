//! The conditions that hide a car from detectors: pairs of light, fog, rain, sun, lens, traffic and colour; a small
//! change that hides a car; the probability to miss a car; and renders of the same tests in fog, in the dark and through
//! other lenses.

mod paired;
mod pairs;
mod risk;
mod world;

use super::detectors::{ALARMS, Named, RESOLUTION, all, easy};
use super::{Failure, LENS, varied};
use crate::{Done, print, write};
use indicatif::ProgressBar;
use paracosm::campaign::Metric;
use paracosm::space::{Domain, Parameter, Value, Values};
use paracosm::{Study, StudyBuilder, Trial};
use std::collections::BTreeMap;
use std::path::Path;

/// The usual focal length in millimetres.
const FOCAL_MM: f64 = 35.0;
/// The usual number of images in a second.
const RATE: f64 = 4.0;

/// The detector whose answers are drawn on the sheet of images. If it is absent, the first detector takes its place.
const SHOWN: &str = "centernet-coco";

/// A part of a table: the name of the file, the columns, and the rows of a detector.
type Part = (&'static str, String, Vec<String>);

/// The findings of a part of the study about a detector.
struct Findings {
    parts: Vec<Part>,
    /// The findings in words.
    text: String,
}

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let (mut detectors, absent) = all()?;
    let easy = easy(bar)?;
    let mut text = format!("thresholds at {ALARMS} false alarms an image of {} images of easy scenes\n", easy.len());
    let (mut tables, mut sheet) = (BTreeMap::<&str, Vec<String>>::new(), None);
    bar.reset();
    bar.set_length(3 * detectors.len() as u64);
    for detector in &mut detectors {
        let threshold = detector.freeze(&easy)?;
        let name = detector.name;
        text += &format!("{name} at {threshold:.2}\n");
        let mut add = |Findings { parts, text: more }: Findings| {
            for (file, columns, rows) in parts {
                tables.entry(file).or_insert_with(|| vec![columns]).extend(rows);
            }
            text += &more;
            bar.inc(1);
        };
        add(pairs::of(detector, threshold)?);
        add(risk::of(detector, threshold)?);
        add(paired::of(detector, threshold)?);
        if name == SHOWN || sheet.is_none() {
            sheet = Some(paired::sheet(detector, threshold)?);
        }
    }
    for name in absent {
        text += &format!("{name:<18}absent: experiments/detectors/fetch.py fetches it\n");
    }
    bar.finish_and_clear();
    sheet.map_or(Ok(()), |sheet| write(&out.join("conditions-images.png"), sheet))?;
    for (file, rows) in &tables {
        write(&out.join(file), rows.join("\n") + "\n")?;
    }
    print(&text)
}

/// Begins a study of the world with a detector on trial. The tests vary these parameters and the focal length.
fn study(
    detector: &Named,
    threshold: f64,
    open: &[(&str, Domain)],
    lens: Domain,
    rate: f64,
) -> Result<StudyBuilder, Failure> {
    let cameras = varied(RESOLUTION, lens, FOCAL_MM, rate)?;
    let study = Study::of(world::PROGRAM).driver("planner");
    let study = open.iter().fold(study, |study, (name, domain)| study.open_over(name, domain.clone()));
    Ok(study.own_perceiver(detector.name, cameras, detector.frozen(threshold)))
}

/// Returns a count of the perceiver in a test.
fn counted(trial: &Trial, name: &str) -> f64 {
    let name = format!("perception.{name}");
    let metric = trial.metrics().into_iter().find(|(of, _)| *of == name);
    if let Some((_, Metric::Number(number))) = metric { number } else { 0.0 }
}

/// Returns the domain of some numbers.
fn numbers(levels: &[f64]) -> Domain {
    Domain::Choice(levels.iter().copied().map(Value::Number).collect())
}

/// Returns the domain of some words.
fn words(levels: &[&str]) -> Domain {
    Domain::Choice(levels.iter().copied().map(Value::from).collect())
}

/// Returns the names of the parameters, as columns of a table.
fn columns(parameters: &[Parameter]) -> String {
    parameters.iter().map(|parameter| parameter.name.as_str()).collect::<Vec<_>>().join(",")
}

/// Returns the values of a test in the order of the parameters, as fields of a row.
fn fields(parameters: &[Parameter], test: &Values) -> String {
    let field = |parameter: &Parameter| test.get(&parameter.name).map(ToString::to_string).unwrap_or_default();
    parameters.iter().map(field).collect::<Vec<_>>().join(",")
}
