use super::*;
use crate::{ALL, DefectError};

#[test]
fn a_defect_is_written_as_its_kind_and_its_size_and_read_back() {
    for kind in ALL {
        for &size in kind.sizes {
            let defect = defect(kind.name, size);
            let text = serde_json::to_string(&defect).unwrap();
            assert_eq!(serde_json::from_str::<Defect>(&text).unwrap(), defect, "{text}");
        }
    }
    let late = defect("late-reaction", 0.5);
    assert_eq!(serde_json::to_string(&late).unwrap(), r#"{"kind":"late-reaction","size":0.5}"#);
    assert_eq!(late.to_string(), "late-reaction 0.5 s");
    // A size between those of the ladder is a size, too.
    assert_eq!(defect("short-range", 33.3).to_string(), "short-range 33.3 m");
}

#[test]
fn a_defect_of_an_unknown_kind_or_of_an_impossible_size_is_refused() {
    let read = |text: &str| serde_json::from_str::<Defect>(text).unwrap_err().to_string();
    let unknown = read(r#"{"kind": "blind-lft", "size": 3}"#);
    assert!(unknown.contains("`blind-lft` (did you mean `blind-left`?)"), "{unknown}");
    let large = read(r#"{"kind": "late-reaction", "size": 50}"#);
    let words = "the size of the defect `late-reaction` is 50, expected a number from 0.1 to 2.5 (s)";
    assert!(large.contains(words), "{large}");
    assert!(read(r#"{"kind": "late-reaction", "size": 1, "when": []}"#).contains("unknown field `when`"));
    assert!(matches!(Defect::new("short-range", f64::NAN), Err(DefectError::OutOfRange { range: (7.0, 80.0), .. })));
}

#[test]
fn a_reset_forgets_the_run_before() {
    let bodies = [body(0, Class::Car, (40.0, 0.0), (5.0, 0.0)), body(1, Class::Pedestrian, (30.0, 4.0), (0.0, -1.5))];
    let mut world = same(47, &bodies);
    world.iter_mut().enumerate().for_each(|(step, moment)| moment.odometry.heading = 0.02 * (step % 7) as f64);
    let wanted: Vec<f64> = (0..47).map(|step| if step % 5 < 3 { -0.9 } else { 0.01 * f64::from(step) }).collect();
    for kind in ALL {
        let probe = Probe { plays: throttles(&wanted), ..Probe::default() };
        let seen = probe.seen.clone();
        let mut driver = defect(kind.name, kind.sizes[4]).in_driver(Box::new(probe));
        let mut run = || {
            driver.reset(&briefing()).unwrap();
            let done: Vec<Control> = world.iter().map(|moment| driver.step(moment).unwrap()).collect();
            (done, std::mem::take(&mut *seen.lock().unwrap()))
        };
        let first = run();
        assert!(run() == first, "{}", kind.name);
    }
}
