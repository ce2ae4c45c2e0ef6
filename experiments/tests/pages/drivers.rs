//! Checks the page of all drivers: its tables say what the CSV says, and every large number has a reason.
//!
//! With UPDATE_GOLDEN=1, the tables of the page are written again from the CSV. The reasons of the page stay.

use paracosm::engine::driver;
use paracosm::oracles::Verdict;
use paracosm::{Campaign, Study};
use std::collections::BTreeMap;
use std::env;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A cell with more failures than this, of 200 tests, needs a reason: 5 %.
const MOST: usize = 10;
/// The scenarios that `planner` has to take: at most 4 tests do not pass, at most 2 of them fail.
const TAKEN: [&str; 5] = ["grid-traffic", "roundabout-entry", "t-loop", "follow-leader", "highway-traffic"];
/// The reason of a cell that nobody has explained yet.
const UNEXPLAINED: &str = "?";

/// The counts of a driver in a scenario.
struct Cell {
    driver: String,
    scenario: String,
    pass: usize,
    fail: usize,
    inconclusive: usize,
    invalid: usize,
    error: usize,
    /// The failing tests that another driver passes.
    preventable: usize,
    /// The violated requirements, each with the number of tests.
    violated: String,
}

fn cells() -> Vec<Cell> {
    let cell = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [driver, scenario, counts @ .., violated] = &fields[..] else { panic!("{line}") };
        let counts: Vec<usize> = counts.iter().map(|count| count.parse().unwrap()).collect();
        let [pass, fail, inconclusive, invalid, error, preventable] = counts[..] else { panic!("{line}") };
        let (driver, scenario, violated) = ((*driver).into(), (*scenario).into(), (*violated).into());
        Cell { driver, scenario, pass, fail, inconclusive, invalid, error, preventable, violated }
    };
    include_str!("../../data/drivers.csv").lines().skip(1).map(cell).collect()
}

/// Returns the different names of cells, in the order of the cells.
fn names(cells: &[Cell], name: fn(&Cell) -> &str) -> Vec<&str> {
    let mut names = Vec::new();
    for cell in cells {
        if !names.contains(&name(cell)) {
            names.push(name(cell));
        }
    }
    names
}

/// Returns the table of failures: a row for each scenario, a column for each driver.
fn overview(cells: &[Cell]) -> String {
    let drivers = names(cells, |cell| &cell.driver);
    let head = drivers.iter().map(|driver| format!(" `{driver}` |")).collect::<String>();
    let mut table = format!("| scenario | invalid |{head}\n| --- | --- |{}\n", " --- |".repeat(drivers.len()));
    for scenario in names(cells, |cell| &cell.scenario) {
        let row: Vec<&Cell> = cells.iter().filter(|cell| cell.scenario == scenario).collect();
        let invalid = row.iter().map(|cell| cell.invalid).max().unwrap();
        write!(table, "| `{scenario}` | {invalid} |").unwrap();
        for driver in &drivers {
            let cell = row.iter().find(|cell| cell.driver == *driver).unwrap();
            let open = cell.inconclusive + cell.error;
            let open = if open > 0 { format!(" ({open})") } else { String::new() };
            write!(table, " {}{open} |", cell.fail).unwrap();
        }
        table.push('\n');
    }
    table
}

const REASONS: &str =
    "| scenario | driver | failures | violated | preventable | reason |\n| --- | --- | --- | --- | --- | --- |\n";

/// Returns the table of reasons, for every cell with many failures.
fn reasons(cells: &[Cell], known: &BTreeMap<(String, String), String>) -> String {
    let rows = cells.iter().filter(|cell| cell.fail > MOST).map(|cell| {
        let Cell { driver, scenario, fail, preventable, violated, .. } = cell;
        let reason = known.get(&(scenario.clone(), driver.clone())).map_or(UNEXPLAINED, String::as_str);
        format!("| `{scenario}` | `{driver}` | {fail} | {violated} | {preventable} | {reason} |\n")
    });
    REASONS.to_owned() + &rows.collect::<String>()
}

/// Returns the reasons on the page, by scenario and driver.
fn known(page: &str) -> BTreeMap<(String, String), String> {
    let rows = page.split(REASONS).nth(1).unwrap_or_default().lines().take_while(|line| line.starts_with('|'));
    rows.map(|row| {
        let fields: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let name = |field: &str| field.trim_matches('`').to_owned();
        ((name(fields[0]), name(fields[1])), fields[5].to_owned())
    })
    .collect()
}

/// Puts a table in the place of the table on the page that has the same first column.
fn with_table(page: &str, table: &str) -> String {
    let begins = table.lines().next().unwrap().split('|').take(3).collect::<Vec<_>>().join("|");
    let from = page.find(&begins).unwrap_or_else(|| panic!("the page has no table that begins with `{begins}`"));
    let end = page[from..].find("\n\n").map_or(page.len(), |end| from + end + 1);
    format!("{}{table}{}", &page[..from], &page[end..])
}

#[test]
fn the_tables_of_the_page_are_those_of_the_csv_and_every_large_number_has_a_reason() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("drivers.md");
    let page = fs::read_to_string(&path).unwrap();
    let cells = cells();
    let reasons = reasons(&cells, &known(&page));
    let expected = with_table(&with_table(&page, &overview(&cells)), &reasons);
    if env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&path, &expected).unwrap();
    } else {
        assert_eq!(page, expected, "run this test with UPDATE_GOLDEN=1 to write the tables again");
    }
    let open = reasons.lines().filter(|row| row.ends_with(&format!("| {UNEXPLAINED} |"))).collect::<Vec<_>>();
    assert!(open.is_empty(), "no reason for\n{}", open.join("\n"));
}

#[test]
fn every_driver_drives_every_scenario_and_the_counts_add_up() {
    let cells = cells();
    // The images of a driver with a camera would take hours, and the driver `default` leaves the car to the scenario.
    let is_tested = |driver: &driver::Descriptor| {
        let mut built = driver.build(&[]).unwrap();
        built.takes_over() && built.equipment().cameras.all.is_empty()
    };
    let drivers = driver::ALL.iter().filter(|driver| is_tested(driver));
    let drivers: Vec<&str> = drivers.map(|driver| driver.name).collect();
    let scenarios: Vec<&str> = paracosm::scenarios::ALL.iter().map(|program| program.name()).collect();
    assert_eq!(names(&cells, |cell| &cell.driver), drivers);
    assert_eq!(names(&cells, |cell| &cell.scenario), scenarios);
    assert_eq!(cells.len(), drivers.len() * scenarios.len());
    for Cell { driver, scenario, pass, fail, inconclusive, invalid, error, preventable, .. } in &cells {
        assert_eq!(pass + fail + inconclusive + invalid + error, 200, "{driver} in {scenario}");
        assert!(preventable <= fail && *error == 0, "{driver} in {scenario}");
    }
}

#[test]
fn the_planner_of_today_has_the_counts_of_the_csv_where_it_must_not_fail() {
    let cells = cells();
    let catalogue = paracosm::catalogue();
    for scenario in TAKEN {
        let cell = cells.iter().find(|cell| cell.driver == "planner" && cell.scenario == scenario).unwrap();
        let study = Study::of(catalogue.find(scenario).unwrap()).driver("planner").budget(200).build().unwrap();
        let log = Campaign::new(&study).unwrap().into_log().unwrap();
        let count = |verdict| log.trials().iter().filter(|trial| trial.verdict == verdict).count();
        let found = [Verdict::Pass, Verdict::Fail, Verdict::Invalid].map(count);
        assert_eq!(found, [cell.pass, cell.fail, cell.invalid], "{scenario}: passes, failures, invalid tests");
    }
}

#[test]
fn the_planner_takes_junctions_and_roundabouts() {
    let cells = cells();
    for scenario in TAKEN {
        let cell = cells.iter().find(|cell| cell.driver == "planner" && cell.scenario == scenario).unwrap();
        assert!(cell.pass >= 196 && cell.fail <= 2, "{scenario}: {} pass, {} fail", cell.pass, cell.fail);
    }
}
