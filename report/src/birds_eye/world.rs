//! A picture of a world as it begins: roads, bodies, and planned ways.

use super::body::{UNDER_TEST, body, class_colour, extent, is_actor};
use super::drawing::{Contour, Drawing, Paint, PictureItem};
use super::ground::{directions, ground, seen_from};
use super::legend::{Entry, PAPER, PLAN_DASH, entries, legend};
use super::view::{View, across, with_margin};
use nalgebra::Vector2;
use paracosm_engine::Run;
use paracosm_engine::object::BodyState;
use paracosm_engine::road::{Bounds, Path, RoadNetwork};

/// The width of a picture in pixels.
const WIDTH: f64 = 1200.0;
/// The greatest extent in metres of the ground that is shown because of planned ways alone.
const WIDEST: f64 = 240.0;
/// The possible lengths in metres of the shown part of planned ways: the first for which the picture is not too wide.
const REACHES: [f64; 6] = [f64::INFINITY, 320.0, 160.0, 80.0, 40.0, 0.0];
/// The distance in metres from an actor or a planned way within which other bodies are shown.
pub(super) const NEAR: f64 = 16.0;
/// The greatest total length of planned ways in metres, so that roads are still seen; the rest of each way is left out.
const MOST: f64 = 5000.0;
/// The distance in metres between two points of a planned way.
const STEP: f64 = 1.0;
/// The opacity of a planned way.
const FAINT: f64 = 0.9;

/// Returns a bird's-eye picture of the world of a run at the present tick, with a caption.
pub fn world(run: &Run, caption: &str) -> Drawing {
    let bodies = run.bodies();
    let plans = run.plans();
    let view = View::fit(&around(run.network(), bodies, &plans), WIDTH);
    let mut marks = ground(&view, run.network());
    marks.push(directions(&view, run.network()));
    let mut shown: Vec<usize> = Vec::new();
    let all = |reach: &f64| plans.iter().map(|(_, path)| path.length().min(*reach)).sum::<f64>() <= MOST;
    let reach = REACHES.into_iter().find(all).unwrap_or(0.0);
    for (index, path) in plans.iter().filter(|(_, path)| path.length().min(reach) > 0.0) {
        if bodies.get(*index).is_some_and(|state| view.shows(state.pose.position, 0.0)) {
            shown.push(*index);
            let path = path.piece(0.0, reach);
            let colour = if *index == 0 { UNDER_TEST } else { class_colour(bodies[*index].body.class) };
            marks.extend(plan(&view, &path, Paint { colour, opacity: FAINT }));
        }
    }
    marks.push(heading(&view, &bodies[0]));
    let seen = (0..bodies.len()).filter(|i| view.shows(bodies[*i].pose.position, 0.0));
    let seen: Vec<usize> = seen.collect();
    // The ego vehicle lies on top.
    for i in (0..bodies.len()).rev() {
        let colour = if i == 0 { UNDER_TEST } else { class_colour(bodies[i].body.class) };
        marks.extend(body(&view, &bodies[i].body, &bodies[i].pose, colour, 1.0));
    }
    let mut entries = entries(seen.iter().map(|i| &bodies[*i].body));
    if !shown.is_empty() {
        entries.push(Entry::Plan);
    }
    framed(&view, vec![marks], &entries, caption)
}

/// Puts pictures of one size below each other, and the legend below them.
pub(super) fn framed(view: &View, panels: Vec<Vec<PictureItem>>, entries: &[Entry], caption: &str) -> Drawing {
    const GAP: f64 = 4.0;
    let [width, height] = view.size();
    let mut marks = Vec::new();
    let mut y = 0.0;
    for panel in panels {
        marks.push(PictureItem::Inset { at: [0.0, y], drawing: Drawing { width, height, marks: panel } });
        y += height + GAP;
    }
    let legend = legend(width, view.scale, entries, caption);
    y -= GAP;
    let total = y + legend.height;
    marks.push(PictureItem::Inset { at: [0.0, y], drawing: legend });
    Drawing { width, height: total, marks }
}

/// Returns the bounds of the actors, their planned ways, the road across, and the other bodies nearby.
fn around(network: &RoadNetwork, bodies: &[BodyState], plans: &[(usize, Path)]) -> Bounds {
    let actors = bodies.iter().enumerate().filter(|(i, state)| *i == 0 || is_actor(state.body.class));
    let actors: Vec<_> = actors.map(|(_, state)| state.pose.position).collect();
    let across = across(network, actors.iter().copied());
    let reaching = |reach: f64| {
        let ways = plans.iter().flat_map(|(_, path)| points(path, path.length().min(reach)));
        let points: Vec<_> = actors.iter().copied().chain(ways).collect();
        let near =
            bodies.iter().filter(|state| points.iter().any(|point| (state.pose.position - point).norm() <= NEAR));
        let near = near.map(|state| Bounds::around([state.pose.position]).grown(extent(&state.body) + 1.0));
        near.fold(with_margin(&Bounds::around(points.iter().copied())).union(&across), |all, body| all.union(&body))
    };
    let mut views = REACHES.iter().map(|reach| reaching(*reach));
    views.find(|bounds| (bounds.max - bounds.min).max() <= WIDEST).unwrap_or_else(|| reaching(0.0))
}

/// Returns evenly spaced points along the first `length` metres of a path.
fn points(path: &Path, length: f64) -> impl Iterator<Item = Vector2<f64>> {
    let count = (length / STEP).ceil().clamp(1.0, 10_000.0) as usize;
    (0..=count).map(move |i| path.at(length * i as f64 / count as f64).position)
}

/// Draws a planned way with an arrow at its end.
fn plan(view: &View, path: &Path, paint: Paint) -> Vec<PictureItem> {
    let mut contour = Contour::default();
    for curve in path.curves() {
        let piece = view.curve(curve, 0.0);
        let again = usize::from(!contour.segments.is_empty());
        contour.segments.extend(&piece.segments[again..]);
    }
    let end = path.at(path.length());
    let size = 9.0 / view.scale;
    let head = [(0.3, 0.0), (-1.0, 0.55), (-1.0, -0.55)].map(|(x, y)| view.at(seen_from(&end, x * size, y * size)));
    let rim = contour.clone().dashed(Paint { colour: PAPER, opacity: 0.4 }, 4.5, PLAN_DASH);
    vec![rim, contour.dashed(paint, 2.5, PLAN_DASH), Contour::polygon(head).fill(paint)]
}

/// Draws an arrow in front of the ego vehicle, which shows its heading. Its driver decides where the car goes, so no
/// way is drawn.
fn heading(view: &View, car: &BodyState) -> PictureItem {
    let front = car.body.outline.half_extent().x + 6.0 / view.scale;
    let size = 1.0 / view.scale;
    let half = [(0.0, 2.0), (20.0, 2.0), (20.0, 6.5), (31.0, 0.0)];
    let other = half.iter().rev().skip(1).map(|(x, y)| (*x, -y));
    let corners = half.into_iter().chain(other);
    let corners = corners.map(|(x, y)| view.at(seen_from(&car.pose, front + x * size, y * size)));
    Contour::polygon(corners).fill(UNDER_TEST)
}
