//! Links of roads, lanes and junctions: from identifiers to indices.

use super::arcs::just_before;
use super::junction::{Connection, Junction, JunctionKind};
use super::map::Map;
use super::network::GAP;
use super::note::Note;
use super::road::{End, Lane, Link, Road};
use crate::xml::{Element, Flaw, ReadError};
use nalgebra::Vector2;
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
    let own = names.road(road, "id")?;
    let link_at = |name, end| {
        let Some(element) = road.first("link").and_then(|link| link.first(name)) else { return Ok(None) };
        let link = link(element, names)?;
        // A ring is a road whose end meets its own beginning.
        if link == Link::Road(own, end) {
            return Err(element.unexpected("elementId", "another road, or the other end of the same road"));
        }
        Ok(Some(link))
    };
    Ok((link_at("predecessor", End::Start)?, link_at("successor", End::End)?))
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
    /// Returns the index of the section at an end of the road.
    pub(super) fn index_of(&self, end: End) -> usize {
        match end {
            End::Start => 0,
            End::End => self.sections.len() - 1,
        }
    }

    /// Returns the end of the reference line.
    fn tip(&self, end: End) -> Vector2<f64> {
        self.line.at(if end == End::Start { 0.0 } else { self.length }).position
    }

    /// Returns the greatest distance of a border from the reference line at an end of the road, in metres.
    fn half_width(&self, end: End) -> f64 {
        let s = if end == End::Start { 0.0 } else { just_before(self.length, 0.0) };
        let section = self.index_of(end);
        let numbers = self.sections[section].lanes.iter().map(|lane| lane.number);
        numbers.filter_map(|number| self.border(section, number, s)).map(f64::abs).fold(0.0, f64::max)
    }

    /// Returns the link at an end of the road.
    pub fn link(&self, end: End) -> Option<Link> {
        match end {
            End::Start => self.predecessor,
            End::End => self.successor,
        }
    }
}

/// A lane at an end of a section.
struct Tip<'a> {
    road: &'a Road,
    section: usize,
    lane: i32,
    end: End,
}

impl Tip<'_> {
    /// Returns the lane, if the section has it.
    fn lane(&self) -> Option<&Lane> {
        self.road.sections[self.section].lane(self.lane)
    }

    /// Returns the middle of the lane at the end.
    fn point(&self) -> Vector2<f64> {
        let section = &self.road.sections[self.section];
        let s = match self.end {
            End::Start => section.s,
            End::End => just_before(section.end, section.s),
        };
        self.road.point(s, self.road.middle(self.section, self.lane, s))
    }

    /// Returns the distance to another tip in metres; 0 if cars do not drive on both lanes.
    fn gap(&self, other: &Self) -> f64 {
        let is_driven = |tip: &Self| tip.lane().is_some_and(|lane| lane.kind.is_driven());
        if is_driven(self) && is_driven(other) { (self.point() - other.point()).norm() } else { 0.0 }
    }
}

/// The links that cars do not use: the first of a kind, and the number of all.
#[derive(Default)]
struct Lost {
    no_lane: Option<(u32, i32, usize)>,
    no_road: Option<(u32, usize)>,
    apart: Option<(u32, f64, usize)>,
    road_apart: Option<(u32, f64, usize)>,
}

impl Lost {
    /// Checks the lane to which the link in a line leads, from lanes of which one has to meet it.
    fn check(&mut self, line: u32, from: &[Tip<'_>], to: &Tip<'_>) {
        if to.lane().is_none() {
            return self.misses(line, to.lane);
        }
        let gap = from.iter().map(|tip| tip.gap(to)).fold(f64::INFINITY, f64::min);
        if GAP < gap && gap < f64::INFINITY {
            self.apart.get_or_insert((line, gap, 0)).2 += 1;
        }
    }

    fn misses(&mut self, line: u32, lane: i32) {
        self.no_lane.get_or_insert((line, lane, 0)).2 += 1;
    }

    fn notes(self) -> Vec<Note> {
        let no_lane = self.no_lane.map(|(line, lane, count)| Note::NoLane { line, lane, count });
        let apart = self.apart.map(|(line, gap, count)| Note::Apart { line, gap, count });
        let no_road = self.no_road.map(|(line, count)| Note::NoRoad { line, count });
        let road_apart = self.road_apart.map(|(line, gap, count)| Note::RoadApart { line, gap, count });
        no_lane.into_iter().chain(no_road).chain(apart).chain(road_apart).collect()
    }
}

/// Returns notes on the links between lanes that cars do not use: the lane does not exist, or the lanes do not meet. Published
/// files have such links, so they are no errors.
pub(super) fn lost(root: Element<'_, '_>, map: &Map) -> Result<Vec<Note>, ReadError> {
    let mut lost = Lost::default();
    for (road, element) in map.roads.iter().zip(root.all("road")) {
        for (name, end) in [("predecessor", End::Start), ("successor", End::End)] {
            let link = element.first("link").and_then(|link| link.first(name));
            if let (Some(of), Some(Link::Road(to, at))) = (link, road.link(end)) {
                let gap = (road.tip(end) - map.roads[to].tip(at)).norm();
                // Roads may meet beside their reference lines.
                if gap > road.half_width(end) + map.roads[to].half_width(at) + GAP {
                    lost.road_apart.get_or_insert((of.line(), gap, 0)).2 += 1;
                }
            }
        }
        let sections = element.first("lanes").into_iter().flat_map(|lanes| lanes.all("laneSection"));
        for (index, section) in sections.enumerate() {
            for (name, end) in [("predecessor", End::Start), ("successor", End::End)] {
                let beyond = map.beyond(road, index, end);
                // At a junction, the junction has the links of lanes.
                if beyond.is_none() && road.link(end).is_some() {
                    continue;
                }
                for of in section.elements().flat_map(|side| side.all("lane")) {
                    let from = [Tip { road, section: index, lane: of.whole("id")?, end }];
                    for link in of.all("link").flat_map(|link| link.all(name)) {
                        let Some((to, next, at)) = beyond else {
                            lost.no_road.get_or_insert((link.line(), 0)).1 += 1;
                            continue;
                        };
                        let tip = Tip { road: to, section: next, lane: link.whole("id")?, end: at };
                        lost.check(link.line(), &from, &tip);
                    }
                }
            }
        }
    }
    for (junction, element) in map.junctions.iter().zip(root.all("junction")) {
        for (connection, of) in junction.connections.iter().zip(element.all("connection")) {
            let [road, from] = [connection.to, connection.from].map(|index| &map.roads[index]);
            for (link, (incoming, lane)) in of.all("laneLink").zip(&connection.lanes) {
                // The road may meet the junction at either end.
                let tip = |end| Tip { road: from, section: from.index_of(end), lane: *incoming, end };
                let tips = [End::Start, End::End].map(tip).into_iter().filter(|tip| tip.lane().is_some());
                let tips: Vec<_> = tips.collect();
                if tips.is_empty() {
                    lost.misses(link.line(), *incoming);
                }
                let end = connection.at;
                lost.check(link.line(), &tips, &Tip { road, section: road.index_of(end), lane: *lane, end });
            }
        }
    }
    Ok(lost.notes())
}

impl Map {
    /// Returns the road, the section and its end that follow an end of a section; `None` if a junction or nothing follows.
    fn beyond<'a>(&'a self, road: &'a Road, section: usize, end: End) -> Option<(&'a Road, usize, End)> {
        let next = match end {
            End::Start => section.checked_sub(1),
            End::End => Some(section + 1).filter(|next| *next < road.sections.len()),
        };
        if let Some(next) = next {
            return Some((road, next, if end == End::Start { End::End } else { End::Start }));
        }
        match road.link(end)? {
            Link::Road(next, at) => Some((&self.roads[next], self.roads[next].index_of(at), at)),
            Link::Junction(_) => None,
        }
    }
}
