//! A run as a sequence of frames, for an animated picture.

use super::body::{UNDER_TEST, body, class_colour};
use super::drawing::{Anchor, Drawing, Paint, PictureItem};
use super::ground::ground;
use super::legend::{INK, PAPER, contact, legend};
use super::pages::{Page, pages};
use super::record::{MotionRecord, Scene};

/// The greatest number of frames, apart from the last frame of each page.
const MOST: usize = 300;
/// The paint of the way that a body has covered.
const WAY: Paint = Paint { colour: UNDER_TEST, opacity: 0.55 };
/// The size in pixels of the letters of the clock.
const CLOCK: f64 = 17.0;

/// A bird's-eye film of a run. Every frame lies over one of the scenes; all scenes have the same size.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    /// The backgrounds of the film, with the ground and the bodies that do not move.
    pub scenes: Vec<Drawing>,
    /// The foregrounds of the film in the order of time, with the bodies that move.
    pub frames: Vec<Frame>,
}

/// A moment of a bird's-eye film.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The index of the background scene behind the frame.
    pub scene: usize,
    /// The time of the moment, in seconds since the run began.
    pub time: f64,
    /// The foreground of the frame, which is drawn over the background scene.
    pub drawing: Drawing,
}

impl MotionRecord {
    /// Returns a bird's-eye film of the run with a width in pixels and a caption; `None` if nothing was recorded.
    /// A frame shows every tenth of a second, or fewer moments if there would be more than 300 frames.
    pub fn film(&self, width: f64, caption: &str) -> Option<Animation> {
        let scene = self.scene.as_ref().filter(|_| !self.is_empty())?;
        let pages = pages(self, scene, width);
        let entries = self.entries(scene, &pages);
        let [width, height] = pages[0].view.size();
        let legend = legend(width, pages[0].view.scale, &entries, caption);
        let whole = height + legend.height;
        let still = |page: &Page| {
            let mut marks = ground(&page.view, &scene.network);
            marks.extend(self.bodies(scene, page, page.moments.start, false));
            let map = PictureItem::Inset { at: [0.0, 0.0], drawing: Drawing { width, height, marks } };
            let below = PictureItem::Inset { at: [0.0, height], drawing: legend.clone() };
            Drawing { width, height: whole, marks: vec![map, below] }
        };
        let count: usize = pages.iter().map(|page| page.moments.len()).sum();
        let stride = count.div_ceil(MOST);
        let mut frames = Vec::new();
        for (index, page) in pages.iter().enumerate() {
            let last = page.moments.end - 1;
            let shown = page.moments.clone().filter(|moment| moment % stride == 0 || *moment == last);
            frames.extend(shown.map(|moment| {
                let marks = self.moving(scene, page, moment);
                let map = PictureItem::Inset { at: [0.0, 0.0], drawing: Drawing { width, height, marks } };
                let drawing = Drawing { width, height: whole, marks: vec![map] };
                Frame { scene: index, time: self.moments[moment].time, drawing }
            }));
        }
        Some(Animation { scenes: pages.iter().map(still).collect(), frames })
    }

    /// Draws the foreground of a scene at a moment.
    fn moving(&self, scene: &Scene, page: &Page, moment: usize) -> Vec<PictureItem> {
        let mut marks = Vec::new();
        if self.moves(0, page.moments.clone()) {
            marks.push(self.way(&page.view, 0, page.moments.start..moment + 1).stroke(WAY, 2.0));
        }
        marks.extend(self.bodies(scene, page, moment, true));
        let mut clock = format!("{:.1} s", self.moments[moment].time);
        if let Some(point) = self.point_of_contact(scene).filter(|_| moment + 1 == self.moments.len()) {
            marks.extend(contact(page.view.at(point), 10.0));
            clock = format!("contact, {:.2} s", self.moments[moment].time);
        }
        let halo = Some(PAPER);
        marks.push(PictureItem::Text {
            at: [12.0, 24.0],
            anchor: Anchor::Start,
            size: CLOCK,
            colour: INK,
            halo,
            text: clock,
        });
        marks
    }

    /// Draws the moving or the standing bodies of a page, with the ego vehicle on top.
    fn bodies(&self, scene: &Scene, page: &Page, moment: usize, moving: bool) -> Vec<PictureItem> {
        let these = (0..scene.bodies.len()).rev().filter(|i| self.moves(*i, page.moments.clone()) == moving);
        let poses = &self.moments[moment].poses;
        let marks = these.flat_map(|i| {
            let colour = if i == 0 { UNDER_TEST } else { class_colour(scene.bodies[i].class) };
            body(&page.view, &scene.bodies[i], &poses[i], colour, 1.0)
        });
        marks.collect()
    }
}
