//! The legend below a picture: a scale in metres, and an explanation of the marks.

use super::body::{UNDER_TEST, body, class_colour};
use super::drawing::{Anchor, Colour, Contour, Drawing, PictureItem, Pixel};
use super::view::View;
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, Class};
use paracosm_engine::road::Bounds;

/// The colour of texts.
pub(super) const INK: Colour = [0x33, 0x33, 0x33];
pub(super) const PAPER: Colour = [0xff, 0xff, 0xff];
/// The size of letters in pixels.
pub(super) const LETTERS: f64 = 14.0;
/// The pixels from an edge to a text.
const MARGIN: f64 = 12.0;
/// The height in pixels of a line of the legend.
const LINE: f64 = 30.0;
/// The metres around a sample body: more than the body takes.
const SWATCH: f64 = 20.0;
/// The scale of the sample bodies, in pixels per metre.
const SCALE: f64 = 5.5;

/// An entry of the legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Entry {
    UnderTest(Body),
    Body(Body),
    Plan,
    Contact,
}

/// Estimates the width of a text in pixels, rather too large, because a viewer may have another font.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    0.56 * size * text.chars().count() as f64
}

pub(super) fn text(at: Pixel, anchor: Anchor, text: impl Into<String>) -> PictureItem {
    PictureItem::Text { at, anchor, size: LETTERS, colour: INK, halo: None, text: text.into() }
}

/// Returns the entries for the ego vehicle and the classes of the other bodies. The car is the first body.
pub(super) fn entries<'a>(bodies: impl Iterator<Item = &'a Body>) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut others = Vec::new();
    for (i, body) in bodies.enumerate() {
        if i == 0 {
            entries.push(Entry::UnderTest(*body));
        } else if !others.iter().any(|other: &Body| other.class == body.class) {
            others.push(*body);
        }
    }
    others.sort_by_key(|body| body.class);
    entries.extend(others.into_iter().map(Entry::Body));
    entries
}

/// Draws a strip with a scale bar (`scale` pixels per metre), the entries, and a caption if it is not empty.
pub(super) fn legend(width: f64, scale: f64, entries: &[Entry], caption: &str) -> Drawing {
    let mut marks = Vec::new();
    let (mut x, mut line) = (MARGIN, 0);
    let middle = |line: usize| LINE * (line as f64 + 0.5);
    x += scale_bar(&mut marks, [x, middle(0)], scale);
    for entry in entries {
        let (room, name) = (swatch_width(entry), name(entry));
        let needed = room + 7.0 + text_width(&name, LETTERS);
        if x + needed > width - MARGIN && x > MARGIN {
            (x, line) = (MARGIN, line + 1);
        }
        swatch(&mut marks, entry, [x, middle(line)]);
        marks.push(text([x + room + 7.0, middle(line) + 5.0], Anchor::Start, name));
        x += needed + 20.0;
    }
    if !caption.is_empty() {
        if x + text_width(caption, LETTERS) > width - MARGIN {
            line += 1;
        }
        marks.push(text([width - MARGIN, middle(line) + 5.0], Anchor::End, caption));
    }
    let height = LINE * (line as f64 + 1.0);
    marks.insert(0, Contour::rectangle([0.0, 0.0], [width, height]).fill(PAPER));
    Drawing { width, height, marks }
}

/// Draws a bar of a round number of metres, at least 80 pixels long. Returns the width of the bar with its label.
pub(super) fn scale_bar(marks: &mut Vec<PictureItem>, [x, y]: Pixel, scale: f64) -> f64 {
    let wanted = 80.0 / scale;
    let mut tens = (0..12).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * libm::pow(10.0, f64::from(power))));
    let metres = tens.find(|metres| *metres >= wanted).unwrap_or(wanted);
    let to = x + metres * scale;
    marks.push(Contour::polyline([[x, y - 5.0], [x, y], [to, y], [to, y - 5.0]]).stroke(INK, 1.5));
    let label = format!("{metres} m");
    let room = to - x + 8.0 + text_width(&label, LETTERS) + 24.0;
    marks.push(text([to + 8.0, y + 5.0], Anchor::Start, label));
    room
}

fn name(entry: &Entry) -> String {
    match entry {
        Entry::UnderTest(_) => "ego vehicle".to_owned(),
        Entry::Body(body) => body.class.to_string(),
        Entry::Plan => "planned path".to_owned(),
        Entry::Contact => "contact".to_owned(),
    }
}

/// Returns the width in pixels of the sample drawing of a legend entry.
fn swatch_width(entry: &Entry) -> f64 {
    match entry {
        Entry::UnderTest(body) | Entry::Body(body) => {
            let reach = if body.class == Class::Tree { 1.8 } else { shown(body).outline.half_extent().x };
            (2.0 * reach * SCALE).max(9.0)
        }
        Entry::Plan => 30.0,
        Entry::Contact => 18.0,
    }
}

/// Returns the body that the legend shows as a sample, which is short enough for a line.
fn shown(body: &Body) -> Body {
    match body.class {
        Class::Car => Body::car(),
        Class::Van => Body::van(),
        class @ (Class::Truck | Class::Bus) => Body::block(class, 7.0, 2.2, 3.0),
        class @ (Class::Motorcycle | Class::Bicycle) => Body::block(class, 2.8, 1.6, 1.7),
        Class::Pedestrian => Body::disc(Class::Pedestrian, 0.8, 1.8),
        Class::Building => Body::block(Class::Building, 4.5, 3.0, 3.0),
        Class::Tree => Body::disc(Class::Tree, 0.3, 7.0),
        Class::Sign => Body::disc(Class::Sign, 0.6, 2.0),
        Class::Prop => Body::block(Class::Prop, 2.5, 2.0, 1.0),
    }
}

fn swatch(marks: &mut Vec<PictureItem>, entry: &Entry, [x, y]: Pixel) {
    let middle = [x + 0.5 * swatch_width(entry), y];
    match entry {
        Entry::UnderTest(of) => marks.extend(sample(of, UNDER_TEST, middle)),
        Entry::Body(of) => marks.extend(sample(of, class_colour(of.class), middle)),
        Entry::Plan => {
            let line = Contour::polyline([[x, y], [x + 30.0, y]]);
            marks.push(line.dashed(INK, 2.0, PLAN_DASH));
        }
        Entry::Contact => marks.extend(contact(middle, 9.0)),
    }
}

/// The pixels of dash and of gap of a planned path.
pub(super) const PLAN_DASH: [f64; 2] = [6.0, 6.0];

/// Draws a body as the legend's sample of its class.
fn sample(of: &Body, colour: Colour, middle: Pixel) -> Vec<PictureItem> {
    let [x, y] = middle.map(|pixels| pixels / SCALE);
    let view = View { bounds: Bounds { min: Vector2::new(-x, -SWATCH), max: Vector2::new(SWATCH, y) }, scale: SCALE };
    let mut marks = body(&view, &shown(of), &Pose { position: Vector2::zeros(), heading: 0.0 }, colour, 1.0);
    // Rims are as white as the paper, so they get another colour here.
    for mark in &mut marks {
        if let PictureItem::Stroke { paint, .. } = mark
            && paint.colour == PAPER
        {
            paint.colour = [0x88, 0x88, 0x88];
        }
    }
    marks
}

/// Draws the star where the ego vehicle touched something.
pub(super) fn contact(middle: Pixel, radius: f64) -> [PictureItem; 2] {
    let star = Contour::star(middle, 8, radius, 0.5 * radius);
    [star.clone().stroke([0x22, 0x22, 0x22], 2.5), star.fill([0xf0, 0xe4, 0x42])]
}
