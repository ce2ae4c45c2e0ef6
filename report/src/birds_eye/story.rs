//! A whole run on one picture: the ways of the bodies, with ghosts of the bodies at round times. If the way of the car
//! under test is too long for one view, there are several views below each other.

use super::body::{UNDER_TEST, body, class_colour};
use super::drawing::{Contour, Drawing, PictureItem, Pixel};
use super::ground::ground;
use super::labels::Labels;
use super::legend::{Entry, INK, PAPER, contact, entries};
use super::pages::{Page, pages};
use super::record::{Moment, MotionRecord, Scene};
use super::view::View;
use super::world::framed;
use nalgebra::Vector2;
use paracosm_engine::object::Outline;
use std::ops::Range;

/// The width of a picture in pixels.
const WIDTH: f64 = 1200.0;
/// The least and the greatest number of ghosts of a body on a page, if there is enough time, and the distance in metres
/// between ghosts of the ego vehicle.
const GHOSTS: [f64; 2] = [4.0, 9.0];
const APART: f64 = 10.0;
/// The greatest number of bodies with ghosts: those that come nearest to the ego vehicle.
const TOLD: usize = 8;
/// The possible numbers of seconds between two ghosts.
const STEPS: [f64; 9] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
/// The opacity of a ghost, and of the ghost of a small round body.
const GHOST: f64 = 0.4;
const SMALL_GHOST: f64 = 0.75;
/// The radius in pixels of the star where bodies touch.
const RADIUS: f64 = 11.0;
/// The width in pixels of the line of a body's way.
const WAY: f64 = 2.0;
/// The accuracy in pixels of the drawn way.
const FAITHFUL: f64 = 0.2;

impl MotionRecord {
    /// Returns one bird's-eye picture of the whole run with a caption below; `None` if nothing was recorded.
    pub fn story(&self, caption: &str) -> Option<Drawing> {
        let scene = self.scene.as_ref().filter(|_| !self.is_empty())?;
        let pages = pages(self, scene, WIDTH);
        let panels = pages.iter().map(|page| self.panel(scene, page)).collect();
        let mut entries = self.entries(scene, &pages);
        entries.extend(self.touched.map(|_| Entry::Contact));
        Some(framed(&pages[0].view, panels, &entries, caption))
    }

    /// Returns the legend's entries for the bodies on these pages.
    pub(super) fn entries(&self, scene: &Scene, pages: &[Page]) -> Vec<Entry> {
        let on = |i: usize, page: &Page| {
            let mut poses = self.moments[page.moments.clone()].iter().map(|moment| moment.poses[i]);
            poses.any(|pose| page.view.shows(pose.position, 0.0))
        };
        let seen = (0..scene.bodies.len()).filter(|i| *i == 0 || pages.iter().any(|page| on(*i, page)));
        entries(seen.map(|i| &scene.bodies[i]))
    }

    fn panel(&self, scene: &Scene, page: &Page) -> Vec<PictureItem> {
        let view = &page.view;
        let mut marks = ground(view, &scene.network);
        let colour = |i: usize| if i == 0 { UNDER_TEST } else { class_colour(scene.bodies[i].class) };
        let last = page.moments.end - 1;
        let times = self.round_times(page);
        let moving: Vec<bool> = (0..scene.bodies.len()).map(|i| self.moves(i, page.moments.clone())).collect();
        let told = self.told(page, &moving);
        for (i, _) in moving.iter().enumerate().filter(|(_, moving)| !**moving) {
            marks.extend(body(view, &scene.bodies[i], &self.moments[last].poses[i], colour(i), 1.0));
        }
        for &moment in times.iter().filter(|moment| **moment != last) {
            // The ego vehicle lies on top.
            for &i in told.iter().rev() {
                let round = matches!(scene.bodies[i].outline, Outline::Disc { .. });
                let share = if round { SMALL_GHOST } else { GHOST };
                marks.extend(body(view, &scene.bodies[i], &self.moments[moment].poses[i], colour(i), share));
            }
        }
        for i in (0..moving.len()).rev().filter(|i| moving[*i]) {
            marks.push(self.way(view, i, page.moments.clone()).stroke(colour(i), WAY));
            marks.extend(body(view, &scene.bodies[i], &self.moments[last].poses[i], colour(i), 1.0));
        }
        marks.extend(self.time_marks(scene, page, &times, &told));
        marks
    }

    /// Returns the moving bodies that come nearest to the ego vehicle, including the ego vehicle if it moves.
    fn told(&self, page: &Page, moving: &[bool]) -> Vec<usize> {
        let nearest = |i: &usize| {
            let apart = |moment: &Moment| (moment.poses[*i].position - moment.poses[0].position).norm();
            self.moments[page.moments.clone()].iter().map(apart).fold(f64::INFINITY, f64::min)
        };
        let mut told: Vec<usize> = (0..moving.len()).filter(|i| moving[*i]).collect();
        told.sort_by(|a, b| nearest(a).total_cmp(&nearest(b)).then(a.cmp(b)));
        told.truncate(TOLD);
        told.sort_unstable();
        told
    }

    /// Returns the indices of the moments at round times, at which the picture shows faint bodies.
    fn round_times(&self, page: &Page) -> Vec<usize> {
        let moments = &self.moments[page.moments.clone()];
        let (from, to) = (moments[0].time, moments[moments.len() - 1].time);
        let gone: f64 =
            moments.windows(2).map(|two| (two[1].poses[0].position - two[0].poses[0].position).norm()).sum();
        let count = (gone / APART).clamp(GHOSTS[0], GHOSTS[1]);
        let step = STEPS.into_iter().find(|step| (to - from) / step <= count).unwrap_or((to - from) / count);
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

    /// Draws dots with times along the ways of the bodies, and a star at the point of contact.
    fn time_marks(&self, scene: &Scene, page: &Page, times: &[usize], told: &[usize]) -> Vec<PictureItem> {
        let view = &page.view;
        let (mut dots, mut texts, mut labels) = (Vec::new(), Vec::new(), Labels::on(view.size()));
        let end = page.moments.end - 1;
        for &i in told {
            let aside = view.scale * scene.bodies[i].outline.half_extent().y;
            for &moment in times.iter().chain([&end]) {
                labels.keep_off(view.at(self.moments[moment].poses[i].position), aside.max(4.0));
            }
        }
        if let Some(point) = self.point_of_contact(scene).filter(|_| end + 1 == self.moments.len()) {
            let at = view.at(point);
            dots.extend(contact(at, RADIUS));
            labels.keep_off(at, RADIUS);
            let text = format!("contact, {:.2} s", self.moments[end].time);
            let sides = [Vector2::x(), Vector2::y(), -Vector2::y(), -Vector2::x()];
            let placed = [1.0, 2.5, 4.0].iter().find_map(|far| labels.place(&text, at, far * RADIUS, sides));
            texts.extend(placed);
        }
        for &i in told {
            let mut before: Option<Vector2<f64>> = None;
            for &moment in times {
                let pose = &self.moments[moment].poses[i];
                let stays = before.is_some_and(|before| (pose.position - before).norm() < 1.0);
                if stays || !view.shows(pose.position, 0.0) {
                    continue;
                }
                before = Some(pose.position);
                let at = view.at(pose.position);
                // A round body is a dot itself.
                let aside = match scene.bodies[i].outline {
                    Outline::Rectangle { width, .. } => {
                        dots.extend([Contour::circle(at, 3.2).fill(INK), Contour::circle(at, 1.8).fill(PAPER)]);
                        0.5 * width * view.scale
                    }
                    Outline::Disc { radius } => radius * view.scale,
                };
                let left = pose.left();
                let sides = [1.0, -1.0].map(|side| side * Vector2::new(-left.x, left.y));
                let text = format!("{} s", rounded(self.moments[moment].time));
                texts.extend(labels.place(&text, at, aside.max(4.0) + 1.0, sides));
            }
        }
        dots.extend(texts);
        dots
    }

    /// Returns the way of a body in these moments.
    pub(super) fn way(&self, view: &View, body: usize, moments: Range<usize>) -> Contour {
        let points: Vec<Pixel> = self.moments[moments].iter().map(|m| view.at(m.poses[body].position)).collect();
        let mut kept = vec![points[0]];
        simplified(&points, &mut kept);
        Contour::polyline(kept)
    }
}

/// Formats a time rounded to a tenth of a second, without trailing zeros.
fn rounded(time: f64) -> String {
    format!("{}", (time * 10.0).round() / 10.0)
}

/// Adds the points after the first point that an accurate line needs, by the algorithm of Ramer (1972), Douglas and
/// Peucker.
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
