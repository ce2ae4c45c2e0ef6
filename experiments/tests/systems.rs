//! Tests the systems of the benchmark from outside, as separate processes.

use paracosm::campaign::BlackBox;
use paracosm::generators::Strategy;
use paracosm::space::Space;
use paracosm::{Campaign, Study, Trial};
use std::io::Write;
use std::process::{Command, Output, Stdio};

const PROGRAM: &str = env!("CARGO_BIN_EXE_paracosm-experiments");

fn experiments(arguments: &[&str], input: &str) -> Output {
    let mut command = Command::new(PROGRAM);
    let command = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut process = command.spawn().unwrap();
    // A system that has ended already does not read its input, so that writing may fail.
    let _ = process.stdin.take().unwrap().write_all(input.as_bytes());
    process.wait_with_output().unwrap()
}

#[test]
fn a_campaign_falsifies_its_speed_limit_in_the_opening() {
    let command = format!("'{PROGRAM}' system automatic-transmission");
    let space = Space::from_toml(include_str!("../systems/automatic-transmission.toml")).unwrap();
    let study = Study::of_system(BlackBox::new(&command, None).unwrap(), space);
    let study = study.spec("always[0,20] (speed < 120)").strategy(Strategy::AUTO).budget(20).build().unwrap();
    let mut failures = Vec::new();
    let mut note = |trial: &Trial| {
        assert_eq!((trial.error(), trial.ticks), (None, 600));
        failures.extend(trial.is_failure().then_some(trial.index));
    };
    Campaign::new(&study).unwrap().run(&mut [&mut note]).unwrap();
    assert!(failures.first().is_some_and(|first| *first < 4), "{failures:?}");
}

#[test]
fn it_answers_line_by_line_and_refuses_other_names() {
    let answers = experiments(
        &["system", "automatic-transmission"],
        "{\"index\":0,\"test\":{\"throttle\":0,\"brake\":0}}\n{\"index\":1,\"test\":{}}\n",
    );
    let answers = String::from_utf8(answers.stdout).unwrap();
    let lines: Vec<&str> = answers.lines().collect();
    assert!(lines[0].contains("\"time\":[0.0,0.05,0.1,"), "{answers}");
    assert!(lines[1].contains("\"error\":\"the test has no value for the input `throttle`\""), "{answers}");
    for (arguments, says) in [
        (&["system"][..], "needs the name of a system: aircraft, automatic-transmission, "),
        (&["system", "manual"], "no system is called `manual`; the systems are aircraft, "),
        (&["system", "chasing-cars", "--spec", "always (y1 <"], "the formula of --spec, column 13: found the end"),
        (&["fig9", "--spec", "always (y1 < 0)"], "<SYSTEM>"),
        (&["fig9", "manual"], "found the argument `manual` after the name of the study"),
    ] {
        let refused = experiments(arguments, "");
        assert_eq!(refused.status.code(), Some(2));
        assert!(String::from_utf8(refused.stderr).unwrap().contains(says));
    }
}
