//! Counts the pairs in Example 3.1 of the PARACOSM paper: `cargo run --release --example lanes`.
//!
//! A road has 2 or 4 lanes; three cars each come towards the test vehicle or drive along with it, and each car is red
//! or green: seven parameters of two values, 128 tests. The paper covers all pairs with 6 of these tests. This example
//! counts the pairs of the paper's 6 tests, makes a covering array, hides a fault in a pair of values, and finds the
//! pair again.

use paracosm::coverage::kwise::kwise_coverage;
use paracosm::coverage::suspects::{JudgedTest, Locator, suspects};
use paracosm::generators::covering::{CoveringRequest, covering_array};
use paracosm::space::rules::Rules;
use paracosm::space::{Domain, Parameter, Space, SpaceError, Value};
use std::error::Error;
use std::fmt::Write;

const CARS: usize = 3;

fn space() -> Result<Space, SpaceError> {
    let choice = |name: String, values: [Value; 2]| Parameter::new(name, Domain::Choice(values.into()));
    let directions = (1..=CARS).map(|car| choice(format!("direction{car}"), ["towards".into(), "along".into()]));
    let colours = (1..=CARS).map(|car| choice(format!("colour{car}"), ["red".into(), "green".into()]));
    let lanes = choice("lanes".into(), [2.into(), 4.into()]);
    Space::new(std::iter::once(lanes).chain(directions).chain(colours).collect())
}

/// Returns the tests as the paper writes them; `any` is the colour for the place where the paper allows either colour.
fn of_the_paper(any: char) -> Vec<Vec<usize>> {
    let tests = [
        (2, "011", "GGG"),
        (2, "101", "GRR"),
        (2, "010", "RR*"),
        (4, "001", "RGR"),
        (4, "110", "GGR"),
        (4, "100", "RRG"),
    ];
    let row = |(lanes, directions, colours): (i32, &str, &str)| {
        let colours = colours.replace('*', &any.to_string());
        let bits =
            directions.chars().map(|c| usize::from(c == '1')).chain(colours.chars().map(|c| usize::from(c == 'G')));
        std::iter::once(usize::from(lanes == 4)).chain(bits).collect()
    };
    tests.map(row).into()
}

/// Returns `true` if a test has the hidden fault: the second car comes towards the test vehicle and is red.
fn fails(test: &[usize]) -> bool {
    test[2] == 0 && test[5] == 0
}

/// Returns the results of the whole example as text.
pub fn report() -> Result<String, Box<dyn Error>> {
    let mut text = String::new();
    let space = space()?;
    let rules = Rules::new(&space.levels(), &space.clauses())?;
    let pairs = |rows: &[Vec<usize>]| kwise_coverage(&rules, 2, rows.iter().map(Vec::as_slice));

    // There are 7 * 6 / 2 pairs of parameters with 4 pairs of values each. The paper's naive count, 2n (2n + 1) = 42
    // for n = 3 cars, is half of them.
    for any in ['R', 'G'] {
        let rows = of_the_paper(any);
        let counted = pairs(&rows)?;
        writeln!(text, "the paper's {} tests, * as {any}: {} of {} pairs", rows.len(), counted.covered, counted.valid)?;
    }

    // Six is the least number: n rows cover the pairs of at most C(n - 1, n / 2 - 1) parameters of two values (Katona
    // 1973, Kleitman and Spencer 1973), with n / 2 rounded down. That is 4 parameters for 5 rows, and 10 for 6.
    let array = covering_array(&CoveringRequest::new(&rules, 2))?;
    let counted = pairs(&array.rows)?;
    writeln!(text, "our {} tests: {} of {} pairs", array.rows.len(), counted.covered, counted.valid)?;

    let judge = |row: &Vec<usize>| JudgedTest { levels: row.clone(), failed: fails(row) };
    let tests: Vec<JudgedTest> = array.rows.iter().map(judge).collect();
    let names: Vec<&str> = space.parameters().iter().map(|parameter| parameter.name.as_str()).collect();
    let in_words = |values: &[(usize, usize)]| {
        let word = |&(parameter, level): &(usize, usize)| {
            let value = &space.parameters()[parameter].levels().expect("a choice")[level];
            format!("{} {value}", names[parameter])
        };
        values.iter().map(word).collect::<Vec<_>>().join(", ")
    };
    for test in &tests {
        let all: Vec<(usize, usize)> = test.levels.iter().copied().enumerate().collect();
        writeln!(text, "{}: {}", if test.failed { "fail" } else { "pass" }, in_words(&all))?;
    }
    let found = suspects(&rules, &tests, 2, 5)?;
    writeln!(text, "{} combinations of at most 2 values are suspect, among them", found.found)?;
    for suspect in &found.ranked {
        writeln!(text, "  {}", in_words(&suspect.values))?;
    }

    let [failing, passing] = [true, false].map(|failed| tests.iter().find(|test| test.failed == failed));
    let (failing, passing) = failing.zip(passing).ok_or("the array has both failing and passing tests")?;
    let mut locator = Locator::new(&rules, &failing.levels, &passing.levels)?;
    while let Some(test) = locator.question() {
        let failed = fails(test);
        locator.tell(failed);
    }
    let located = locator.located().ok_or("every question was answered")?;
    let bound = located.bound.ok_or("there are no constraints")?;
    writeln!(text, "guilty: {}, found by {} more tests, at most {bound}", in_words(&located.values), located.tests)?;
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", report()?);
    Ok(())
}
