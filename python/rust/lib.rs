//! The compiled module `paracosm._core` of the Python package. It hands the library to Python: it reads arguments, calls the library, and
//! gives the results back as arrays, tables and exceptions. It decides nothing.

mod arrays;
mod bracket;
mod busy;
mod choices;
mod comparison;
mod covering;
mod crew;
mod detached;
mod driver;
mod ending;
mod episode;
mod error;
mod failure_map;
mod formula;
mod generator;
mod inquiries;
mod json;
mod measures;
mod notebook;
mod outcome;
mod own_strategy;
mod plan;
mod programs;
mod progress;
mod report;
mod sensors;
mod space;
mod station;
mod study;
mod system;
mod table;
mod test_table;
mod threads;
mod trials;
mod value;
mod whole;
mod world;

/// The compiled part of the package `paracosm`, which re-exports its names.
#[pyo3::pymodule]
mod _core {
    #[pymodule_export]
    use crate::{
        bracket::Bracket,
        comparison::{Comparison, compare},
        covering::{CoveringArray, covering_array},
        episode::Episode,
        error::Error,
        failure_map::FailureMap,
        formula::{Evaluation, Formula, Trace},
        generator::{Generator, sample, strategies},
        measures::{coverage, measure, measures},
        plan::plan,
        programs::{cover, fuzz},
        report::{Report, TrialView, load},
        space::Space,
        station::{Station, scenario_files, without_sampling},
        study::Study,
        table::Table,
        test_table::Tests,
        trials::Trials,
        world::{
            Actor, AutonomousVehicle, Car, Composite, Conditions, CrossIntersection, Effect, Environment,
            EnvironmentCars, Fixture, Fleet, Line, Monitor, Mover, Path, Pedestrian, Pose, Program, Road, RoadNetwork,
            RoadSegment, Roadside, Roundabout, Scenario, Stream, Streets, TIntersection, Temporal, TrafficCar, Walk,
            Walker, always, eventually, grid_city, historically, never, once, scenarios, until,
        },
    };

    #[pymodule_init]
    fn init(module: &pyo3::Bound<pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        crate::ending::register(module)
    }
}
