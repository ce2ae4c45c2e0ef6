//! Checks effects against traces: a parameter without effect changes none, and a parameter with an effect is never named.

use super::*;
use paracosm_campaign::{Catalogue, Learned, StudyBuilder};
use paracosm_engine::Program;
use paracosm_generators::Strategy;
use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// The number of drivers that each scenario is run with, each with another choice of open parameters.
const CHOICES: usize = 3;

fn builder(scenario: &str, driver: &str) -> StudyBuilder {
    let catalogue = Catalogue::of(paracosm_scenarios::ALL);
    Study::of(catalogue.find(scenario).unwrap()).driver(driver)
}

/// Runs a campaign of random tests and returns its log.
fn log(study: Study, tests: usize) -> Log {
    let sampling = paracosm_campaign::Sampling { strategy: Strategy::RANDOM, budget: tests, ..Default::default() };
    let study = study.sampled(sampling).unwrap();
    let points = study.generator(&[]).unwrap().ask(tests);
    let mut worker = Worker::new(&study).unwrap();
    let run = |(index, point): (usize, &Point)| worker.run(index, &study.space().decode(point)).0;
    let trials = points.iter().enumerate().map(run).collect();
    Log::new(study.clone(), Learned::new(), None, trials)
}

fn effects(log: &Log) -> Effects {
    let mut worker = Worker::new(log.study()).unwrap();
    Effects::of(log, |test, index| Ok(worker.run(index, test).0)).unwrap()
}

fn effect(effects: &Effects, parameter: &str) -> Effect {
    effects.0.iter().find(|one| one.parameter == parameter).unwrap().effect
}

#[test]
fn a_driver_without_sensors_does_not_see_fog_light_or_the_sun() {
    let opened = ["fog", "light", "sun_elevation", "sun_azimuth", "rain"];
    let study = opened.iter().fold(builder("pedestrian-crossing", "aeb"), |study, name| study.open(name));
    let log = log(study.build().unwrap(), 20);
    let effects = effects(&log);
    assert_eq!(
        effects.without_effect().map(|(name, _)| name).collect::<Vec<_>>(),
        ["fog", "light", "sun_elevation", "sun_azimuth"]
    );
    assert!(opened[..4].iter().all(|name| effect(&effects, name) == Effect::Unread));
    // Rain takes friction. Twenty tests are too few to say so.
    assert_eq!(effect(&effects, "rain"), Effect::Unknown);
    let json = serde_json::to_value(&effects).unwrap();
    assert_eq!(serde_json::from_value::<Effects>(json.clone()).unwrap(), effects);
    assert_eq!(json["without_effect"][0], "fog");
    assert_eq!(json["parameters"][0]["effect"], "unknown", "{json}");
}

#[test]
fn pairs_of_tests_tell_what_has_an_effect_and_what_has_none() {
    let crossing = paracosm_scenarios::find("pedestrian-crossing").unwrap();
    // The program asks for the value and does nothing with it, which no graph of streams tells.
    let program = Program::of("idle", "a crossing with an idle parameter", move |s| {
        crossing.build(s);
        s.interval("idle", 0.0..=1.0).value();
    });
    let log = log(Study::of(program).driver("aeb").open("fog").build().unwrap(), 100);
    let effects = effects(&log);
    assert_eq!([effect(&effects, "speed"), effect(&effects, "fog")], [Effect::Seen, Effect::Unread]);
    assert_eq!(effect(&effects, "idle"), Effect::unseen(10));
    let Effect::Unseen { pairs, at_most } = Effect::unseen(10) else { panic!("ten pairs") };
    assert!(pairs == 10 && (at_most - 0.2589).abs() < 1e-4);
    let words = Effect::unseen(100).in_words().unwrap();
    assert_eq!(words, "in 100 of 100 pairs of tests (an effect in at most 3.0 % of the space, 95 %)");
}

#[test]
fn a_parameter_that_counts_as_unread_changes_no_trace() {
    let mut rng = Pcg64::seed_from_u64(26);
    // Cameras are left out: they need a renderer.
    let drivers = paracosm_engine::driver::ALL.iter().map(|driver| driver.name).filter(|name| *name != "lane-camera");
    let drivers: Vec<&str> = drivers.collect();
    let mut unread = 0;
    for program in paracosm_scenarios::ALL {
        for driver in drivers.choose_multiple(&mut rng, CHOICES) {
            let builder = builder(program.name(), driver);
            let declared = program.declare().unwrap().parameters;
            let closed: Vec<&str> = declared
                .iter()
                .filter(|one| !one.open && one.parameter.levels().is_none())
                .map(|one| &*one.parameter.name)
                .collect();
            let chosen: Vec<&&str> = closed.choose_multiple(&mut rng, 4).collect();
            let Ok(study) = chosen.iter().fold(builder, |study, name| study.open(name)).build() else { continue };
            let log = log(study, 6);
            let space = log.study().space();
            let effects = effects(&log);
            let mut worker = Worker::new(log.study()).unwrap();
            for (name, _) in effects.without_effect() {
                unread += 1;
                for trial in log.trials() {
                    let mut point = space.encode(&trial.test).unwrap();
                    for (coordinate, at) in space.continuous().zip(&mut point.continuous) {
                        if coordinate.parameter.name == name {
                            *at = rng.random();
                        }
                    }
                    let (other, _) = worker.run(0, &space.decode(&point));
                    assert!(is_same(trial, &other), "{} with {driver}: {name}", program.name());
                }
            }
        }
    }
    assert!(unread > 20, "{unread}");
}
