//! A defect costs no memory per step: once a driver with a defect has made some steps, it allocates nothing.

use nalgebra::Vector2;
use paracosm_engine::driver::{Driver, Fault};
use paracosm_engine::object::{Class, Outline};
use paracosm_engine::vehicle::Vehicle;
use paracosm_engine::{Briefing, Control, Observation, Other};
use paracosm_mutants::{ALL, Defect};

struct Nothing;

impl Driver for Nothing {
    fn period(&self) -> f64 {
        0.05
    }

    fn reset(&mut self, _briefing: &Briefing) -> Result<(), Fault> {
        Ok(())
    }

    fn step(&mut self, _observation: &Observation) -> Result<Control, Fault> {
        Ok(Control::default())
    }
}

fn bodies() -> Vec<Other> {
    let body = |id| Other {
        id,
        class: Class::Car,
        position: Vector2::new(10.0 + id as f64, 1.0),
        velocity: Vector2::new(5.0, 0.5),
        heading: 0.0,
        outline: Outline::Rectangle { length: 4.0, width: 1.8 },
    };
    (0..20).map(body).collect()
}

#[test]
fn a_driver_with_a_defect_allocates_nothing_after_its_first_seconds() {
    let mut observation = Observation { speed: 12.0, others: bodies(), ..Observation::default() };
    for kind in ALL {
        for &size in kind.sizes {
            let mut driver = Defect::new(kind.name, size).unwrap().in_driver(Box::new(Nothing));
            driver.reset(&Briefing { cruise_speed: 15.0, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
            let mut drive = |steps: std::ops::Range<usize>| {
                for step in steps {
                    observation.time = 0.05 * step as f64;
                    driver.step(&observation).unwrap();
                }
            };
            // The answers of a busy driver wait for up to 24 s.
            drive(0..600);
            let found = allocation_counter::measure(|| drive(600..800));
            assert_eq!(found.count_total, 0, "{} {size}", kind.name);
        }
    }
}
