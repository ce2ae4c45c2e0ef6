//! Computes the numbers of the page on what hides a car.

use crate::page::Page;
use crate::rows::{Row, count, different, number, numbers_of, rows, visibility};
use paracosm::analysis::statistics::bootstrap_interval;
use std::fmt::Write;

const PAIRED: &[u8] = include_bytes!("../../data/conditions-paired.csv");
const PAIRS: &[u8] = include_bytes!("../../data/conditions-pairs.csv");
const GUILTY: &[u8] = include_bytes!("../../data/conditions-guilty.csv");
const SHRUNK: &[u8] = include_bytes!("../../data/conditions-shrunk.csv");
const RISK: &[u8] = include_bytes!("../../data/conditions-risk.csv");
const LENS: &str = "camera.front.focal_mm";

fn points(share: f64) -> String {
    // A value that rounds to zero has no sign.
    format!("{}", (100.0 * share).round() + 0.0)
}

/// The row of a detector at a value of a condition.
fn at<'a>(paired: &'a [Row], detector: &str, condition: &str, value: &str) -> &'a Row {
    let is_it = |row: &&Row| row["detector"] == detector && row["condition"] == condition && row["value"] == value;
    paired.iter().find(is_it).unwrap_or_else(|| panic!("no {detector} at {condition} {value}"))
}

fn paired_table(paired: &[Row]) -> String {
    let mut text = String::from(
        "| detector | recall in %, nominal | fog 0.3 (1.4 km) | light 0.05 | lens 14 mm | easiest |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    assert_eq!(visibility(0.3), "1.4 km");
    for detector in different(paired, "detector") {
        write!(text, "| `{detector}` | {} |", points(number(at(paired, detector, "fog", "0"), "recall"))).unwrap();
        for (condition, value) in [("fog", "0.3"), ("light", "0.05"), (LENS, "14")] {
            let row = at(paired, detector, condition, value);
            let [change, low, high] = ["difference", "low", "high"].map(|column| points(number(row, column)));
            write!(text, " {change} ({low} to {high}) |").unwrap();
        }
        let own = paired.iter().filter(|row| row["detector"] == detector);
        let easiest =
            own.reduce(|best, row| if number(row, "recall") > number(best, "recall") { row } else { best }).unwrap();
        let recall = points(number(easiest, "recall"));
        writeln!(text, " {recall} % with {} {} |", easiest["condition"], easiest["value"]).unwrap();
    }
    text
}

fn says_paired(page: &mut Page, paired: &[Row]) {
    let found = |detector: &str, condition: &str, value: &str| at(paired, detector, condition, value)["found"];
    let recall = |detector: &str, value: &str| points(number(at(paired, detector, LENS, value), "recall"));
    let cars = |condition: &str, value: &str| at(paired, "hog", condition, value)["cars"];
    page.says(format!(
        "The tests have {} cars in images, but {} at 14 mm, and {} at 42 and 50 mm",
        cars("fog", "0"),
        cars(LENS, "14"),
        cars(LENS, "42")
    ));
    assert_eq!(cars(LENS, "42"), cars(LENS, "50"));
    page.says(format!("Fog 0.3, a visibility of {}, hardly matters", visibility(0.3)));
    let [open, coco] = ["ssd-open-images", "ssd-coco"]
        .map(|name| format!("({} to {})", found(name, "fog", "0"), found(name, "fog", "0.3")));
    page.says(format!("nearly half of the finds of `ssd-open-images` {open}, and most finds of `ssd-coco` {coco}"));
    let centre = |light: &str| at(paired, "centernet-coco", "light", light);
    let is_harmed = |light: &str| number(centre(light), "high") < 0.0;
    assert!(is_harmed("0.05") && is_harmed("0.1") && !is_harmed("0.3"));
    assert!(number(centre("0.5"), "found") > number(centre("1"), "found"));
    page.says("`centernet-coco` is harmed from light 0.1 downwards, and finds more cars at light 0.5 than at light 1");
    for detector in ["ssd-coco", "centernet-coco", "ssd-open-images", "hog"] {
        assert!(number(at(paired, detector, "light", "0.05"), "high") < 0.0);
    }
    page.says("Light 0.05 harms the three pre-trained detectors and `hog`");
    page.says(format!(
        "From 42 to 50 mm, the recall of `ssd-open-images` falls from {} to {} %, and the recall of `ssd-coco` falls from {} to {} %",
        recall("ssd-open-images", "42"),
        recall("ssd-open-images", "50"),
        recall("ssd-coco", "42"),
        recall("ssd-coco", "50")
    ));
    let centre = ["28", "35"].map(|length| recall("centernet-coco", length));
    page.says(format!("From 28 to 35 mm, the recall of `centernet-coco` falls from {} to {} %", centre[0], centre[1]));
    let hog = |fog: &str| found("hog", "fog", fog);
    page.says(format!("At fog 0.3, `hog` finds {} cars instead of {}", hog("0.3"), hog("0")));
    let thinner = numbers_of(paired, "found", |row| {
        row["detector"] == "hog" && row["condition"] == "fog" && !["0", "0.3"].contains(&row["value"])
    });
    let [least, most] = crate::rows::range(thinner);
    page.says(format!(
        "in thinner fog, it finds {least} to {most}. The interval at 0.3 begins at {}",
        points(number(at(paired, "hog", "fog", "0.3"), "low"))
    ));
}

fn guilty_table(tests: &[Row], guilty: &[Row]) -> String {
    let mut text = String::from("| detector | failing tests | guilty values |\n| --- | --- | --- |\n");
    for detector in different(tests, "detector") {
        let all = count(tests, |row| row["detector"] == detector);
        let failing = count(tests, |row| row["detector"] == detector && row["verdict"] == "fail");
        let own = guilty.iter().filter(|row| row["detector"] == detector);
        let values: Vec<String> =
            own.map(|row| format!("{} ({})", row["values"].replace("; ", " and "), row["failures"])).collect();
        let values = if values.is_empty() { "none".to_owned() } else { values.join("; ") };
        writeln!(text, "| `{detector}` | {failing} of {all} | {values} |").unwrap();
    }
    text
}

/// For each detector, the values that are not nominal in the shrunk test that has the fewest of them.
fn shrunk_table(shrunk: &[Row], detectors: &[&str]) -> String {
    let mut text = String::from("| detector | values that are not nominal |\n| --- | --- |\n");
    for detector in detectors {
        let own: Vec<Row> = shrunk.iter().filter(|row| row["detector"] == *detector).cloned().collect();
        let left = |test: &str| -> Vec<&Row> {
            own.iter().filter(|row| row["test"] == test && row["nominal"] == "false").collect()
        };
        let tests = different(&own, "test");
        let least = tests.iter().map(|test| left(test)).min_by_key(Vec::len).unwrap();
        let values: Vec<String> =
            least.iter().map(|row| format!("{} {}", row["parameter"], short(row["after"]))).collect();
        let values =
            if values.is_empty() { "none: it misses a car at nominal values".to_owned() } else { values.join(", ") };
        writeln!(text, "| `{detector}` | {values} |").unwrap();
    }
    text
}

/// A number with at most three digits that count, or a word.
fn short(value: &str) -> String {
    let Ok(number) = value.parse::<f64>() else { return value.to_owned() };
    let digits = if number.abs() < 1.0 { 2 } else { 1 };
    let text = format!("{number:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn risk_table(tests: &[Row]) -> String {
    let mut text = String::from(
        "| detector | failing tests | missed encounters | probability in % |\n| --- | --- | --- | --- |\n",
    );
    for detector in different(tests, "detector") {
        let own: Vec<Row> = tests.iter().filter(|row| row["detector"] == detector).cloned().collect();
        let [encounters, missed] = ["encounters", "missed"].map(|column| numbers_of(&own, column, |_| true));
        let share = |drawn: &[usize]| {
            let sum = |values: &[f64]| drawn.iter().map(|test| values[*test]).sum::<f64>();
            sum(&missed) / sum(&encounters)
        };
        let all: Vec<usize> = (0..own.len()).collect();
        let [low, high] = bootstrap_interval(own.len(), share);
        let percent = |share: f64| format!("{:.1}", 100.0 * share);
        writeln!(
            text,
            "| `{detector}` | {} of {} | {} of {} | {} ({} to {}) |",
            count(&own, |row| row["verdict"] == "fail"),
            own.len(),
            missed.iter().sum::<f64>(),
            encounters.iter().sum::<f64>(),
            percent(share(&all)),
            percent(low),
            percent(high)
        )
        .unwrap();
    }
    text
}

#[test]
fn the_numbers_of_the_page_follow_from_its_tests() {
    let [paired, tests, guilty, shrunk, risk] = [PAIRED, PAIRS, GUILTY, SHRUNK, RISK].map(rows);
    let mut page = Page::open("conditions.md");
    page.table("paired", &paired_table(&paired));
    page.table("guilty", &guilty_table(&tests, &guilty));
    page.table("shrunk", &shrunk_table(&shrunk, &different(&tests, "detector")));
    page.table("risk", &risk_table(&risk));
    says_paired(&mut page, &paired);

    let size = count(&tests, |row| row["detector"] == "hog");
    page.says(format!("A covering array with {size} tests"));
    let all_fail = different(&tests, "detector")
        .into_iter()
        .filter(|name| count(&tests, |row| row["detector"] == *name && row["verdict"] == "fail") == size);
    assert_eq!(all_fail.count(), 3);
    page.says(format!("Three detectors fail all {size} tests"));

    let centre = |row: &Row| row["detector"] == "centernet-coco";
    let sum = |column: &str, of: &dyn Fn(&Row) -> bool| numbers_of(&risk, column, of).iter().sum::<f64>();
    let dense = |row: &Row| centre(row) && row["traffic"] == "8";
    page.says(format!(
        "{} of the {} encounters that `centernet-coco` misses are in tests with eight more cars, which have {} of the {} encounters",
        sum("missed", &dense),
        sum("missed", &centre),
        sum("encounters", &dense),
        sum("encounters", &centre)
    ));
    let missed = 100.0 * sum("missed", &centre) / sum("encounters", &centre);
    page.says(format!("the best detector of six, `centernet-coco`, never matches {missed:.0} % of the cars"));
    page.says(format!("{} tests take the 15 combinations", count(&risk, centre)));
    let rain =
        shrunk.iter().find(|row| centre(row) && row["parameter"] == "rain" && row["nominal"] == "false").unwrap();
    let same = |row: &&Row| centre(row) && row["test"] == rain["test"] && row["parameter"] == "sun_elevation";
    let sun = shrunk.iter().find(same).unwrap();
    page.says(format!("Rain {} and the sun at {}° hide a white car", short(rain["after"]), short(sun["after"])));
    page.says(format!(
        "fog 0, 0.06, 0.15 and 0.3 (a visibility of {}, {} and {})",
        visibility(0.06),
        visibility(0.15),
        visibility(0.3)
    ));
    page.says(format!("fog 0, 0.1, 0.2 ({} and {})", visibility(0.1), visibility(0.2)));
    page.says(format!("fog 0 to 0.2 (a visibility above {})", visibility(0.2)));
    let recalls = rows(include_bytes!("../../data/recall.csv"));
    let coco = number(recalls.iter().find(|row| row["detector"] == "ssd-coco").unwrap(), "threshold");
    page.says(format!("`ssd-coco` has {coco:.2}"));
    page.given(&[
        "for more than 0.5 s",
        "640 x 384 pixels",
        "focal length of 35 mm on a sensor of 36 mm",
        "All cars within 40 m that are visible to 75 %",
    ]);
    page.given(&[
        "at 0.1 false alarms an image",
        "the sun at 50° behind the car on its left",
        "car 20 m ahead",
        "fog 0, light 1 and 35 mm",
        "with intervals of 95 % from",
    ]);
    page.given(&["light 1, 0.3, 0.1 and 0.05; focal lengths of 14, 24, 35 and 50 mm", "is missed in fog 0.3 alone"]);
    page.given(&[
        "light 1, 0.5, 0.2; fog",
        "rain 0, 0.5, 1; elevation of the sun 50°, 20°, 5°; 0, 3 or 8 more cars",
        "focal lengths of 35, 24 and 50 mm. Up to 100 further",
    ]);
    page.given(&[
        "used its 100 further tests",
        "the car ahead is 20 m away",
        "with up to 40 runs each",
        "a gap of 8 to 30 m, light 0.2 to 1",
        "rain 0 to 1, an elevation of the sun of 5° to 60°, and a focal length of 24 to 50 mm",
    ]);
    page.given(&["The interval of 95 %", "a focal length of 24 mm and light of 0.6 to 1"]);
    page.close();
}
