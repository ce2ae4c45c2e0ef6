//! The automatic transmission as a separate system that `paracosm-fuzz --system` can test: it reads a test as a line of
//! JSON, and answers with the trace of the run as a line of JSON.

use crate::transmission::{SAMPLES_PER_SECOND, Sample, run};
use crate::{Done, print};
use paracosm::space::{Value, Values};
use serde::{Deserialize, Serialize, Serializer};
use std::io::{self, BufRead};
use thiserror::Error;

/// The name of the system on the command line.
pub const NAME: &str = "automatic-transmission";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Question {
    index: usize,
    test: Values,
}

#[derive(Serialize)]
struct Answer {
    index: usize,
    #[serde(flatten)]
    outcome: Outcome,
}

#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum Outcome {
    Trace {
        time: Vec<f64>,
        speed: Vec<f64>,
        rpm: Vec<f64>,
        gear: Vec<usize>,
    },
    #[serde(serialize_with = "in_words")]
    Error(InputFlaw),
}

/// The reason why the system cannot run a test.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InputFlaw {
    /// The test lacks an input.
    #[error("the test has no value for the input `{name}`")]
    Missing { name: &'static str },
    /// An input is neither a number nor a list of numbers.
    #[error("`{name}` is {value}, expected a number or a list of numbers")]
    NoNumbers { name: &'static str, value: Value },
}

fn in_words<S: Serializer>(flaw: &InputFlaw, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(flaw)
}

/// Runs each test that standard input gives as a line of JSON, and prints the test's result as a line of JSON.
pub fn serve() -> Done {
    for line in io::stdin().lock().lines() {
        print(&(answer(&line?)? + "\n"))?;
    }
    Ok(())
}

/// Runs the test in a line of JSON, and returns the test's result as a line of JSON.
///
/// # Errors
/// Returns an error if the line is not a question, so that there is no index to answer with.
pub fn answer(line: &str) -> Result<String, serde_json::Error> {
    let Question { index, test } = serde_json::from_str(line)?;
    let outcome = match inputs(&test) {
        Ok([throttle, brake]) => trace(&run(&throttle, &brake)),
        Err(flaw) => Outcome::Error(flaw),
    };
    serde_json::to_string(&Answer { index, outcome })
}

/// Returns the throttle and the brake of a test.
///
/// # Errors
/// Returns an error if an input is missing, is empty, or has a value that is not a finite number.
pub fn inputs(test: &Values) -> Result<[Vec<f64>; 2], InputFlaw> {
    let signal = |name: &'static str| {
        let value = test.get(name).ok_or(InputFlaw::Missing { name })?;
        let numbers: Option<Vec<f64>> = value.scalars().iter().map(Value::number).collect();
        let numbers = numbers.filter(|numbers| !numbers.is_empty() && numbers.iter().all(|number| number.is_finite()));
        numbers.ok_or_else(|| InputFlaw::NoNumbers { name, value: value.clone() })
    };
    Ok([signal("throttle")?, signal("brake")?])
}

fn trace(samples: &[Sample]) -> Outcome {
    Outcome::Trace {
        time: (0..samples.len()).map(|sample| sample as f64 / SAMPLES_PER_SECOND).collect(),
        speed: samples.iter().map(|sample| sample.speed).collect(),
        rpm: samples.iter().map(|sample| sample.rpm).collect(),
        gear: samples.iter().map(|sample| sample.gear).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn answered(test: Value) -> Value {
        serde_json::from_str(&answer(&json!({"index": 5, "test": test}).to_string()).unwrap()).unwrap()
    }

    #[test]
    fn a_test_is_answered_with_its_index_and_a_trace_of_30_seconds() {
        let said = answered(json!({"throttle": [100, 0], "brake": 0}));
        assert_eq!(said["index"], 5);
        let column = |name: &str| said["trace"][name].as_array().unwrap().clone();
        assert_eq!(["time", "speed", "rpm", "gear"].map(|name| column(name).len()), [301; 4]);
        assert_eq!(
            (&column("time")[300], &column("speed")[0], &column("gear")[0]),
            (&json!(30.0), &json!(0.0), &json!(1))
        );
    }

    #[test]
    fn what_it_cannot_run_is_answered_with_an_error_that_says_why() {
        assert!(answered(json!({"throttle": 1}))["error"].as_str().unwrap().contains("no value for the input `brake`"));
        assert!(answered(json!({"throttle": [], "brake": 1}))["error"].as_str().unwrap().contains("`throttle` is"));
        assert!(answered(json!({"throttle": ["a"], "brake": 1}))["error"].as_str().unwrap().contains("`throttle` is"));
        assert!(answer("nonsense").is_err());
    }
}
