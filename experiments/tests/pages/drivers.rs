//! Checks the page of all drivers: its tables say what the CSV says, every large number has a reason, and every number of a reason is
//! accounted for.
//!
//! With UPDATE_GOLDEN=1, the tables of the page are written again from the CSV. The reasons of the page stay.

use crate::page::Page;
use crate::rows::{Row, number, range, rows};
use paracosm::engine::driver;
use paracosm::oracles::Verdict;
use paracosm::{Campaign, Study};
use std::collections::{BTreeMap, BTreeSet};
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
    if page == expected {
        account_for_the_numbers(&cells);
    }
    let open = reasons.lines().filter(|row| row.ends_with(&format!("| {UNEXPLAINED} |"))).collect::<Vec<_>>();
    assert!(open.is_empty(), "no reason for\n{}", open.join("\n"));
}

/// The tests of a driver in a scenario that end with a verdict, from the study of the reasons.
fn tests_of(all: &[Row], scenario: &str, driver: &str, setting: &str, verdict: &str) -> Vec<Row> {
    let own = |row: &&Row| {
        [row["scenario"], row["driver"], row["setting"], row["verdict"]] == [scenario, driver, setting, verdict]
    };
    all.iter().filter(own).cloned().collect()
}

/// Returns the value of a parameter in a test.
fn value(row: &Row, name: &str) -> f64 {
    let mut cells = row["values"].split(' ').filter_map(|cell| cell.split_once('='));
    cells.find(|cell| cell.0 == name).unwrap().1.parse().unwrap()
}

/// Returns the least and the greatest value of a parameter in some tests.
fn values(tests: &[Row], name: &str) -> [f64; 2] {
    range(tests.iter().map(|row| value(row, name)))
}

/// Checks that every number of the page is computed from a file, or given.
fn account_for_the_numbers(cells: &[Cell]) {
    let all = rows(include_bytes!("../../data/drivers-reasons.csv.gz"));
    let trucks = rows(include_bytes!("../../data/drivers-trucks.csv"));
    let speeds = rows(include_bytes!("../../data/drivers-speeds.csv"));
    let failing = |scenario, driver, setting| tests_of(&all, scenario, driver, setting, "fail");
    let mut page = Page::open("drivers.md");
    overview(cells).lines().skip(2).for_each(|row| page.says(row));
    for row in reasons(cells, &BTreeMap::new()).lines().skip(2) {
        page.says(row.trim_end_matches("? |"));
    }
    let cell = |scenario: &str, driver: &str| {
        cells.iter().find(|cell| cell.scenario == scenario && cell.driver == driver).unwrap()
    };
    let planner = cell("pedestrian-crossing", "planner");
    page.says(format!(
        "{} of these walkers set out nearer than the braking distance and reach the car before it has passed: no driver passes these tests",
        planner.fail - planner.preventable
    ));
    let going_on = failing("pedestrian-crossing", "cruise", "");
    let braked = failing("pedestrian-crossing", "planner", "");
    let braked = braked.iter().filter(|own| going_on.iter().all(|other| other["test"] != own["test"]));
    let braked: Vec<&str> = braked.map(|row| row["test"]).collect();
    page.says(format!(
        "In tests {}, `planner` brakes for the walker and is hit; `cruise` does not brake",
        braked.join(" and ")
    ));
    assert_eq!(braked.len(), 2, "the page says that `planner` causes two collisions");

    let [slow, fast] = values(&failing("ncap-cpfa", "aeb", ""), "ego_speed");
    page.says(format!("at {slow:.0} to {fast:.0} km/h the car is near"));
    page.says(format!(
        "without its reaction time, {} tests still fail",
        failing("ncap-cpnco", "cc", "reaction=0").len()
    ));
    let inconclusive = tests_of(&all, "ncap-cpnco", "rss", "own_lateral=1", "inconclusive").len();
    assert!(failing("ncap-cpnco", "rss", "own_lateral=1").is_empty());
    page.says(format!("with `own_lateral=1`, no test fails and {inconclusive} are inconclusive"));
    page.says(format!("since {} tests fail without it", failing("ncap-cpnco", "rss", "response=0").len()));
    let share = |scenario: &str, driver: &str, within: &dyn Fn(&Row) -> bool| {
        let tests: Vec<&Row> =
            all.iter().filter(|row| row["scenario"] == scenario && row["driver"] == driver).collect();
        let within = tests.iter().filter(|row| row["verdict"] != "invalid" && within(row));
        let verdicts: Vec<&str> = within.map(|row| row["verdict"]).collect();
        let fail = verdicts.iter().filter(|verdict| **verdict == "fail").count();
        assert_eq!(
            fail,
            cell(scenario, driver).fail,
            "all failing tests of {driver} in {scenario} are among these tests"
        );
        [fail, verdicts.len()]
    };
    let [slow, _] = values(&failing("ncap-ccr", "fsm", ""), "ego_speed");
    let slow = slow.floor();
    let [fail, of] =
        share("ncap-ccr", "fsm", &|row| value(row, "ego_speed") > slow && row["values"].ends_with("target=standing"));
    page.says(format!("in {fail} of the {of} tests above {slow} km/h with a standing car"));
    let [_, far] = values(&failing("ncap-ccrb", "aeb", ""), "gap");
    let far = far.ceil();
    let [fail, of] = share("ncap-ccrb", "aeb", &|row| value(row, "gap") <= far);
    page.says(format!("a part of the cars that brake up to {far} m ahead: {fail} of these {of} tests fail"));
    let late = failing("ncap-ccrb", "fsm", "");
    let far = values(&late, "gap")[1].ceil();
    let gentle = (10.0 * values(&late, "deceleration")[0]).floor() / 10.0;
    let [fail, of] = share("ncap-ccrb", "fsm", &|row| value(row, "gap") <= far && value(row, "deceleration") >= gentle);
    page.says(format!("in {fail} of the {of} tests within {far} m of a car that brakes with {gentle} m/s² or more"));

    // The middle of a truck that the car hits with its front is half a car and half a truck's width ahead: 3.5 m.
    let hits: Vec<&Row> = trucks.iter().filter(|row| row["driver"] == "rss" && row["setting"].is_empty()).collect();
    assert_eq!(hits.len(), cell("highway-traffic", "rss").fail);
    let beside = |row: &&&Row| number(row, "truck_ahead_m") < 3.4 && number(row, "truck_left_m") > 0.0;
    let sides = hits.iter().filter(beside).count();
    page.says(format!("in {sides} of these tests the truck hits its left side"));
    page.says(format!("with `own_lateral=1`, {} tests fail", failing("highway-traffic", "rss", "own_lateral=1").len()));
    let going_on = failing("highway-traffic", "cruise", "");
    let fails = |tests: &[Row], index: &str| tests.iter().any(|row| row["test"] == index);
    let [late, early] = ["rss", "reg157"].map(|driver| failing("highway-traffic", driver, ""));
    assert!(fails(&late, "4") && fails(&early, "4") && !fails(&going_on, "4"));
    assert!(!early.iter().any(|row| fails(&going_on, row["test"])), "`cruise` passes all of these tests");
    let braking: Vec<&Row> = speeds.iter().filter(|row| row["driver"] == "reg157").collect();
    let begun = braking.windows(2).find(|pair| number(pair[1], "speed") < number(pair[0], "speed") - 0.1).unwrap()[0];
    let [least, _] = range(braking.iter().map(|row| number(row, "speed")));
    page.says(format!("in test 4 from {:.1} s on, down to {least:.1} m/s", number(begun, "time")));
    page.says("In test 4, `cruise` passes the crossing before the truck comes");
    for (scenario, driver) in all.iter().map(|row| (row["scenario"], row["driver"])).collect::<BTreeSet<_>>() {
        let same = all.iter().any(|row| [row["scenario"], row["driver"], row["setting"]] == [scenario, driver, ""]);
        assert!(!same || failing(scenario, driver, "").len() == cell(scenario, driver).fail, "{driver} in {scenario}");
    }
    page.given(&[
        "uses no camera drives 200 Halton tests",
        "## Failures of 200 tests",
        "more than 5 % failures",
        "other settings ([its tests](data/drivers-reasons.csv.gz)), and notes [where the truck is](data/drivers-trucks.csv) at the end of the \
         failures of `highway-traffic`, and [the speeds](data/drivers-speeds.csv) in test 4",
    ]);
    // The default settings of the drivers.
    let setting = |of: &str, name: &str| {
        let described = driver::ALL.iter().find(|driver| driver.name == of).unwrap();
        let default = described.settings.iter().find(|setting| setting.name == name).unwrap().default;
        (100.0 * default).round() / 100.0
    };
    let (late, near) = (setting("aeb", "latency"), setting("aeb", "ttc"));
    page.says(format!("the sensor is {late} s late"));
    page.says(format!("brakes from a time to collision of {near} s on"));
    page.says(format!("outside the field of view of {}°; with its delay of {late} s", setting("aeb", "field_of_view")));
    let (risk, reaction) = (setting("cc", "ttc"), setting("cc", "reaction"));
    for words in ["from a time to collision of {} s on", "only below a time to collision of {} s"] {
        page.says(format!("sees a risk {}, and brakes {reaction} s later", words.replace("{}", &risk.to_string())));
    }
    page.says(format!("the time to collision is at most {risk} s, and brakes {reaction} s later"));
    assert_eq!(setting("rss", "response"), setting("fsm", "reaction"));
    page.says(format!("the response takes {} s", setting("rss", "response")));
    for of in ["rss", "fsm"] {
        page.says(format!("brakes with at most {} m/s²", setting(of, "deceleration")));
    }
    let late = setting("reg157", "reaction");
    page.says(format!("into the lane, {late} s later"));
    page.says(format!("has come {} m into the lane, and {late} s longer", setting("reg157", "intrusion")));
    page.given(&["a leader that is slow from the beginning, 25 m ahead"]);
    page.close();
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
