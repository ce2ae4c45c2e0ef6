//! Modes of trials made up for the purpose.

use super::{Modes, ValueRange};
use crate::CriticalFigure;
use paracosm_campaign::{Catalogue, Learned, Log, Study, Trial};

/// A trial of the paper's study that ended with a contact.
fn contact(index: usize, face: &str, motion: &str, speed: f64, metrics: &str) -> Trial {
    let test = format!("{{\"speed\":{},\"distance\":20}}", 1.0 + index as f64 / 100.0);
    let line = format!(
        "{{\"index\":{index},\"test\":{test},\"verdict\":\"fail\",\"robustness\":{{\"no-collision\":-{speed},\
         \"progress\":null}},\"metrics\":{{\"contact_face\":\"{face}\",\"contact_motion\":\"{motion}\",{metrics},\
         \"critical_time.no-collision\":5.5,\"critical_travelled.no-collision\":88,\
         \"critical_speed.no-collision\":{speed},\"critical_part.no-collision\":\"(not car.collides)\",\
         \"impact_speed\":{speed},\"travelled\":88,\"triggered\":true}},\"ticks\":550,\"trace_hash\":\"00\",\"error\":null}}"
    );
    serde_json::from_str(&line).expect("a trial")
}

const WALKER: &str = r#""contact_with":"pedestrian","contact_class":"pedestrian","other_speed":1.4"#;

fn modes(trials: &[Trial]) -> Modes {
    let program = Catalogue::of(paracosm_scenarios::ALL).find("pedestrian-crossing").unwrap();
    let study = Study::of(program).build().unwrap();
    Modes::of(&Log::new(study, Learned::new(), None, trials.to_vec()))
}

#[test]
fn what_was_touched_and_how_tells_modes_apart_and_the_words_say_it() {
    let post = r#""contact_with":"sign","contact_class":"sign","other_speed":0"#;
    let van = r#""contact_with":"traffic","contact_class":"truck","other_speed":9"#;
    let trials = [
        contact(0, "front", "braking", 6.0, WALKER),
        contact(1, "left", "driving", 16.7, WALKER),
        contact(2, "front", "braking", 12.25, WALKER),
        contact(3, "right", "standing", 0.0, WALKER),
        contact(4, "right", "braking", 3.0, post),
        contact(5, "rear", "braking", 5.0, van),
        contact(6, "front", "standing", 0.0, WALKER),
    ];
    let found = modes(&trials);
    assert_eq!(found.failures, 7);
    let told: Vec<(&str, &str)> = found.modes.iter().map(|mode| (mode.name.as_str(), mode.words.as_str())).collect();
    let expected = [
        (
            "no-collision/pedestrian/front/braking",
            "the car brakes at 6 to 12.2 m/s and hits the pedestrian with its front",
        ),
        (
            "no-collision/pedestrian/left/driving",
            "the car goes on at 16.7 m/s; the pedestrian walks into its left side",
        ),
        ("no-collision/pedestrian/right/standing", "the car stands; the pedestrian walks into its right side"),
        ("no-collision/sign/right/braking", "the car brakes at 3 m/s and touches the sign with its right side"),
        ("no-collision/traffic/rear/braking", "the car brakes at 5 m/s; the truck `traffic` drives into its rear"),
        ("no-collision/pedestrian/front/standing", "the car stands; the pedestrian walks into its front"),
    ];
    assert_eq!(told, expected);
    let first = &found.modes[0];
    assert_eq!((first.worst, first.trials.as_slice()), (2, &[0, 2][..]));
    assert_eq!(first.parameters.get("speed"), Some(&ValueRange::Interval([1.0, 1.02])));
}

#[test]
fn a_gap_in_the_speed_makes_two_modes_of_one_kind_each_with_a_typical_test() {
    let speeds = [2.0, 2.5, 3.0, 3.5, 4.0, 2.2, 14.0, 14.5, 15.0, 15.5, 16.0, 14.2];
    let trials: Vec<Trial> =
        speeds.iter().enumerate().map(|(i, speed)| contact(i, "front", "braking", *speed, WALKER)).collect();
    let found = modes(&trials).modes;
    assert_eq!(found.iter().map(|mode| (mode.count, mode.representative)).collect::<Vec<_>>(), [(6, 2), (6, 8)]);
    assert_eq!(
        [&found[0].name, &found[1].name].map(|name| name.rsplit('/').next().unwrap()),
        ["braking#1", "braking#2"]
    );
    assert_eq!(found[1].figures.get(&CriticalFigure::Speed), Some(&[14.0, 16.0]));
    // Evenly spread, they are one.
    let even: Vec<Trial> = (0..12).map(|i| contact(i, "front", "braking", 2.0 + i as f64, WALKER)).collect();
    assert_eq!(modes(&even).modes.len(), 1);
}

#[test]
fn failures_of_a_system_are_told_apart_by_the_part_of_the_formula_and_the_time() {
    let line = |index: usize, part: &str, time: f64| {
        format!(
            "{{\"index\":{index},\"test\":{{\"speed\":1,\"distance\":20}},\"verdict\":\"fail\",\
             \"robustness\":{{\"spec-1\":-1.5}},\"metrics\":{{\"critical_time.spec-1\":{time},\
             \"critical_part.spec-1\":\"{part}\"}},\"ticks\":9,\"trace_hash\":\"00\",\"error\":null}}"
        )
    };
    let early = (0..6).map(|i| line(i, "(rpm < 4750)", 3.0 + 0.1 * i as f64));
    let late = (6..12).map(|i| line(i, "(rpm < 4750)", 22.0 + 0.1 * i as f64));
    let other = (12..14).map(|i| line(i, "(speed < 120)", 9.0));
    let trials: Vec<Trial> = early.chain(late).chain(other).map(|line| serde_json::from_str(&line).unwrap()).collect();
    let found = modes(&trials).modes;
    let told: Vec<_> = found.iter().map(|mode| (mode.name.as_str(), mode.words.as_str(), mode.count)).collect();
    let expected = [
        ("spec-1#1", "violates spec-1, by `(rpm < 4750)`, 3 to 3.5 s after the start", 6),
        ("spec-1#2", "violates spec-1, by `(rpm < 4750)`, 22.6 to 23.1 s after the start", 6),
        ("spec-1#3", "violates spec-1, by `(speed < 120)`, 9 s after the start", 2),
    ];
    assert_eq!(told, expected);
    assert_eq!(found[2].parts.get("spec-1").map(String::as_str), Some("(speed < 120)"));
}

#[test]
fn modes_with_the_same_words_are_told_apart_by_what_they_differ_in() {
    let too_slow = contact(0, "front", "braking", 6.0, WALKER);
    // The same contact, but the car has not come far enough either.
    let line = serde_json::to_string(&contact(1, "front", "braking", 6.0, WALKER)).unwrap();
    let line = line.replace("\"progress\":null", "\"progress\":-9");
    let stuck: Trial = serde_json::from_str(&line).unwrap();
    let told: Vec<String> = modes(&[too_slow, stuck]).modes.into_iter().map(|mode| mode.words).collect();
    let words = "the car brakes at 6 m/s and hits the pedestrian with its front";
    assert_eq!(
        told,
        [format!("{words}, violating no-collision"), format!("{words}, violating no-collision and progress")]
    );
}

#[test]
fn trials_of_which_only_the_violation_is_known_are_one_mode() {
    let line = |index: usize| {
        format!(
            "{{\"index\":{index},\"test\":{{\"speed\":1,\"distance\":20}},\"verdict\":\"fail\",\
             \"robustness\":{{\"progress\":-{index}.5}},\"metrics\":{{}},\"ticks\":0,\"trace_hash\":null,\"error\":null}}"
        )
    };
    let trials: Vec<Trial> = (0..3).map(|index| serde_json::from_str(&line(index)).unwrap()).collect();
    let found = modes(&trials).modes;
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].words.as_str(), found[0].representative, found[0].worst), ("violates progress", 2, 2));
}
