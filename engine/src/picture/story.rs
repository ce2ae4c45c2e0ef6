//! A whole run on one picture: the ways that were gone, with ghosts of the bodies at round times. Where the way of the
//! car under test is too long for one view, there are several below each other.

use super::body::{UNDER_TEST, body, class_colour};
use super::drawing::{Colour, Contour, Drawing, Mark, Paint, Pixel};
use super::ground::{ground, seen_from};
use super::labels::Labels;
use super::legend::{Entry, INK, contact, entries};
use super::pages::{Page, pages};
use super::record::{Record, Scene};
use super::view::View;
use super::world::framed;
use nalgebra::Vector2;
use std::ops::Range;

/// Width of a picture in pixels.
const WIDTH: f64 = 1200.0;
/// How many ghosts of a body a page has at most.
const GHOSTS: f64 = 9.0;
/// Seconds that may lie between two ghosts.
const STEPS: [f64; 9] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
/// How much there is of a ghost.
const GHOST: f64 = 0.4;
/// Width in pixels of the way that a body went.
const WAY: f64 = 2.0;
/// By how many pixels the drawn way may be off.
const FAITHFUL: f64 = 0.2;

impl Record {
    /// The run from beginning to end; `caption` stands below it. Nothing where nothing was seen.
    pub fn story(&self, caption: &str) -> Option<Drawing> {
        let scene = self.scene.as_ref().filter(|_| !self.is_empty())?;
        let pages = pages(self, scene, WIDTH);
        let panels = pages.iter().map(|page| self.panel(scene, page)).collect();
        Some(framed(&pages[0].view, panels, &self.entries(scene, &pages), caption))
    }

    /// The legend for what is seen on these pages.
    pub(super) fn entries(&self, scene: &Scene, pages: &[Page]) -> Vec<Entry> {
        let on = |i: usize, page: &Page| {
            let mut poses = self.moments[page.moments.clone()].iter().map(|moment| moment.poses[i]);
            poses.any(|pose| page.view.shows(pose.position, 0.0))
        };
        let seen = (0..scene.bodies.len()).filter(|i| *i == 0 || pages.iter().any(|page| on(*i, page)));
        let mut entries = entries(seen.map(|i| &scene.bodies[i]));
        entries.extend(self.touched.map(|_| Entry::Contact));
        entries
    }

    fn panel(&self, scene: &Scene, page: &Page) -> Vec<Mark> {
        let view = &page.view;
        let mut marks = ground(view, &scene.network);
        let colour = |i: usize| if i == 0 { UNDER_TEST } else { class_colour(scene.bodies[i].class) };
        let last = page.moments.end - 1;
        let times = self.round_times(page);
        let moving: Vec<bool> = (0..scene.bodies.len()).map(|i| self.moves(i, page.moments.clone())).collect();
        for (i, _) in moving.iter().enumerate().filter(|(_, moving)| !**moving) {
            marks.extend(body(view, &scene.bodies[i], &self.moments[last].poses[i], colour(i), 1.0));
        }
        for &moment in times.iter().filter(|moment| **moment != last) {
            // The car under test lies on top.
            for i in (0..moving.len()).rev().filter(|i| moving[*i]) {
                marks.extend(body(view, &scene.bodies[i], &self.moments[moment].poses[i], colour(i), GHOST));
            }
        }
        for i in (0..moving.len()).rev().filter(|i| moving[*i]) {
            marks.push(self.way(view, i, page.moments.clone()).stroke(colour(i), WAY));
            marks.extend(body(view, &scene.bodies[i], &self.moments[last].poses[i], colour(i), 1.0));
        }
        marks.extend(self.time_marks(scene, page, &times, &moving));
        marks
    }

    /// The moments of ghosts: round times, and the end.
    fn round_times(&self, page: &Page) -> Vec<usize> {
        let moments = &self.moments[page.moments.clone()];
        let (from, to) = (moments[0].time, moments[moments.len() - 1].time);
        let step = STEPS.into_iter().find(|step| (to - from) / step <= GHOSTS).unwrap_or((to - from) / GHOSTS);
        let mut times = Vec::new();
        let mut due = (from / step).ceil() * step;
        for (i, moment) in page.moments.clone().zip(moments) {
            if moment.time >= due - 1e-9 {
                times.push(i);
                due = ((moment.time + 1e-9) / step).floor() * step + step;
            }
        }
        times
    }

    /// Dots with times on the ways, and the contact.
    fn time_marks(&self, scene: &Scene, page: &Page, times: &[usize], moving: &[bool]) -> Vec<Mark> {
        let view = &page.view;
        let (mut dots, mut texts, mut labels) = (Vec::new(), Vec::new(), Labels::default());
        let end = page.moments.end - 1;
        if let Some(point) = self.point_of_contact(scene).filter(|_| end + 1 == self.moments.len()) {
            let at = view.at(point);
            dots.extend(contact(at, 11.0));
            labels.keep_off(at, 11.0);
            let text = format!("contact, {:.2} s", self.moments[end].time);
            texts.extend(labels.place(&text, INK, around(at, &[30.0, 50.0])));
        }
        for i in (0..moving.len()).filter(|i| moving[*i]) {
            let colour = if i == 0 { UNDER_TEST } else { class_colour(scene.bodies[i].class) };
            let aside = scene.bodies[i].outline.half_extent().y.min(1.5) + 11.0 / view.scale;
            let mut before: Option<Vector2<f64>> = None;
            for &moment in times {
                let pose = &self.moments[moment].poses[i];
                let stays = before.is_some_and(|before| (pose.position - before).norm() < 1.0);
                if stays || !view.shows(pose.position, -2.0) {
                    continue;
                }
                before = Some(pose.position);
                let at = view.at(pose.position);
                dots.extend([Contour::circle(at, 3.2).fill(INK), Contour::circle(at, 1.8).fill(super::legend::PAPER)]);
                let places = [-aside, aside].map(|left| view.at(seen_from(pose, 0.0, left)));
                let text = format!("{} s", rounded(self.moments[moment].time));
                texts.extend(labels.place(&text, INK, places));
            }
        }
        dots.extend(texts);
        dots
    }

    /// The way of a body in these moments.
    pub(super) fn way(&self, view: &View, body: usize, moments: Range<usize>) -> Contour {
        let points: Vec<Pixel> = self.moments[moments].iter().map(|m| view.at(m.poses[body].position)).collect();
        let mut kept = vec![points[0]];
        simplified(&points, &mut kept);
        Contour::polyline(kept)
    }
}

/// Places above, below and beside.
fn around([x, y]: Pixel, distances: &[f64]) -> Vec<Pixel> {
    let places = distances.iter().flat_map(|d| [[x, y - d], [x, y + d], [x + 2.0 * d, y], [x - 2.0 * d, y]]);
    places.collect()
}

/// To a tenth, without zeros at the end.
fn rounded(time: f64) -> String {
    format!("{}", (time * 10.0).round() / 10.0)
}

/// Adds the points after the first that a line needs to be right: the algorithm of Ramer (1972), Douglas and Peucker.
fn simplified(points: &[Pixel], kept: &mut Vec<Pixel>) {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
    let off = |p: &Pixel| {
        let (way, to) = (Vector2::from(*last) - Vector2::from(*first), Vector2::from(*p) - Vector2::from(*first));
        let along = (to.dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (to - way * along).norm()
    };
    let farthest = points.iter().map(off).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    match farthest {
        Some((i, distance)) if distance > FAITHFUL => {
            simplified(&points[..=i], kept);
            simplified(&points[i..], kept);
        }
        _ => kept.push(*last),
    }
}
