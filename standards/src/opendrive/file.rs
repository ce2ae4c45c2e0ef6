//! Reads a file of OpenDRIVE, and says in notes how the map differs from the file.

use super::elements::schema;
use super::junction::{Junction, JunctionKind};
use super::map::Map;
use super::note::Note;
use super::plan_view::wrapped;
use super::read;
use super::road::{Direction, LaneType, Road, Section};
use crate::xml::{Document, Element, NoEffect, ReadError, note};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The elements that hold from a place to the next element of the name, with the attributes of the place.
const STRETCHES: [(&str, &str); 8] = [
    ("geometry", "s"),
    ("elevation", "s"),
    ("superelevation", "s"),
    ("laneOffset", "s"),
    ("type", "s"),
    ("width", "sOffset"),
    ("border", "sOffset"),
    ("roadMark", "sOffset"),
];
/// The paths from a road to the elements with a place along the road.
const PLACED: [&[&str]; 5] = [
    &["objects", "object"],
    &["objects", "object", "repeat"],
    &["objects", "object", "outline", "cornerRoad"],
    &["objects", "object", "outlines", "outline", "cornerRoad"],
    &["signals", "signal"],
];
/// The angle in radians from which on kinks of a reference line are reported.
const SHARP: f64 = 0.05;
/// The distance in metres from which on differences between the pieces of a reference line are reported.
const GAP: f64 = 0.01;

impl Map {
    /// Reads a file.
    ///
    /// # Errors
    /// The file cannot be read, is not valid, or has an element that is not supported.
    pub fn read(file: &Path) -> Result<Self, ReadError> {
        Self::of(&Document::open(file)?)
    }

    /// Reads a text. `file` is the name for messages.
    ///
    /// # Errors
    /// The text is not valid, or has an element that is not supported.
    pub fn parse(file: &Path, text: String) -> Result<Self, ReadError> {
        Self::of(&Document::of(file, text)?)
    }

    fn of(document: &Document) -> Result<Self, ReadError> {
        let root = document.root("OpenDRIVE")?;
        let without_effect = schema().check(root)?;
        let (mut map, minor) = read::map(root)?;
        let mut notes = std::mem::take(&mut map.notes);
        if minor < read::OLDEST {
            notes.insert(0, Note::Old { minor });
        }
        notes.extend(map.flattened());
        notes
            .extend([("objects", "object"), ("signals", "signal")].into_iter().filter_map(|kind| same_ids(root, kind)));
        notes.extend(PLACED.into_iter().filter_map(|path| beyond_end(root, path)));
        notes.extend(widest(map.roads.iter().flat_map(jumps)));
        notes.extend(kinks(&map));
        notes.extend(widest(map.roads.iter().flat_map(lengths)));
        notes.extend(map.without_length());
        notes.extend(map.one_way());
        notes.extend(map.narrow());
        notes.extend(map.without_connections());
        notes.extend(overlaid(root).map(Note::NoEffect));
        notes.extend(without_effect.into_iter().map(Note::NoEffect));
        map.notes = notes;
        map.text = document.text().into();
        Ok(map)
    }

    fn flattened(&self) -> Option<Note> {
        let greatest = |of: fn(&Road) -> f64| self.roads.iter().map(of).fold(0.0, f64::max);
        let height = greatest(|road| road.elevation.greatest(0.0, road.length));
        let roll = greatest(|road| road.superelevation.greatest(0.0, road.length));
        (height > 0.0 || roll > 0.0).then_some(Note::Flat { height, roll })
    }

    fn without_length(&self) -> Option<Note> {
        let mut empty = self.sections().filter(|(_, section)| section.end <= section.s);
        let (road, section) = empty.next()?;
        Some(Note::NoLength { road: road.id.clone(), s: section.s, count: 1 + empty.count() })
    }

    fn one_way(&self) -> Option<Note> {
        let lanes = self.sections().flat_map(|(road, section)| section.lanes.iter().map(move |lane| (road, lane)));
        let mut both = lanes.filter(|(_, lane)| {
            let is_both = lane.direction == Direction::Both || lane.kind == LaneType::Bidirectional;
            is_both && lane.kind.is_driven()
        });
        let (road, lane) = both.next()?;
        Some(Note::OneWay { road: road.id.clone(), lane: lane.number, count: 1 + both.count() })
    }

    fn narrow(&self) -> Option<Note> {
        let lanes = self.roads.iter().flat_map(|road| {
            let sections = road.sections.iter().enumerate().filter(|(_, section)| section.end > section.s);
            sections.flat_map(move |(index, section)| section.lanes.iter().map(move |lane| (road, index, lane)))
        });
        let mut narrow = lanes.filter(|(road, section, lane)| {
            lane.number != 0 && lane.kind.is_driven() && !road.is_driven(*section, lane)
        });
        let (road, section, lane) = narrow.next()?;
        let width = road.widest(section, lane.number);
        Some(Note::Narrow { road: road.id.clone(), lane: lane.number, width, count: 1 + narrow.count() })
    }

    fn without_connections(&self) -> Option<Note> {
        let is_empty =
            |junction: &&Junction| junction.kind != JunctionKind::Crossing && junction.connections.is_empty();
        let mut empty = self.junctions.iter().filter(is_empty);
        Some(Note::NoConnection { junction: empty.next()?.id.clone(), count: 1 + empty.count() })
    }

    fn sections(&self) -> impl Iterator<Item = (&Road, &Section)> {
        self.roads.iter().flat_map(|road| road.sections.iter().map(move |section| (road, section)))
    }
}

/// Returns the elements of roads without an extent, because the next one begins at the same place.
fn overlaid(root: Element<'_, '_>) -> impl Iterator<Item = NoEffect> {
    let mut found = BTreeMap::new();
    let mut open: Vec<Element<'_, '_>> = root.all("road").collect();
    while let Some(parent) = open.pop() {
        let mut before: Option<(Element<'_, '_>, f64)> = None;
        for element in parent.elements() {
            let place = STRETCHES.iter().find(|(name, _)| *name == element.name());
            let at = place.and_then(|(_, attribute)| element.number(attribute).ok());
            if let (Some((first, s)), Some(at)) = (before, at)
                && first.name() == element.name()
                && s == at
            {
                note(&mut found, first.name().to_owned(), ("the next one begins at the same place", None), first);
            }
            before = at.map(|at| (element, at));
            open.push(element);
        }
    }
    found.into_values()
}

/// Returns a note on the objects or signals with the identifier of another one.
fn same_ids(root: Element<'_, '_>, (group, element): (&'static str, &'static str)) -> Option<Note> {
    let mut known = BTreeSet::new();
    let all = root.all("road").flat_map(|road| road.all(group)).flat_map(|all| all.all(element));
    let with_ids = all.filter_map(|one| Some((one.text("id")?, one.line())));
    let mut same = with_ids.filter(|(id, _)| !known.insert(*id));
    let (id, line) = same.next()?;
    Some(Note::SameId { line, element, id: id.to_owned(), count: 1 + same.count() })
}

/// Returns a note on the elements at the end of a path within their road that reach beyond the end of the road.
fn beyond_end(root: Element<'_, '_>, path: &[&'static str]) -> Option<Note> {
    let element = *path.last()?;
    let of_road = |road: Element<'_, '_>| {
        let end = road.number("length").ok()?;
        let mut found = vec![road];
        for name in path {
            found = found.iter().flat_map(|one| one.all(name)).collect();
        }
        // A repetition takes the place of its object.
        found.retain(|of| of.first("repeat").is_none());
        let excess = |of: Element<'_, '_>| {
            let length = if element == "repeat" { of.number("length").ok()? } else { 0.0 };
            Some((of.line(), of.number("s").ok()? + length - end)).filter(|(_, excess)| *excess > GAP)
        };
        Some(found.into_iter().filter_map(excess).collect::<Vec<_>>())
    };
    let mut all = root.all("road").filter_map(of_road).flatten();
    let (line, excess) = all.next()?;
    Some(Note::BeyondEnd { line, element, excess, count: 1 + all.count() })
}

/// Returns the differences in metres between the pieces of a reference line, and a note on each difference.
fn jumps(road: &Road) -> impl Iterator<Item = (f64, Note)> {
    road.line.pieces().windows(2).map(|pair| {
        let gap = (pair[0].at(pair[1].s - pair[0].s).position - pair[1].start.position).norm();
        (gap, Note::Jump { road: road.id.clone(), s: pair[1].s, gap, count: 1 })
    })
}

/// Returns a note on the sharpest kink of a reference line.
fn kinks(map: &Map) -> Option<Note> {
    let of_road = |road: &'_ Road| {
        let turns = road.line.pieces().windows(2).map(|pair| {
            let turn = pair[1].start.heading - pair[0].at(pair[1].s - pair[0].s).heading;
            (wrapped(turn).abs(), pair[1].s)
        });
        turns.filter(|(angle, _)| *angle > SHARP).collect::<Vec<_>>()
    };
    let kinks = map.roads.iter().flat_map(|road| of_road(road).into_iter().map(move |kink| (road, kink)));
    let kinks: Vec<_> = kinks.collect();
    let (road, (angle, s)) = kinks.iter().max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    Some(Note::Kink { road: road.id.clone(), s: *s, angle: *angle, count: kinks.len() })
}

/// Returns the differences in metres between the length of each piece and its share of the road, and a note on each difference.
fn lengths(road: &Road) -> impl Iterator<Item = (f64, Note)> {
    let pieces = road.line.pieces();
    let ends = pieces.iter().skip(1).map(|next| next.s).chain([road.length]);
    pieces.iter().zip(ends).map(|(piece, end)| {
        let (length, span) = (piece.length, end - piece.s);
        ((length - span).abs(), Note::Length { road: road.id.clone(), s: piece.s, length, span, count: 1 })
    })
}

/// Returns the note on the greatest difference, with the number of all differences that are reported.
fn widest(differences: impl Iterator<Item = (f64, Note)>) -> Option<Note> {
    let reported: Vec<_> = differences.filter(|(metres, _)| *metres > GAP).collect();
    let all = reported.len();
    // The first of equal differences.
    let (_, mut note) = reported.into_iter().rev().max_by(|a, b| a.0.total_cmp(&b.0))?;
    if let Note::Jump { count, .. } | Note::Length { count, .. } = &mut note {
        *count = all;
    }
    Some(note)
}
