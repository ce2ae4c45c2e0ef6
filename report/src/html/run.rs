//! The record of a run that a page plays: the bodies, their motion, the signals, and the bounds of the robustness over time.
//!
//! A moment is recorded every tenth of a second, and at the end of the run. Lengths are whole centimetres and angles whole milliradians, each as
//! the difference from the moment before: so a run takes a few kilobytes.

use super::roads::{Ground, near};
use super::whole::differences;
use crate::margin;
use paracosm_campaign::{Number, Study};
use paracosm_engine::object::{Body, Class, Outline};
use paracosm_engine::road::{Bounds, RoadNetwork};
use paracosm_engine::signal::about;
use paracosm_engine::{Pose, Run};
use paracosm_oracles::Trace;
use serde::Serialize;
use std::sync::Arc;

/// The seconds between two moments.
const INTERVAL: f64 = 0.1;
/// The distance in metres around the ego vehicle within which the page shows roads.
const AROUND: f64 = 120.0;

/// Records a run while it is watched.
#[derive(Default)]
pub(crate) struct Recorder {
    scene: Option<Scene>,
    times: Vec<f64>,
    /// For each moment the pose of each body, or `None` if the body is not in the world.
    moments: Vec<Vec<Option<Pose>>>,
    touched: Option<usize>,
}

/// The roads of a run, and its bodies with their names.
type Scene = (Arc<RoadNetwork>, Vec<(String, Body)>);

/// A recorded run, as the page reads it.
#[derive(Debug, Serialize)]
pub(crate) struct Record {
    index: usize,
    verdict: String,
    /// The seconds of each moment.
    times: Vec<f64>,
    bodies: Vec<Played>,
    /// The position of the body that the ego vehicle touches at the end.
    touched: Option<usize>,
    pub(super) roads: Vec<Ground>,
    signals: Vec<Curve>,
    robustness: Vec<Margin>,
}

#[derive(Debug, Serialize)]
struct Played {
    name: String,
    class: String,
    length: f64,
    width: f64,
    /// True if the body is a disc, whose diameter is the length.
    round: bool,
    height: f64,
    /// x and y in centimetres and the heading in milliradians, as differences: one triple if the body never moves.
    poses: Vec<i32>,
    /// The first moment at which the body is in the world, and the first moment at which it no longer is.
    there: [usize; 2],
}

#[derive(Debug, Serialize)]
struct Curve {
    name: String,
    /// The unit of the values; empty if they have none, or if the signal is not one of the software.
    unit: &'static str,
    values: Vec<Option<f32>>,
}

/// The bounds of the robustness of a requirement over time: what follows can only lower the upper one and raise the lower one.
#[derive(Debug, Serialize)]
struct Margin {
    id: String,
    unit: String,
    /// `None` while the bound is infinite.
    lower: Vec<Option<f32>>,
    upper: Vec<Option<f32>>,
    /// The robustness of the whole run; null if it is undecided.
    end: Number,
}

impl Recorder {
    /// Records the present moment of a run, if it is time for one.
    pub fn see(&mut self, run: &Run) {
        let bodies = run.bodies();
        if self.scene.is_none() {
            let named = bodies.iter().enumerate().map(|(at, state)| (run.name_of(at).to_owned(), state.body));
            self.scene = Some((run.network().clone(), named.collect()));
        }
        let time = run.time();
        let is_due = self.times.last().is_none_or(|last| time >= last + INTERVAL - 1e-9);
        self.touched = run.touched();
        if !(is_due || run.is_over()) || !bodies.iter().all(|state| state.pose.is_finite()) {
            return;
        }
        if self.times.last() == Some(&time) {
            self.times.pop();
            self.moments.pop();
        }
        self.times.push(time);
        self.moments.push(bodies.iter().map(|state| state.present.then_some(state.pose)).collect());
    }

    /// Returns the record of the run of a test; `None` if its world could not be built.
    pub fn record(self, study: &Study, index: usize, verdict: String, trace: Option<&Trace>) -> Option<Record> {
        let (network, bodies) = self.scene?;
        self.moments.first()?;
        let mut bounds = Bounds::empty();
        self.moments.iter().filter_map(|moment| moment[0]).for_each(|pose| bounds.include(pose.position));
        let played = bodies.iter().enumerate().filter_map(|(at, (name, body))| {
            let poses: Vec<Option<Pose>> = self.moments.iter().map(|moment| moment[at]).collect();
            let is_near = |pose: &Pose| bounds.grown(AROUND).meets(&Bounds::around([pose.position]));
            (at == 0 || body.class.is_road_user() || poses.iter().flatten().any(is_near))
                .then(|| (at, played(name, body, &poses)))
        });
        let (places, bodies): (Vec<usize>, Vec<Played>) = played.unzip();
        let touched = self.touched.and_then(|touched| places.iter().position(|at| *at == touched));
        let ticks = |trace: &Trace| -> Vec<usize> {
            let last = trace.len().saturating_sub(1);
            self.times.iter().map(|time| ((time / trace.dt()).round() as usize).min(last)).collect()
        };
        let (signals, robustness) = match trace.filter(|trace| !trace.is_empty()) {
            None => (Vec::new(), Vec::new()),
            Some(trace) => (signals(trace, &ticks(trace)), robustness(study, trace, &ticks(trace))),
        };
        let times = self.times.iter().map(|time| (time * 1000.0).round() / 1000.0).collect();
        let roads = near(&network, &stepped(&bounds.grown(AROUND)));
        Some(Record { index, verdict, times, bodies, touched, roads, signals, robustness })
    }
}

/// Returns bounds at whole steps of 100 m, so that runs in the same place have the same roads.
fn stepped(bounds: &Bounds) -> Bounds {
    let step = |number: f64, whole: fn(f64) -> f64| 100.0 * whole(0.01 * number);
    Bounds {
        min: bounds.min.map(|number| step(number, f64::floor)),
        max: bounds.max.map(|number| step(number, f64::ceil)),
    }
}

fn played(name: &str, body: &Body, poses: &[Option<Pose>]) -> Played {
    let half = body.outline.half_extent();
    let first = poses.iter().position(Option::is_some).unwrap_or_default();
    let end = poses.iter().rposition(Option::is_some).map_or(first, |last| last + 1);
    let there: Vec<&Pose> = poses[first..end].iter().flatten().collect();
    let whole = |pose: &Pose| {
        [100.0 * pose.position.x, 100.0 * pose.position.y, 1000.0 * pose.heading].map(|number| number.round() as i32)
    };
    let mut numbers: Vec<[i32; 3]> = there.into_iter().map(whole).collect();
    if numbers.iter().all(|pose| Some(pose) == numbers.first()) {
        numbers.truncate(1);
    }
    Played {
        name: name.to_owned(),
        class: if body.class == Class::Prop { "prop".to_owned() } else { body.class.to_string() },
        length: 2.0 * half.x,
        width: 2.0 * half.y,
        round: matches!(body.outline, Outline::Disc { .. }),
        height: body.height,
        poses: differences(numbers),
        there: [first, end],
    }
}

fn rounded(number: f64) -> Option<f32> {
    // Five digits are enough to be read from a curve.
    number.is_finite().then(|| format!("{number:.4e}").parse().unwrap_or_default())
}

fn signals(trace: &Trace, ticks: &[usize]) -> Vec<Curve> {
    let rows: Vec<&[f64]> = trace.rows().collect();
    let curve = |(column, name): (usize, &String)| Curve {
        name: name.clone(),
        unit: about(name).map_or("", |about| about.unit),
        values: ticks.iter().map(|tick| rounded(rows[*tick][column])).collect(),
    };
    trace.signals().iter().enumerate().map(curve).collect()
}

fn robustness(study: &Study, trace: &Trace, ticks: &[usize]) -> Vec<Margin> {
    let told = |margin: margin::Margin<'_>| {
        let of = |side: fn(&(f64, f64)) -> f64| ticks.iter().map(|tick| rounded(side(&margin.bounds[*tick]))).collect();
        let (lower, upper) = (of(|bounds| bounds.0), of(|bounds| bounds.1));
        let (id, unit) = (margin.requirement.id.clone(), margin.requirement.unit.clone());
        Margin { id, unit, lower, upper, end: Number(margin.end) }
    };
    margin::margins(study, trace).into_iter().map(told).collect()
}
