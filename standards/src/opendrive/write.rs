//! Writes road networks of our elements as files of OpenDRIVE 1.7.
//!
//! A road segment becomes a road with all its lanes, and so does each stretch of a roundabout between two arms. The lanes that
//! lead over an intersection, into a roundabout, past an arm or out of it become roads of a junction.

use crate::xml::Writer;
use paracosm_engine::road::{Curve, EvenRoad, Lane, LaneId, LaneKind, RoadNetwork};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;

/// A road of the file.
struct Road {
    name: String,
    /// The index of the junction that the road belongs to.
    junction: Option<usize>,
    line: Curve,
    /// The distance of lane 0 from the line, in metres to the left.
    offset: f64,
    width: f64,
    /// The lanes of the network with their numbers in the file.
    lanes: Vec<(i32, LaneId)>,
    sidewalk: f64,
}

/// The place of a lane of the network in the file.
#[derive(Clone, Copy)]
struct Place {
    road: usize,
    number: i32,
}

/// The reason why a network cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the road network was described lane by lane, and no file has it")]
pub struct LaneByLane;

/// Returns a road network as the text of a file of OpenDRIVE. Numbers have all digits, so that reading the file gives the same
/// lanes. A network that was read from a file is written as the text of this file.
///
/// # Errors
/// The network was described lane by lane, and not by a file.
pub fn write(network: &RoadNetwork, name: &str) -> Result<String, LaneByLane> {
    if let Some(text) = network.source() {
        return Ok(text.to_owned());
    }
    let roads = roads(network).ok_or(LaneByLane)?;
    let mut places: BTreeMap<LaneId, Place> = BTreeMap::new();
    let mut junctions: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (road, of) in roads.iter().enumerate() {
        of.junction.into_iter().for_each(|junction| junctions.entry(junction).or_default().push(road));
        places.extend(of.lanes.iter().map(|(number, lane)| (*lane, Place { road, number: *number })));
    }
    let file = File { network, roads: &roads, places, junctions };
    let mut xml = Writer::new();
    xml.within("OpenDRIVE", &[], |xml| {
        let bounds = network.bounds();
        let attributes: &[(&str, &dyn Display)] = &[
            ("revMajor", &1),
            ("revMinor", &7),
            ("name", &name),
            ("north", &bounds.max.y),
            ("south", &bounds.min.y),
            ("east", &bounds.max.x),
            ("west", &bounds.min.x),
        ];
        xml.empty("header", attributes);
        (0..roads.len()).for_each(|road| file.road(road, xml));
        for (index, element) in network.elements().enumerate() {
            file.junction(index, element, xml);
        }
    });
    Ok(xml.finish())
}

/// Returns the roads of the file; `None` if the network was described lane by lane.
fn roads(network: &RoadNetwork) -> Option<Vec<Road>> {
    let names: Vec<&str> = network.elements().collect();
    let mut of_element: Vec<Vec<LaneId>> = vec![Vec::new(); names.len()];
    network.ids().for_each(|id| of_element[network.lane(id).element].push(id));
    let even = |road: &EvenRoad| even(network, road, &of_element[road.element], names[road.element]);
    let mut roads: Vec<Road> = network.even_roads()?.iter().map(even).collect();
    // A junction without roads that lead to it is no junction of the standard.
    let is_entered =
        |lane: &&Lane| lane.predecessors.iter().any(|before| network.lane(*before).element != lane.element);
    let entered: BTreeSet<usize> = network.lanes().iter().filter(is_entered).map(|lane| lane.element).collect();
    for id in network.ids() {
        let lane = network.lane(id);
        // The leftmost of the lanes beside each other stands for all.
        if lane.kind == LaneKind::Road || lane.left.is_some() {
            continue;
        }
        let mut lanes = vec![(-1, id)];
        let mut last = lane;
        while let Some(right) = last.right {
            lanes.push((-(lanes.len() as i32) - 1, right));
            last = network.lane(right);
        }
        roads.push(Road {
            name: names[lane.element].to_owned(),
            junction: (lane.kind != LaneKind::Ring && entered.contains(&lane.element)).then_some(lane.element),
            line: *lane.curve.curves().next()?,
            offset: 0.5 * lane.width,
            width: lane.width,
            lanes,
            sidewalk: 0.0,
        });
    }
    Some(roads)
}

fn even(network: &RoadNetwork, road: &EvenRoad, lanes: &[LaneId], name: &str) -> Road {
    // Lanes 1, 2, ... of the network lie to the right, where the numbers of the file are negative.
    let lanes = lanes.iter().map(|id| (-network.lane(*id).number, *id)).collect();
    let EvenRoad { centre, lane_width, sidewalk, .. } = *road;
    Road { name: name.to_owned(), junction: None, line: centre, offset: 0.0, width: lane_width, lanes, sidewalk }
}

struct File<'a> {
    network: &'a RoadNetwork,
    roads: &'a [Road],
    places: BTreeMap<LaneId, Place>,
    /// The roads of each junction.
    junctions: BTreeMap<usize, Vec<usize>>,
}

impl File<'_> {
    fn lane(&self, id: LaneId) -> &Lane {
        self.network.lane(id)
    }

    /// Returns the lanes of a road with the lanes that meet them at an end of the road.
    fn met(&self, road: &Road, at_end: bool) -> Vec<(i32, Vec<LaneId>)> {
        let met = |(number, lane): &(i32, LaneId)| {
            // Lanes with positive numbers lead back.
            let lane = self.lane(*lane);
            (*number, if (*number < 0) == at_end { &lane.successors } else { &lane.predecessors }.clone())
        };
        road.lanes.iter().map(met).collect()
    }

    fn road(&self, index: usize, xml: &mut Writer) {
        let road = &self.roads[index];
        let junction = road.junction.map_or("-1".to_owned(), |junction| junction.to_string());
        let length = road.line.length();
        let met = [self.met(road, false), self.met(road, true)];
        let attributes: &[(&str, &dyn Display)] =
            &[("name", &road.name), ("length", &length), ("id", &index), ("junction", &junction), ("rule", &"RHT")];
        xml.within("road", attributes, |xml| {
            let [start, end] = [false, true].map(|at_end| self.linked(road, &met[usize::from(at_end)], at_end));
            let links = [("predecessor", start), ("successor", end)];
            if links.iter().any(|(_, link)| link.is_some()) {
                xml.within("link", &[], |xml| links.iter().for_each(|(name, link)| write_link(name, *link, xml)));
            }
            xml.within("planView", &[], |xml| plan_view(&road.line, xml));
            xml.within("lanes", &[], |xml| {
                if road.offset != 0.0 {
                    let attributes: &[(&str, &dyn Display)] =
                        &[("s", &0), ("a", &road.offset), ("b", &0), ("c", &0), ("d", &0)];
                    xml.empty("laneOffset", attributes);
                }
                xml.within("laneSection", &[("s", &0)], |xml| self.section(road, &met, xml));
            });
        });
    }

    /// Returns the road or junction at an end of a road, which one of the lanes there leads to or comes from.
    fn linked(&self, road: &Road, met: &[(i32, Vec<LaneId>)], at_end: bool) -> Option<Linked> {
        let (number, lane) = met.iter().find_map(|(number, lanes)| Some((*number, *lanes.first()?)))?;
        let place = self.places[&lane];
        match self.roads[place.road].junction {
            Some(junction) if road.junction.is_none() => Some(Linked::Junction(junction)),
            _ => {
                // A lane with a negative number is entered at the start of its road and left at the end, a lane with a positive
                // number the other way round.
                let leaves = (number < 0) == at_end;
                Some(Linked::Road(place.road, (place.number < 0) == leaves))
            }
        }
    }

    fn section(&self, road: &Road, met: &[Vec<(i32, Vec<LaneId>)>; 2], xml: &mut Writer) {
        let side = |xml: &mut Writer, name: &str, sign: i32| {
            let mut lanes: Vec<(i32, LaneId)> =
                road.lanes.iter().copied().filter(|(number, _)| number.signum() == sign).collect();
            lanes.sort_by_key(|(number, _)| -number);
            if lanes.is_empty() {
                return;
            }
            let outermost = lanes.iter().map(|(number, _)| number.abs()).max().unwrap_or_default();
            xml.within(name, &[], |xml| {
                if sign > 0 {
                    sidewalk(road, outermost + 1, xml);
                }
                for (number, _) in &lanes {
                    self.lane_of(road, *number, *number == sign * outermost, met, xml);
                }
                if sign < 0 {
                    sidewalk(road, -outermost - 1, xml);
                }
            });
        };
        side(xml, "left", 1);
        xml.within("center", &[], |xml| {
            xml.within("lane", &[("id", &0), ("type", &"none"), ("level", &"false")], |xml| {
                if road.junction.is_none() && road.lanes.iter().any(|(number, _)| *number > 0) {
                    mark(if road.lanes.len() > 2 { "solid solid" } else { "broken" }, "none", xml);
                }
            });
        });
        side(xml, "right", -1);
    }

    fn lane_of(&self, road: &Road, number: i32, outermost: bool, met: &[Vec<(i32, Vec<LaneId>)>; 2], xml: &mut Writer) {
        xml.within("lane", &[("id", &number), ("type", &"driving"), ("level", &"false")], |xml| {
            let linked = met.each_ref().map(|met| {
                let lanes = met.iter().find(|(of, _)| *of == number).map_or(&[][..], |(_, lanes)| lanes);
                // The links of a road that meets a junction stand in the junction.
                let stands_here = |place: &Place| road.junction.is_some() || self.roads[place.road].junction.is_none();
                lanes.iter().map(|lane| self.places[lane]).filter(stands_here).collect::<Vec<_>>()
            });
            if linked.iter().any(|places| !places.is_empty()) {
                xml.within("link", &[], |xml| {
                    for (name, places) in ["predecessor", "successor"].iter().zip(&linked) {
                        places.iter().for_each(|place| xml.empty(name, &[("id", &place.number)]));
                    }
                });
            }
            width(road.width, xml);
            if road.junction.is_none() {
                let kind = if outermost { "solid" } else { "broken" };
                mark(kind, if outermost { "none" } else { "both" }, xml);
            } else if !outermost {
                mark("none", "both", xml);
            }
        });
    }

    /// Writes the junction of an element, if lanes lead over it.
    fn junction(&self, element: usize, name: &str, xml: &mut Writer) {
        let Some(roads) = self.junctions.get(&element) else { return };
        xml.within("junction", &[("name", &name), ("id", &element), ("type", &"default")], |xml| {
            let mut id = 0;
            for road in roads {
                let mut incoming: BTreeMap<usize, Vec<(i32, i32)>> = BTreeMap::new();
                for (number, lane) in &self.roads[*road].lanes {
                    for before in &self.lane(*lane).predecessors {
                        let place = self.places[before];
                        incoming.entry(place.road).or_default().push((place.number, *number));
                    }
                }
                for (from, links) in incoming {
                    let attributes: &[(&str, &dyn Display)] =
                        &[("id", &id), ("incomingRoad", &from), ("connectingRoad", road), ("contactPoint", &"start")];
                    xml.within("connection", attributes, |xml| {
                        links.iter().for_each(|(from, to)| xml.empty("laneLink", &[("from", from), ("to", to)]));
                    });
                    id += 1;
                }
            }
            for (high, low) in self.priorities(roads) {
                xml.empty("priority", &[("high", &high), ("low", &low)]);
            }
        });
    }

    /// Returns pairs of roads of a junction: traffic on the first road has priority over traffic on the second road.
    fn priorities(&self, roads: &[usize]) -> Vec<(usize, usize)> {
        let (mut pairs, mut known) = (Vec::new(), BTreeSet::new());
        for low in roads {
            for (_, lane) in &self.roads[*low].lanes {
                for conflict in self.lane(*lane).conflicts.iter().filter(|conflict| conflict.gives_way) {
                    let high = self.places[&conflict.with].road;
                    let both =
                        self.lane(conflict.with).conflicts.iter().any(|back| back.with == *lane && back.gives_way);
                    if !both && known.insert((high, *low)) {
                        pairs.push((high, *low));
                    }
                }
            }
        }
        pairs
    }
}

/// The road or junction at an end of a road.
#[derive(Clone, Copy)]
enum Linked {
    /// A road; `true` if its start is met.
    Road(usize, bool),
    Junction(usize),
}

fn write_link(name: &str, link: Option<Linked>, xml: &mut Writer) {
    match link {
        None => (),
        Some(Linked::Junction(junction)) => {
            xml.empty(name, &[("elementType", &"junction"), ("elementId", &junction)]);
        }
        Some(Linked::Road(road, at_start)) => {
            let contact = if at_start { "start" } else { "end" };
            xml.empty(name, &[("elementType", &"road"), ("elementId", &road), ("contactPoint", &contact)]);
        }
    }
}

fn plan_view(line: &Curve, xml: &mut Writer) {
    let start = line.start();
    let attributes: &[(&str, &dyn Display)] = &[
        ("s", &0),
        ("x", &start.position.x),
        ("y", &start.position.y),
        ("hdg", &start.heading),
        ("length", &line.length()),
    ];
    xml.within("geometry", attributes, |xml| match line.curvature() {
        0.0 => xml.empty("line", &[]),
        curvature => xml.empty("arc", &[("curvature", &curvature)]),
    });
}

fn width(metres: f64, xml: &mut Writer) {
    xml.empty("width", &[("sOffset", &0), ("a", &metres), ("b", &0), ("c", &0), ("d", &0)]);
}

fn mark(kind: &str, change: &str, xml: &mut Writer) {
    let attributes: &[(&str, &dyn Display)] = &[
        ("sOffset", &0),
        ("type", &kind),
        ("weight", &"standard"),
        ("color", &"standard"),
        ("width", &0.12),
        ("laneChange", &change),
    ];
    xml.empty("roadMark", attributes);
}

fn sidewalk(road: &Road, number: i32, xml: &mut Writer) {
    if road.sidewalk > 0.0 {
        xml.within("lane", &[("id", &number), ("type", &"sidewalk"), ("level", &"false")], |xml| {
            width(road.sidewalk, xml);
        });
    }
}
