//! A system as a process of its own, which `paracosm-fuzz --system` can test: it reads a test as a line of JSON, and answers with the trace of the run as
//! a line of JSON. If it is given a formula, it answers with the robustness of the formula instead, which is a much shorter line.

use super::{SYSTEMS, System};
use crate::{Done, print};
use paracosm::oracles::{Formula, ParseError};
use paracosm::space::{Values, did_you_mean, nearest};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::io::{self, BufRead};
use thiserror::Error;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Question {
    index: usize,
    test: Values,
}

/// The reason why no system answers.
#[derive(Debug, Error)]
pub enum ServeError {
    /// No system has the name.
    #[error("no system is called `{name}`{}; the systems are {}", did_you_mean(&nearest(name, names())), listed())]
    Unknown { name: String },
    /// The formula has a mistake.
    #[error("the formula of --spec, {0}")]
    Formula(ParseError),
}

fn names() -> impl Iterator<Item = &'static str> {
    SYSTEMS.iter().map(|system| system.name)
}

/// Lists the names of all systems.
pub fn listed() -> String {
    names().collect::<Vec<_>>().join(", ")
}

/// Runs each test that standard input gives as a line of JSON, and prints the test's result as a line of JSON.
///
/// # Errors
/// Returns an error if no system has the name, if the formula does not fit the system, and if a line is not a question.
pub fn serve(name: &str, formula: Option<&str>) -> Done {
    let system = find(name)?;
    let formula = formula.map(str::parse::<Formula>).transpose().map_err(ServeError::Formula)?;
    for line in io::stdin().lock().lines() {
        print(&(answer(system, formula.as_ref(), &line?)? + "\n"))?;
    }
    Ok(())
}

/// Finds a system by its name.
///
/// # Errors
/// Returns an error that names the nearest system if no system has the name.
fn find(name: &str) -> Result<&'static System, ServeError> {
    let found = SYSTEMS.iter().find(|system| system.name == name);
    found.ok_or_else(|| ServeError::Unknown { name: name.to_owned() })
}

/// Runs the test in a line of JSON, and returns the test's result as a line of JSON.
fn answer(system: &System, formula: Option<&Formula>, line: &str) -> Result<String, serde_json::Error> {
    let Question { index, test } = serde_json::from_str(line)?;
    let outcome = system.trace(&test).map_err(|flaw| flaw.to_string()).and_then(|trace| {
        let Some(formula) = formula else {
            let time: Vec<f64> = (0..trace.len()).map(|sample| sample as f64 * trace.dt()).collect();
            let mut columns = Map::from_iter([("time".to_owned(), json!(time))]);
            for name in trace.signals() {
                let column: Vec<f64> = trace.signal(name).into_iter().flatten().collect();
                columns.insert(name.clone(), json!(column));
            }
            return Ok(("trace", Value::Object(columns)));
        };
        let evaluation = formula.evaluate(&trace).map_err(|error| error.to_string())?;
        Ok(("robustness", json!({ "spec": evaluation.robustness })))
    });
    let (key, value) = outcome.unwrap_or_else(|error| ("error", Value::String(error)));
    serde_json::to_string(&json!({ "index": index, key: value }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answered(formula: Option<&str>, test: Value) -> Value {
        let formula = formula.map(|text| text.parse().unwrap());
        let line = json!({"index": 5, "test": test}).to_string();
        serde_json::from_str(&answer(find("automatic-transmission").unwrap(), formula.as_ref(), &line).unwrap())
            .unwrap()
    }

    #[test]
    fn a_test_is_answered_with_its_index_and_a_trace_of_30_seconds() {
        let said = answered(None, json!({"throttle": [100, 0], "brake": 0}));
        assert_eq!(said["index"], 5);
        let column = |name: &str| said["trace"][name].as_array().unwrap().clone();
        assert_eq!(["time", "speed", "rpm", "gear"].map(|name| column(name).len()), [601; 4]);
        assert_eq!(
            (&column("time")[600], &column("speed")[0], &column("gear")[0]),
            (&json!(30.0), &json!(0.0), &json!(1.0))
        );
    }

    #[test]
    fn with_a_formula_it_is_answered_with_the_robustness() {
        let test = json!({"throttle": 0, "brake": 0});
        assert_eq!(answered(Some("always (gear < 3)"), test)["robustness"]["spec"], 2.0);
        let wrong = answered(Some("always (gears < 3)"), json!({"throttle": 0, "brake": 0}));
        assert!(wrong["error"].as_str().unwrap().contains("`gears`"), "{wrong}");
    }

    #[test]
    fn what_it_cannot_run_is_answered_with_an_error_that_says_why() {
        for (test, says) in [
            (json!({"throttle": 1}), "no value for the input `brake`"),
            (json!({"throttle": [], "brake": 1}), "`throttle` is"),
            (json!({"throttle": ["a"], "brake": 1}), "`throttle` is"),
        ] {
            assert!(answered(None, test)["error"].as_str().unwrap().contains(says));
        }
        assert!(answer(&SYSTEMS[0], None, "nonsense").is_err());
        assert!(find("chasing-car").err().unwrap().to_string().contains("did you mean `chasing-cars`"));
    }
}
