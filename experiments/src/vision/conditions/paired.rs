//! Renders of the same tests in more and more fog, in less and less light, and with other lenses.

use super::super::{sheet, varied};
use super::world::{COLOURS, PROGRAM, TRAFFIC};
use super::{FOCAL_MM, Failure, Findings, LENS, Named, RESOLUTION, counted, numbers, study, words};
use paracosm::analysis::statistics::bootstrap_interval;
use paracosm::campaign::gallery::Gallery;
use paracosm::generators::{Request, Strategy};
use paracosm::space::{Domain, Parameter, Space, Value, Values};
use paracosm::{Campaign, Study};

/// The number of tests that are rendered under each condition.
const WORLDS: usize = 12;
/// The number of images in a second.
const RENDERS: f64 = 1.0;

/// The conditions with their values. The first value is the usual one.
const CONDITIONS: [(&str, &[f64]); 3] = [
    ("fog", &[0.0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3]),
    ("light", &[1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05]),
    (LENS, &[FOCAL_MM, 14.0, 18.0, 24.0, 28.0, 42.0, 50.0]),
];

/// The conditions of the sheet of images: fog, light and lens.
const SHEET: [[f64; 4]; 3] = [[0.0, 0.06, 0.15, 0.3], [1.0, 0.3, 0.1, 0.05], [14.0, 24.0, FOCAL_MM, 50.0]];
/// The test and the time in seconds of the images of the sheet.
const SHEET_WORLD: usize = 4;
const SHEET_TIME: f64 = 1.0;

/// The counts of a test: cars that should be detected, and found cars.
type Counts = [f64; 2];

/// Renders all tests under all conditions, and counts the found cars.
pub fn of(detector: &Named, threshold: f64) -> Result<Findings, Failure> {
    let worlds = worlds()?;
    let [fog, light, lens] = CONDITIONS.map(|(_, values)| numbers(values));
    let of_world = worlds.1.parameters().iter().map(|parameter| (parameter.name.as_str(), parameter.domain.clone()));
    let open: Vec<(&str, Domain)> = of_world.chain([("fog", fog), ("light", light)]).collect();
    let study = study(detector, threshold, &open, lens, RENDERS)?.build()?;
    let campaign = Campaign::new(&study)?;
    let mut rows = Vec::new();
    let mut text = String::new();
    for (condition, values) in CONDITIONS {
        let mut curve = Vec::new();
        let tests: Vec<Values> =
            values.iter().flat_map(|value| worlds.0.iter().map(|world| rendered(world, condition, *value))).collect();
        let mut counts: Vec<Counts> = Vec::new();
        campaign.run_tests(&tests, 0, |trial| {
            counts.push(["objects", "matches"].map(|name| counted(trial, name)));
            Ok(())
        })?;
        let usual = &counts[..WORLDS];
        for (value, counts) in values.iter().zip(counts.chunks(WORLDS)) {
            let difference = |drawn: &[usize]| recall(counts, drawn) - recall(usual, drawn);
            let [low, high] = bootstrap_interval(WORLDS, difference);
            let all: Vec<usize> = (0..WORLDS).collect();
            let [vehicles, found] = summed(counts, &all);
            curve.push((*value, recall(counts, &all)));
            rows.push(format!(
                "{},{condition},{value},{vehicles},{found},{:.3},{:.3},{low:.3},{high:.3}",
                detector.name,
                recall(counts, &all),
                difference(&all)
            ));
        }
        curve.sort_by(|a: &(f64, f64), b| a.0.total_cmp(&b.0));
        let points: Vec<String> = curve.iter().map(|(value, recall)| format!("{value}: {recall:.2}")).collect();
        text += &format!("  recall over {condition}: {}\n", points.join(", "));
    }
    let columns = "detector,condition,value,cars,found,recall,difference,low,high".to_owned();
    Ok(Findings { parts: vec![("conditions-paired.csv", columns, rows)], text })
}

/// Returns images of one test at one time under all conditions, with the answers of a detector.
pub fn sheet(detector: &mut Named, threshold: f64) -> Result<Vec<u8>, Failure> {
    let (worlds, _) = worlds()?;
    let [fog, light, lens] = SHEET.map(|values| numbers(&values));
    let cameras = varied(RESOLUTION, lens, FOCAL_MM, RENDERS)?;
    let study = Study::of(PROGRAM).driver("planner").open_over("fog", fog).open_over("light", light);
    let study = study.open("gap").open("traffic").open("colour").open_cameras(&cameras).build()?;
    let mut gallery = Gallery::new(&study, cameras)?;
    let mut rows = Vec::new();
    for ((condition, _), values) in CONDITIONS.into_iter().zip(SHEET) {
        let mut row = Vec::new();
        for value in values {
            let all = gallery.show(&rendered(&worlds[SHEET_WORLD], condition, value))?;
            let shown = all.iter().find(|shown| shown.time() >= SHEET_TIME).ok_or("a test without images")?;
            let (vehicles, found) = detector.see(shown)?;
            row.push(sheet::halved(&sheet::answered(shown, &vehicles, &found, threshold)));
        }
        rows.push(row);
    }
    sheet::png(&rows)
}

/// Returns the tests, and the space of the parameters that are the same under all conditions.
fn worlds() -> Result<(Vec<Values>, Space), Failure> {
    let parameters = vec![
        Parameter::new("gap", Domain::Interval { lo: 8.0, hi: 30.0 }),
        Parameter::new("traffic", numbers(&TRAFFIC)),
        Parameter::new("colour", words(&COLOURS)),
    ];
    let space = Space::new(parameters)?;
    let request = Request { seed: Some(3), ..Request::new(&space, WORLDS) };
    let points = Strategy::HALTON.build(&request)?.ask(WORLDS);
    Ok((points.iter().map(|point| space.decode(point)).collect(), space))
}

/// Returns a test under one condition. The other conditions are the usual ones.
fn rendered(world: &Values, condition: &str, value: f64) -> Values {
    let usual = CONDITIONS.map(|(name, values)| (name, if name == condition { value } else { values[0] }));
    let conditions = usual.map(|(name, value)| (name.to_owned(), Value::Number(value)));
    world.iter().map(|(name, value)| (name.to_owned(), value.clone())).chain(conditions).collect()
}

fn summed(counts: &[Counts], drawn: &[usize]) -> Counts {
    drawn.iter().fold([0.0; 2], |sum, world| [sum[0] + counts[*world][0], sum[1] + counts[*world][1]])
}

fn recall(counts: &[Counts], drawn: &[usize]) -> f64 {
    let [vehicles, found] = summed(counts, drawn);
    if vehicles == 0.0 { 0.0 } else { found / vehicles }
}
