//! The compiled module `paracosm._core` of the Python package. It hands the library to Python: it reads arguments, calls the library, and
//! gives the results back as arrays, tables and exceptions. It decides nothing.

mod arrays;
mod bracket;
mod busy;
mod choices;
mod covering;
mod detached;
mod driver;
mod error;
mod formula;
mod generator;
mod inquiries;
mod json;
mod measures;
mod plan;
mod programs;
mod report;
mod sensors;
mod space;
mod study;
mod system;
mod table;
mod test_table;
mod trials;
mod value;
mod world;

/// The compiled part of the package `paracosm`, which re-exports its names.
#[pyo3::pymodule]
mod _core {
    #[pymodule_export]
    use crate::{
        bracket::Bracket,
        covering::{CoveringArray, covering_array},
        error::Error,
        formula::{Evaluation, Formula, Trace},
        generator::{Generator, sample, strategies},
        measures::{coverage, measure, measures},
        plan::plan,
        programs::{cover, fuzz},
        report::{Report, TrialView, load},
        space::Space,
        study::Study,
        table::Table,
        test_table::Tests,
        world::{
            Actor, AutonomousVehicle, Car, Composite, Conditions, CrossIntersection, Effect, Environment,
            EnvironmentCars, Fixture, Fleet, Line, Monitor, Mover, Path, Pedestrian, Pose, Program, Road, RoadNetwork,
            RoadSegment, Roadside, Roundabout, Scenario, Stream, Streets, TIntersection, Temporal, TrafficCar, Walk,
            Walker, always, eventually, grid_city, historically, never, once, until,
        },
    };
}
