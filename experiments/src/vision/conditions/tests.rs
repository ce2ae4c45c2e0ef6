//! The page has the numbers of its tables.

use super::super::detectors::{HOG, NAMES, SINGLE_SHOTS};
use paracosm::analysis::statistics::bootstrap_interval;

const PAGE: &str = include_str!("../../../conditions.md");

/// The rows of a table for a detector, as fields.
fn rows(table: &'static str, name: &str) -> Vec<Vec<&'static str>> {
    let fields = table.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    fields.filter(|fields| fields[0] == name).collect()
}

fn detectors() -> impl Iterator<Item = &'static str> {
    NAMES.into_iter().chain(SINGLE_SHOTS.into_iter().map(|network| network.name)).chain([HOG])
}

fn number(field: &str) -> f64 {
    field.parse().unwrap_or_else(|_| panic!("{field} is no number"))
}

fn expect(row: &str) {
    assert!(PAGE.contains(row), "expected on the page: {row}");
}

#[test]
fn the_page_has_the_failing_tests_and_the_guilty_values_of_the_covering_array() {
    for name in detectors() {
        let tests = rows(include_str!("../../../data/conditions-pairs.csv"), name);
        let failing = tests.iter().filter(|fields| fields[9] == "fail").count();
        let guilty = rows(include_str!("../../../data/conditions-guilty.csv"), name);
        let values: Vec<String> =
            guilty.iter().map(|fields| format!("{} ({})", fields[1].replace("; ", " and "), fields[2])).collect();
        let values = if values.is_empty() { "none".to_owned() } else { values.join("; ") };
        expect(&format!("| `{name}` | {failing} of {} | {values} |", tests.len()));
    }
}

#[test]
fn the_page_has_the_probabilities_to_miss_a_car() {
    for name in detectors() {
        let tests = rows(include_str!("../../../data/conditions-risk.csv"), name);
        let counts: Vec<[f64; 2]> = tests.iter().map(|fields| [number(fields[12]), number(fields[11])]).collect();
        let share = |drawn: &[usize]| {
            let [missed, all] =
                drawn.iter().fold([0.0; 2], |[missed, all], test| [missed + counts[*test][0], all + counts[*test][1]]);
            missed / all
        };
        let all: Vec<usize> = (0..counts.len()).collect();
        let [low, high] = bootstrap_interval(counts.len(), share);
        let [missed, met] = [0, 1].map(|place| counts.iter().map(|count| count[place]).sum::<f64>());
        let failing = tests.iter().filter(|fields| fields[10] == "fail").count();
        let percent = |share: f64| format!("{:.1}", 100.0 * share);
        expect(&format!(
            "| `{name}` | {failing} of {} | {missed} of {met} | {} ({} to {}) |",
            tests.len(),
            percent(share(&all)),
            percent(low),
            percent(high)
        ));
    }
}

#[test]
fn the_page_has_the_smallest_changes_that_hide_a_car() {
    for name in detectors() {
        let changes = rows(include_str!("../../../data/conditions-shrunk.csv"), name);
        let needed: Vec<String> = changes
            .iter()
            .filter(|fields| fields[5] == "false")
            .map(|fields| format!("{} {}", fields[2], fields[4]))
            .collect();
        let needed =
            if needed.is_empty() { "none: it misses a car at nominal values".to_owned() } else { needed.join(", ") };
        expect(&format!("| `{name}` | {needed} |"));
    }
}

#[test]
fn the_page_has_the_recall_under_each_condition() {
    for name in detectors() {
        let tests = rows(include_str!("../../../data/conditions-paired.csv"), name);
        let recall = |condition: &str, value: &str| {
            let row = tests.iter().find(|fields| fields[1] == condition && fields[2] == value);
            row.unwrap_or_else(|| panic!("{name} has no {condition} {value}"))
        };
        let change = |condition: &str, value: &str| {
            let fields = recall(condition, value);
            let percent = |field: &str| format!("{:.0}", 100.0 * number(field));
            format!("{} ({} to {})", percent(fields[6]), percent(fields[7]), percent(fields[8]))
        };
        let of = |fields: &[&str]| format!("{:.0}", 100.0 * number(fields[4]) / number(fields[3]));
        let best = tests
            .iter()
            .max_by(|a, b| number(a[5]).total_cmp(&number(b[5])).then_with(|| b[2].cmp(a[2])))
            .expect("rows");
        expect(&format!(
            "| `{name}` | {} | {} | {} | {} | {} % with {} {} |",
            of(recall("fog", "0")),
            change("fog", "0.3"),
            change("light", "0.05"),
            change("camera.front.focal_mm", "14"),
            of(best),
            best[1],
            best[2]
        ));
    }
}
