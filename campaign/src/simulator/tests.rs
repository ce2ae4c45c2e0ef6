//! The closed loop with eyes in it: whatever is drawn together, every test is the same.

#[path = "../../../engine/render/tests/support/adapter.rs"]
mod adapter;
mod bends;
mod quiet_road;

use super::*;
use crate::executor::{from_desk, pool};
use crate::{Campaign, Sampling, Study, StudyBuilder, Trial, Worker};
use paracosm_engine::driver::{Driver, Equipment, Fault, find};
use paracosm_engine::sensor::{Image, Rig};
use paracosm_engine::{Briefing, Control, Observation, simulate};
use paracosm_oracles::Verdict;
use paracosm_render::{RenderError, Renderer};
use quiet_road::QUIET;
use std::num::NonZeroUsize;
use std::sync::atomic::Ordering;

/// Whether there is something to draw with; a note where there is not, unless somebody insists.
pub fn can_draw() -> bool {
    adapter::unless_missing(paracosm_render::adapter()).is_some()
}

fn builder(changes: &[(&str, f64)]) -> StudyBuilder {
    let study = Study::of(QUIET).driver("lane-camera").budget(7);
    changes.iter().fold(study, |study, (name, value)| study.set_driver(name, *value))
}

fn study(changes: &[(&str, f64)]) -> Study {
    builder(changes).build().expect("a sound study")
}

fn trials(campaign: Campaign<'_>) -> Vec<Trial> {
    let mut trials = Vec::new();
    campaign.run(&mut [&mut |trial: &Trial| trials.push(trial.clone())]).expect("it runs");
    trials
}

fn number(n: usize) -> NonZeroUsize {
    NonZeroUsize::new(n).expect("it is more than 0")
}

#[test]
fn whatever_is_drawn_together_the_trials_are_the_same() {
    if !can_draw() {
        return;
    }
    let study = study(&[("blur", 0.8), ("latency", 0.12), ("dropped", 0.2)]);
    let once = trials(Campaign::new(&study).unwrap());
    assert_eq!(once.len(), 7);
    assert!(once.iter().all(|trial| trial.trace_hash.is_some()), "{once:?}");
    for (jobs, at_once) in [(1, 1), (1, 32), (2, 7), (2, 2), (3, 32)] {
        let campaign = Campaign::new(&study).unwrap().jobs(number(jobs)).at_once(number(at_once));
        assert!(trials(campaign) == once, "{jobs} jobs, {at_once} at once");
    }
    let mut worker = Worker::new(&study).unwrap();
    for trial in &once[3..5] {
        assert_eq!(worker.run(trial.index, &trial.test).0, *trial);
    }
}

#[test]
fn streaks_of_rain_are_those_of_the_image_whatever_is_drawn_together() {
    if !can_draw() {
        return;
    }
    let rainy = builder(&[]).open("rain").build().unwrap();
    let once = trials(Campaign::new(&rainy).unwrap().jobs(number(1)).at_once(number(1)));
    assert!(trials(Campaign::new(&rainy).unwrap().jobs(number(2)).at_once(number(5))) == once);
}

#[test]
fn a_campaign_of_drivers_that_see_is_stopped_and_goes_on() {
    if !can_draw() {
        return;
    }
    let first_only = Sampling { budget: 7, stop_at_first: true, ..Sampling::default() };
    let foggy = study(&[("setback", 3.0)]).sampled(first_only).unwrap();
    let all = trials(Campaign::new(&study(&[("setback", 3.0)])).unwrap());
    let first = all.iter().position(Trial::is_failure).expect("the driver is set to leave its lane");
    assert!(trials(Campaign::new(&foggy).unwrap()) == all[..=first]);

    let study = study(&[("setback", 3.0)]);
    let campaign = Campaign::new(&study).unwrap().at_once(number(4));
    let (stop, mut seen) = (campaign.stop(), Vec::new());
    let mut watch = |trial: &Trial| {
        seen.push(trial.clone());
        if seen.len() == 2 {
            stop.store(true, Ordering::Relaxed);
        }
    };
    let stopped = campaign.run(&mut [&mut watch]);
    assert!(matches!(stopped, Err(Error::Interrupted)));
    assert!(seen.len() >= 2 && seen.len() < all.len() && seen == all[..seen.len()], "{}", seen.len());
    let known = seen.len();
    let rest = trials(Campaign::new(&study).unwrap().resume(seen));
    assert!(rest == all[known..]);
}

#[test]
fn it_keeps_its_lane_by_day_and_stops_in_fog() {
    if !can_draw() {
        return;
    }
    let by_day = trials(Campaign::new(&study(&[])).unwrap());
    assert!(by_day.iter().all(|trial| trial.verdict == Verdict::Pass), "{by_day:?}");
    let foggy = study(&[("patience", 0.2)]);
    let mut worker = Worker::new(&foggy).unwrap();
    let mut in_fog = |fog: f64| {
        let mut test = by_day[0].test.clone();
        test.set("fog", fog);
        worker.run(0, &test).0
    };
    assert_eq!(in_fog(0.1).verdict, Verdict::Pass);
    let (thin, dense) = (in_fog(0.1), in_fog(1.0));
    assert!(dense.robustness("progress") < thin.robustness("progress"), "{dense:?}");
}

/// The trials of a campaign whose device is lost when the first trial is there; `open` makes the next one.
fn trials_with_a_loss(study: &Study, open: fn() -> Result<Renderer, RenderError>) -> Vec<Trial> {
    let campaign = Campaign::new(study).unwrap().jobs(number(2)).at_once(number(2));
    let darkroom = campaign.darkroom().cloned().expect("its driver sees");
    let mut trials: Vec<Trial> = Vec::new();
    let mut watch = |trial: &Trial| {
        if trials.is_empty() {
            darkroom.lose(open);
        }
        trials.push(trial.clone());
    };
    campaign.run(&mut [&mut watch]).expect("it goes on");
    trials
}

#[test]
fn a_campaign_whose_device_is_lost_draws_with_a_new_one_and_its_trials_are_the_same() {
    if !can_draw() {
        return;
    }
    let study = builder(&[]).budget(12).build().unwrap();
    assert!(trials_with_a_loss(&study, Renderer::new) == trials(Campaign::new(&study).unwrap()));
}

#[test]
fn where_there_is_no_new_device_the_tests_under_way_are_errors_that_say_so_and_the_campaign_goes_on() {
    if !can_draw() {
        return;
    }
    let study = builder(&[]).budget(12).build().unwrap();
    let undisturbed = trials(Campaign::new(&study).unwrap());
    let found =
        trials_with_a_loss(&study, || Err(RenderError::NoAdapter(Arc::new(std::io::Error::other("it was unplugged")))));
    assert_eq!(found.len(), 12);
    let (broken, whole): (Vec<&Trial>, _) = found.iter().partition(|trial| trial.verdict == Verdict::Error);
    assert!(whole.iter().all(|trial| **trial == undisturbed[trial.index]) && !whole.is_empty(), "{found:?}");
    assert!(broken.last().is_some_and(|trial| trial.index == 11), "{found:?}");
    for trial in broken {
        let error = trial.error().unwrap_or_default();
        assert!(error.starts_with("the driver got no images at ") && error.contains("camera `front`"), "{error}");
        assert!(error.contains("no graphics adapter was found (it was unplugged)"), "{error}");
    }
}

/// A driver that breaks where the car is too fast for it.
struct Fragile(Box<dyn Driver>);

impl Driver for Fragile {
    fn period(&self) -> f64 {
        self.0.period()
    }

    fn equipment(&mut self) -> Equipment {
        self.0.equipment()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.0.reset(briefing)
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.0.perceive(rig, images)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        match observation.speed {
            fast if fast > 12.0 => panic!("it is too fast"),
            fast if fast > 9.0 => Err(Fault::new("it is quite fast")),
            _ => self.0.step(observation),
        }
    }
}

#[test]
fn a_driver_that_breaks_breaks_its_own_test_alone() {
    if !can_draw() {
        return;
    }
    let study = study(&[]);
    let tests: Vec<Values> = (0..8)
        .map(|i| {
            let mut test = study.complete(&Values::default());
            test.set("speed", 6.0 + f64::from(i));
            test.set("turned", 0.01);
            test
        })
        .collect();
    let outcomes = |at_once: usize| {
        let lane_camera = || find("lane-camera").and_then(|kind| kind.build(&[])).expect("it comes with the engine");
        let make = || -> Result<Box<dyn Driver>, NoDriver> { Ok(Box::new(Fragile(lane_camera()))) };
        let mut first = Simulator::with(QUIET, VehicleSetup::default(), Drivers::made_by(make), None);
        first.start().unwrap();
        let darkroom = first.darkroom().cloned();
        let mut outcomes = Vec::new();
        let work = |desk: &Desk<Result<Outcome, Problem>>| {
            let mut simulator =
                Simulator::with(QUIET, VehicleSetup::default(), Drivers::made_by(make), darkroom.clone());
            let test = |i: usize| tests[i].clone();
            simulator.run_in_lockstep(desk, at_once, (&test, study.space()), || false, |_, outcome| outcome);
        };
        let sink = |outcome| {
            outcomes.push(outcome);
            Ok::<(), ()>(())
        };
        from_desk(&pool(2).unwrap(), 0..tests.len(), work, sink).unwrap();
        outcomes
    };
    let alone = outcomes(1);
    let message = |outcome: &Result<Outcome, Problem>| match outcome {
        Ok(outcome) => outcome.ending.message().unwrap_or_default(),
        Err(problem) => problem.message.clone(),
    };
    let errors: Vec<String> = alone.iter().map(message).collect();
    assert!(errors[..3].iter().all(std::string::String::is_empty), "{errors:?}");
    assert!(errors[4..6].iter().all(|error| error.contains("it is quite fast")), "{errors:?}");
    assert!(errors[7].contains("panicked: it is too fast"), "{errors:?}");
    assert!(outcomes(5) == alone);
}

#[test]
fn where_nothing_draws_a_driver_that_sees_ends_its_test_with_an_error() {
    let mut driver = find("lane-camera").unwrap().build(&[]).unwrap();
    let test = QUIET.declare().unwrap().nominal();
    let outcome = simulate(&QUIET, &test, VehicleSetup::default(), driver.as_mut());
    assert_eq!(outcome.verdict(), Verdict::Error);
    assert!(outcome.ending.message().unwrap().contains("camera `front`"));
}
