//! What the reference drivers of UN R157 get out of.

use super::common::{fuzz, golden, succeeds};
use std::fs;

#[allow(dead_code)]
#[path = "../../examples/cut_ins.rs"]
mod cut_ins;

#[test]
fn the_example_of_the_cut_ins_says_what_each_reference_driver_avoids() {
    golden("cut-ins.txt", &cut_ins::report().unwrap());
}

#[test]
fn cc_spares_the_standing_car_that_a_leader_two_seconds_ahead_uncovers() {
    let dir = tempfile::tempdir().unwrap();
    let cut_out = ["cut-out", "--driver", "cc", "--set", "ego_speed=60", "--set", "headway=2", "-q", "--out", "out"];
    let open = ["--set", "lateral_speed=3", "--open", "gap=40..60", "--budget", "21"];
    succeeds(fuzz(dir.path(), &[&cut_out[..], &open].concat()));
    let log = fs::read_to_string(dir.path().join("out/trials.jsonl")).unwrap();
    assert_eq!(log.lines().count(), 21);
    assert!(log.lines().all(|trial| trial.contains(r#""verdict":"pass""#)), "{log}");
}
