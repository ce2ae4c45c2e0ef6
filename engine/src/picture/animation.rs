//! A run moment by moment, for an animated picture.

use super::body::{UNDER_TEST, body, class_colour};
use super::drawing::{Anchor, Drawing, Paint, PictureItem};
use super::ground::ground;
use super::legend::{INK, PAPER, contact, legend};
use super::pages::{Page, pages};
use super::record::{MotionRecord, Scene};

/// How many frames there are at most.
const MOST: usize = 300;
/// How much there is of the way that a body came.
const WAY: Paint = Paint { colour: UNDER_TEST, opacity: 0.55 };
/// The size in pixels of the letters that tell the time.
const CLOCK: f64 = 17.0;

/// A run, moment by moment. Every frame lies over one of the scenes, which have all one size.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    /// What stands still: the ground and what is on it.
    pub scenes: Vec<Drawing>,
    /// What changes.
    pub frames: Vec<Frame>,
}

/// A moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Which of the scenes it lies over.
    pub scene: usize,
    /// Seconds of the run.
    pub time: f64,
    /// What lies over the scene.
    pub drawing: Drawing,
}

impl MotionRecord {
    /// The run moment by moment, this many pixels wide: a frame for every tenth of a second, or fewer where there would
    /// be more than 300. Nothing where nothing was seen.
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

    /// What lies over a scene at a moment.
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

    /// The bodies that move on a page, or those that do not; the car under test on top.
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
