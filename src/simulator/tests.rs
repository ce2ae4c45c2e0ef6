//! The closed loop with eyes in it: whatever is drawn together, every test is the same.

mod bends;

use super::*;
use crate::executor::{from_desk, pool};
use crate::record::tests::can_draw;
use crate::record::{Developed, Film, Projector};
use crate::{Campaign, Study, Trial, Worker};
use paracosm_engine::driver::{Driver, Equipment, Fault, find};
use paracosm_engine::sensor::{Image, Rig};
use paracosm_engine::{
    AutonomousVehicle, Briefing, Control, Environment, Monitor, Observation, RoadSegment, Scenario, simulate,
};
use paracosm_oracles::Verdict;
use paracosm_render::{Outputs, RenderError, Renderer, Stages};
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::Ordering;

const QUIET: Program = Program { name: "quiet-road", about: "a car alone on a road", build: quiet_road };

fn quiet_road(s: &mut Scenario) {
    let speed = s.interval("speed", 5.0..=15.0).unit("m/s");
    let turned = s.interval("turned", -0.1..=0.1).unit("rad");
    let fog = s.nominal("fog", 0.0..=1.0, 0.0);
    let light = s.nominal("light", 0.0..=1.0, 1.0);
    let rain = s.nominal("rain", 0.0..=1.0, 0.0);
    let road = s.place(RoadSegment::new(200.0));
    s.place(Environment::new().light(light).fog(fog).rain(rain));
    let start = road.on_lane(1, 10.0);
    let start = paracosm_engine::Pose { heading: start.heading + turned.value(), ..start };
    let car = s.place(AutonomousVehicle::at(start).speed(speed.value()));
    s.duration(3.0);
    s.monitor(Monitor::lane_keeping(&car));
    s.monitor(Monitor::progress(&car, 12.0));
}

fn study(changes: &[(&str, f64)]) -> Study {
    let changes: Vec<_> = changes.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let study = Study::new(QUIET).expect("a sound program").driver("lane-camera", &changes);
    study.and_then(|study| study.budget(7)).expect("a sound study")
}

fn trials(campaign: Campaign<'_>) -> Vec<Trial> {
    let mut trials = Vec::new();
    let run = campaign.run(|trial| {
        trials.push(trial.clone());
        Ok(())
    });
    run.map(|()| trials).expect("it runs")
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
    let rainy = study(&[]).open("rain", None).unwrap();
    let once = trials(Campaign::new(&rainy).unwrap().jobs(number(1)).at_once(number(1)));
    assert!(trials(Campaign::new(&rainy).unwrap().jobs(number(2)).at_once(number(5))) == once);

    let trial = trials(Campaign::new(&study(&[])).unwrap()).swap_remove(0);
    let cameras = find("lane-camera").unwrap().build(&[]).unwrap().equipment().cameras;
    let dry = study(&[]);
    let filmed = |rain: Option<f64>| {
        let mut worker = Worker::new(&dry).unwrap();
        let mut trial = trial.clone();
        if let Some(rain) = rain {
            trial.test.set("rain", rain);
            trial = worker.run(0, &trial.test).0;
        }
        let film = Film::of(&mut worker, &trial, &cameras, &Stages::default()).unwrap();
        let mut first = None;
        let mut projector = Projector::new(&cameras, Outputs { rgb: true, ..Outputs::default() }).unwrap();
        let show = |pictures: Vec<Developed<'_>>| {
            first = first.take().or_else(|| pictures.into_iter().next()?.1.ok()?.frame.rgb);
            Ok(())
        };
        projector.show(&film, 0, show).unwrap();
        first.expect("it has an image")
    };
    let none = filmed(None);
    assert!(filmed(Some(0.0)) == none);
    let apart = |rain: f64| -> u64 {
        filmed(Some(rain)).iter().zip(&none).map(|(wet, dry)| u64::from(wet.abs_diff(*dry))).sum()
    };
    let (little, much) = (apart(0.1), apart(1.0));
    assert!(0 < little && little < much, "{little} and {much}");
}

#[test]
fn a_campaign_of_drivers_that_see_is_stopped_and_goes_on() {
    if !can_draw() {
        return;
    }
    let foggy = study(&[("setback", 3.0)]).stop_at_first(true);
    let all = trials(Campaign::new(&study(&[("setback", 3.0)])).unwrap());
    let first = all.iter().position(Trial::is_failure).expect("the driver is set to leave its lane");
    assert!(trials(Campaign::new(&foggy).unwrap()) == all[..=first]);

    let study = study(&[("setback", 3.0)]);
    let campaign = Campaign::new(&study).unwrap().at_once(number(4));
    let (stop, mut seen) = (campaign.stop(), Vec::new());
    let stopped = campaign.run(|trial| {
        seen.push(trial.clone());
        if seen.len() == 2 {
            stop.store(true, Ordering::Relaxed);
        }
        Ok(())
    });
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
    let run = campaign.run(|trial| {
        if trials.is_empty() {
            darkroom.lose(open);
        }
        trials.push(trial.clone());
        Ok(())
    });
    run.map(|()| trials).expect("it goes on")
}

#[test]
fn a_campaign_whose_device_is_lost_draws_with_a_new_one_and_its_trials_are_the_same() {
    if !can_draw() {
        return;
    }
    let study = study(&[]).budget(12).unwrap();
    assert!(trials_with_a_loss(&study, Renderer::new) == trials(Campaign::new(&study).unwrap()));
}

#[test]
fn where_there_is_no_new_device_the_tests_under_way_are_errors_that_say_so_and_the_campaign_goes_on() {
    if !can_draw() {
        return;
    }
    let study = study(&[]).budget(12).unwrap();
    let undisturbed = trials(Campaign::new(&study).unwrap());
    let found = trials_with_a_loss(&study, || Err(RenderError::NoAdapter("it was unplugged".to_owned())));
    assert_eq!(found.len(), 12);
    let (broken, whole): (Vec<&Trial>, _) = found.iter().partition(|trial| trial.verdict == Verdict::Error);
    assert!(whole.iter().all(|trial| **trial == undisturbed[trial.index]) && !whole.is_empty(), "{found:?}");
    assert!(broken.last().is_some_and(|trial| trial.index == 11), "{found:?}");
    for trial in broken {
        let error = trial.error.as_deref().unwrap_or_default();
        assert!(error.starts_with("the driver could not see at ") && error.contains("camera `front`"), "{error}");
        assert!(error.contains("no graphics adapter was found (it was unplugged)"), "{error}");
    }
}

/// A driver that keeps what another one is shown, and when.
struct Witness {
    driver: Box<dyn Driver>,
    /// Images that have come, and not been asked about.
    new: Vec<Image>,
    shown: Arc<Mutex<Vec<(f64, Image)>>>,
}

impl Driver for Witness {
    fn period(&self) -> f64 {
        self.driver.period()
    }

    fn equipment(&mut self) -> Equipment {
        self.driver.equipment()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.driver.reset(briefing)
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.new = images.to_vec();
        self.driver.perceive(rig, images)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let shown = self.new.drain(..).map(|image| (observation.time, image));
        self.shown.lock().unwrap().extend(shown);
        self.driver.step(observation)
    }
}

#[test]
fn a_driver_sees_what_a_recording_shows_after_its_latency_and_but_for_what_is_lost() {
    if !can_draw() {
        return;
    }
    let study = study(&[("blur", 0.8), ("latency", 0.12), ("dropped", 0.3)]);
    let trial = trials(Campaign::new(&study).unwrap()).swap_remove(2);
    let changes = [("blur", 0.8), ("latency", 0.12), ("dropped", 0.3)].map(|(name, value)| (name.to_owned(), value));
    let shown = Arc::<Mutex<Vec<(f64, Image)>>>::default();
    let make = || -> Result<Box<dyn Driver>, Error> {
        let driver = find("lane-camera")?.build(&changes)?;
        Ok(Box::new(Witness { driver, new: Vec::new(), shown: shown.clone() }))
    };
    let cameras = make().unwrap().equipment().cameras;
    let mut simulator = Simulator::with(QUIET, Model::default(), Drivers::made_by(make), None);
    let values = study.complete(&trial.test);
    let outcome = simulator.run(Test::new(&values, &study.space));
    assert_eq!(outcome.trace.map(|trace| trace.hash()), trial.trace_hash);

    let mut worker = Worker::new(&study).unwrap();
    assert_eq!(worker.eyes().unwrap(), cameras);
    let film = Film::of(&mut worker, &trial, &cameras, &Stages::default()).unwrap();
    let mut recorded = Vec::new();
    let mut projector = Projector::new(&cameras, Outputs { rgb: true, ..Outputs::default() }).unwrap();
    let show = |pictures: Vec<crate::record::Developed<'_>>| {
        recorded.extend(pictures.into_iter().map(|(shot, picture)| (shot.number, picture.unwrap().frame.rgb.unwrap())));
        Ok(())
    };
    projector.show(&film, 0, show).unwrap();
    let shown = std::mem::take(&mut *shown.lock().unwrap());
    assert!(shown.len() > 10 && shown.len() < 28, "{} of 30 images", shown.len());
    for ((asked, image), (number, rgb)) in shown.iter().zip(&recorded) {
        let late = asked - image.time;
        assert!((0.12..0.17 + 1e-9).contains(&(late + 1e-9)), "{late} s");
        assert_eq!(image.number, *number);
        assert!((image.time - 0.1 * *number as f64).abs() < 1e-9, "{} s", image.time);
        assert!(image.rgb == *rgb, "image {number}");
    }
    // The last may come when the test is over.
    assert!(recorded.len() - shown.len() <= 1);
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
            fast if fast > 9.0 => Err(Fault("it is quite fast".to_owned())),
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
        let make = || -> Result<Box<dyn Driver>, Error> { Ok(Box::new(Fragile(find("lane-camera")?.build(&[])?))) };
        let mut first = Simulator::with(QUIET, Model::default(), Drivers::made_by(make), None);
        first.start().unwrap();
        let darkroom = first.darkroom().cloned();
        let mut outcomes = Vec::new();
        let work = |desk: &Desk<Outcome>| {
            let mut simulator = Simulator::with(QUIET, Model::default(), Drivers::made_by(make), darkroom.clone());
            let test = |i: usize| tests[i].clone();
            simulator.run_in_lockstep(desk, at_once, (&test, &study.space), || false, |_, outcome| outcome);
        };
        let sink = |outcome| {
            outcomes.push(outcome);
            Ok::<(), ()>(())
        };
        from_desk(&pool(2).unwrap(), 0..tests.len(), work, sink).unwrap();
        outcomes
    };
    let alone = outcomes(1);
    let errors: Vec<_> = alone.iter().map(|outcome| outcome.error.as_deref().unwrap_or_default()).collect();
    assert!(errors[..3].iter().all(|error| error.is_empty()), "{errors:?}");
    assert!(errors[4..6].iter().all(|error| error.contains("it is quite fast")), "{errors:?}");
    assert!(errors[7].contains("panicked: it is too fast"), "{errors:?}");
    assert!(outcomes(5) == alone);
}

#[test]
fn where_nothing_draws_a_driver_that_sees_ends_its_test_with_an_error() {
    let mut driver = find("lane-camera").unwrap().build(&[]).unwrap();
    let test = QUIET.declare().unwrap().nominal();
    let outcome = simulate(&QUIET, &test, Model::default(), driver.as_mut());
    assert_eq!(outcome.verdict, Verdict::Error);
    assert!(outcome.error.unwrap().contains("camera `front`"));
}
