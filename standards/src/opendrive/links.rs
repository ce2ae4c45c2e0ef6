//! Links of roads, lanes and junctions: from identifiers to indices.

use super::junction::{Connection, Junction, JunctionKind};
use super::map::Map;
use super::note::Note;
use super::road::{End, Link, Road, Section};
use crate::xml::{Element, Flaw, ReadError};
use std::collections::BTreeMap;

const ENDS: &[(&str, End)] = &[("start", End::Start), ("end", End::End)];
const CONTACT: &str = "contactPoint";

/// The indices of the roads and junctions of a file by their identifiers.
pub(super) struct Names<'a> {
    roads: BTreeMap<&'a str, usize>,
    junctions: BTreeMap<&'a str, usize>,
}

impl<'a> Names<'a> {
    /// Collects the identifiers of a file.
    pub fn of(root: Element<'a, '_>) -> Result<Self, ReadError> {
        Ok(Self { roads: indices(root, "road")?, junctions: indices(root, "junction")? })
    }

    /// Returns the index of the road that an attribute names.
    fn road(&self, element: Element<'_, '_>, attribute: &'static str) -> Result<usize, ReadError> {
        let id = element.required(attribute)?;
        self.roads.get(id).copied().ok_or_else(|| element.dangling(attribute, "road", self.roads.keys().copied()))
    }

    /// Returns the index of the junction that an attribute names.
    fn junction(&self, element: Element<'_, '_>, attribute: &'static str) -> Result<usize, ReadError> {
        let id = element.required(attribute)?;
        let dangling = || element.dangling(attribute, "junction", self.junctions.keys().copied());
        self.junctions.get(id).copied().ok_or_else(dangling)
    }

    /// Returns the index of the junction that a road belongs to.
    pub fn junction_of(&self, road: Element<'_, '_>) -> Result<Option<usize>, ReadError> {
        match road.text("junction") {
            None | Some("-1") => Ok(None),
            Some(_) => self.junction(road, "junction").map(Some),
        }
    }
}

fn indices<'a>(root: Element<'a, '_>, name: &'static str) -> Result<BTreeMap<&'a str, usize>, ReadError> {
    let mut found: BTreeMap<&str, (usize, u32)> = BTreeMap::new();
    for (index, element) in root.all(name).enumerate() {
        let id = element.required("id")?;
        if let Some((_, first)) = found.insert(id, (index, element.line())) {
            let (element_name, found) = (name.to_owned(), id.to_owned());
            return Err(element.error(Flaw::Taken { element: element_name, attribute: "id", found, first }));
        }
    }
    Ok(found.into_iter().map(|(id, (index, _))| (id, index)).collect())
}

/// Returns the links at the beginning and at the end of a road.
pub(super) fn of_road(road: Element<'_, '_>, names: &Names<'_>) -> Result<(Option<Link>, Option<Link>), ReadError> {
    let end = |name| {
        let link = road.first("link").and_then(|link| link.first(name));
        link.map(|element| self::link(element, names)).transpose()
    };
    Ok((end("predecessor")?, end("successor")?))
}

fn link(element: Element<'_, '_>, names: &Names<'_>) -> Result<Link, ReadError> {
    if element.text("elementS").is_some() {
        return Err(element.unexpected("elementS", "no such attribute: virtual junctions are not supported"));
    }
    if element.one_of("elementType", &[("road", true), ("junction", false)])? {
        Ok(Link::Road(names.road(element, "elementId")?, element.one_of(CONTACT, ENDS)?))
    } else {
        names.junction(element, "elementId").map(Link::Junction)
    }
}

/// Reads a junction.
pub(super) fn junction(element: Element<'_, '_>, names: &Names<'_>) -> Result<Junction, ReadError> {
    let kind = match element.text("type") {
        None => JunctionKind::Common,
        Some("virtual") => {
            return Err(element.unexpected("type", "default, direct or crossing; virtual junctions are not supported"));
        }
        Some(_) => element.one_of(
            "type",
            &[
                ("default", JunctionKind::Common),
                ("direct", JunctionKind::Direct),
                ("crossing", JunctionKind::Crossing),
            ],
        )?,
    };
    let connection = |of: Element<'_, '_>| {
        if of.text("type") == Some("virtual") {
            return Err(of.unexpected("type", "default; virtual junctions are not supported"));
        }
        let next = if kind == JunctionKind::Direct { "linkedRoad" } else { "connectingRoad" };
        let lane = |link: Element<'_, '_>| Ok((link.whole("from")?, link.whole("to")?));
        Ok(Connection {
            from: names.road(of, "incomingRoad")?,
            to: names.road(of, next)?,
            at: of.one_of(CONTACT, ENDS)?,
            lanes: of.all("laneLink").map(lane).collect::<Result<_, _>>()?,
        })
    };
    let priority = |of: Element<'_, '_>| Ok((names.road(of, "high")?, names.road(of, "low")?));
    Ok(Junction {
        id: element.required("id")?.to_owned(),
        name: element.text("name").unwrap_or_default().to_owned(),
        kind,
        connections: element.all("connection").map(connection).collect::<Result<_, _>>()?,
        priorities: element.all("priority").map(priority).collect::<Result<_, _>>()?,
    })
}

impl Road {
    /// Returns the section at an end of the road.
    pub fn section_of(&self, end: End) -> &Section {
        match end {
            End::Start => &self.sections[0],
            End::End => &self.sections[self.sections.len() - 1],
        }
    }

    /// Returns the link at an end of the road.
    pub fn link(&self, end: End) -> Option<Link> {
        match end {
            End::Start => self.predecessor,
            End::End => self.successor,
        }
    }
}

/// Returns notes on the links between lanes that lead to lanes which do not exist. Published files have such links, so they
/// are no errors.
pub(super) fn lost(root: Element<'_, '_>, map: &Map) -> Result<Vec<Note>, ReadError> {
    let mut notes = Vec::new();
    for (road, element) in map.roads.iter().zip(root.all("road")) {
        let sections = element.first("lanes").into_iter().flat_map(|lanes| lanes.all("laneSection"));
        for (index, section) in sections.enumerate() {
            let before = index.checked_sub(1).and_then(|before| road.sections.get(before));
            let before = before.or_else(|| map.beyond(road, End::Start));
            let after = road.sections.get(index + 1).or_else(|| map.beyond(road, End::End));
            for (name, next) in [("predecessor", before), ("successor", after)] {
                let Some(next) = next else { continue };
                let lanes = section.elements().flat_map(|side| side.all("lane"));
                for to in lanes.flat_map(|lane| lane.all("link")).flat_map(|link| link.all(name)) {
                    let lane = to.whole("id")?;
                    if next.lane(lane).is_none() {
                        notes.push(Note::NoLane { line: to.line(), lane });
                    }
                }
            }
        }
    }
    for (junction, element) in map.junctions.iter().zip(root.all("junction")) {
        for (connection, of) in junction.connections.iter().zip(element.all("connection")) {
            let next = map.roads[connection.to].section_of(connection.at);
            let from = &map.roads[connection.from];
            for (link, (incoming, lane)) in of.all("laneLink").zip(&connection.lanes) {
                // The road may meet the junction at either end.
                let has_incoming =
                    [End::Start, End::End].iter().any(|end| from.section_of(*end).lane(*incoming).is_some());
                for (lane, exists) in [(incoming, has_incoming), (lane, next.lane(*lane).is_some())] {
                    if !exists {
                        notes.push(Note::NoLane { line: link.line(), lane: *lane });
                    }
                }
            }
        }
    }
    Ok(notes)
}

impl Map {
    /// Returns the section that follows an end of a road on the linked road; `None` if there is no such road.
    fn beyond(&self, road: &Road, end: End) -> Option<&Section> {
        match road.link(end)? {
            Link::Road(next, at) => Some(self.roads[next].section_of(at)),
            Link::Junction(_) => None,
        }
    }
}
