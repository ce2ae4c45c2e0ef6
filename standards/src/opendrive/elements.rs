//! The elements of ASAM OpenDRIVE 1.4 to 1.8, and how each is supported.

use crate::xml::{Counts, Form, Row, Schema, Supported, no_effect, read, refused};

const BOTH_SIDES: &str = "write the lanes of both sides into each section";
const FLAT: &str = "the world is flat";
const RAILWAY: &str = "there are no railways";
const LOOK: &str = "objects have the usual look of their kind";
const BORDERLESS: &str = "it has no body of its own";
const STANDS: &str = "a signal stands where its s and t say";
const SURFACE: &str = "surfaces have no properties besides their look";
const LEGAL: &str = "no driver is told the rules of a country";
const USERS: &str = "it is data for other programs";
const GROUPS: &str = "signals do not change, and junctions are not grouped";

pub(super) const ROWS: &[Row] = &[
    no_effect("*", "userData", USERS),
    no_effect("*", "dataQuality", "the quality of measurements changes nothing"),
    refused("*", "include", "put the content of the other file in its place"),
    read("OpenDRIVE", "header", "revMajor revMinor name version date north south east west vendor"),
    no_effect("header", "geoReference", "positions are those of the file, in metres"),
    no_effect("header", "offset", "positions are those of the file, in metres"),
    no_effect("header", "license", USERS),
    no_effect("header", "defaultRegulations", LEGAL),
    read("OpenDRIVE", "road", "name length id junction rule"),
    read("road|lane", "link", ""),
    read("link", "predecessor|successor", "elementType elementId contactPoint id elementS elementDir"),
    no_effect("link", "neighbor", "the lanes beside each other follow from the lanes of a road"),
    read("road", "type", "s type country"),
    read("type", "speed", "max unit"),
    read("road", "planView", ""),
    read("planView", "geometry", "s x y hdg length"),
    read("geometry", "line", ""),
    read("geometry", "spiral", "curvStart curvEnd"),
    read("geometry", "arc", "curvature"),
    read("geometry", "poly3", "a b c d"),
    read("geometry", "paramPoly3", "aU bU cU dU aV bV cV dV pRange"),
    read("road", "elevationProfile|lateralProfile", ""),
    read("elevationProfile", "elevation", "s a b c d"),
    read("lateralProfile", "superelevation", "s a b c d"),
    no_effect("lateralProfile", "crossfall", FLAT),
    no_effect("lateralProfile", "shape", FLAT),
    no_effect("lateralProfile", "crossSectionSurface", FLAT),
    read("road", "lanes", ""),
    read("lanes", "laneOffset", "s a b c d"),
    read("lanes", "laneSection", "s singleSide"),
    refused("laneSection", "@singleSide", BOTH_SIDES).valued(Form::Truth, "false"),
    read("laneSection", "left|center|right", ""),
    read("left|right", "lane", "id type level advisory direction dynamicLaneDirection dynamicLaneType roadWorks"),
    read("center", "lane", "id type level"),
    read("lane", "width|border", "sOffset a b c d"),
    read("lane", "roadMark", "sOffset type weight color material width laneChange height"),
    no_effect("lane", "@level", FLAT).valued(Form::Truth, "false"),
    no_effect("object|signal", "@pitch|@roll", "objects stand upright").valued(Form::Number, "0"),
    no_effect("object", "@dynamic", "objects of a map do not move").valued(Form::OneOf("yes|no"), "no"),
    no_effect("roadMark", "type", "road marks have the usual lines of their type"),
    no_effect("roadMark", "sway", "road marks are straight"),
    no_effect("roadMark", "explicit", "road marks have the usual lines of their type"),
    no_effect("lane", "material", SURFACE),
    no_effect("lane", "visibility", "sight follows from the world"),
    read("lane", "speed", "sOffset max unit"),
    no_effect("lane", "access", LEGAL),
    no_effect("lane", "height", FLAT),
    no_effect("lane", "rule", LEGAL),
    read("road", "objects|signals", ""),
    read(
        "objects",
        "object",
        "id name type subtype s t zOffset orientation hdg pitch roll length width height radius validLength dynamic perpToRoad",
    ),
    read(
        "object",
        "repeat",
        "s length distance tStart tEnd lengthStart lengthEnd widthStart widthEnd heightStart heightEnd radiusStart radiusEnd \
         zOffsetStart zOffsetEnd detachFromReferenceLine",
    ),
    read("object", "outlines", ""),
    read("object|outlines", "outline", "id closed fillType laneType outer"),
    read("outline", "cornerRoad", "id s t dz height"),
    read("outline", "cornerLocal", "id u v z height"),
    no_effect("object", "material", LOOK),
    no_effect("object", "markings", LOOK),
    no_effect("object", "skeleton", LOOK),
    no_effect("object", "surface", SURFACE),
    no_effect("object", "borders", BORDERLESS),
    no_effect("object", "parkingSpace", BORDERLESS),
    no_effect("object|signal", "validity", LEGAL),
    no_effect("objects", "objectReference", BORDERLESS),
    no_effect("objects", "tunnel", FLAT),
    no_effect("objects", "bridge", FLAT),
    read(
        "signals",
        "signal",
        "id name type subtype s t zOffset orientation hOffset pitch roll height width length dynamic country countryRevision \
         value unit text temporary",
    ),
    no_effect("signals", "signalReference", LEGAL),
    no_effect("signal", "dependency", GROUPS),
    no_effect("signal", "reference", GROUPS),
    no_effect("signal", "semantics", LEGAL),
    no_effect("signal", "positionRoad", STANDS),
    no_effect("signal", "positionInertial", STANDS),
    no_effect("signal", "staticBoard", LOOK),
    no_effect("signal", "vmsBoard", LOOK),
    no_effect("signal", "displayArea", LOOK),
    no_effect("road|junction", "surface", SURFACE),
    no_effect("road", "railroad", RAILWAY),
    no_effect("OpenDRIVE", "controller", GROUPS),
    read("OpenDRIVE", "junction", "name id type mainRoad orientation sStart sEnd"),
    read("junction", "connection", "id incomingRoad connectingRoad linkedRoad contactPoint connectionMaster type"),
    read("connection", "laneLink", "from to overlapZone"),
    refused("connection", "predecessor", "it belongs to virtual junctions; use a common junction"),
    refused("connection", "successor", "it belongs to virtual junctions; use a common junction"),
    read("junction", "priority", "high low"),
    no_effect("junction", "controller", GROUPS),
    no_effect("junction", "boundary", "the ground of a junction is that of its lanes"),
    no_effect("junction", "planView", FLAT),
    no_effect("junction", "elevationGrid", FLAT),
    no_effect("junction", "crossPath", "people walk where their scenario says"),
    no_effect("junction", "roadSection", "people walk where their scenario says"),
    no_effect("junction", "objects", "only the objects of roads are read"),
    no_effect("OpenDRIVE", "junctionGroup", GROUPS),
    no_effect("OpenDRIVE", "station", RAILWAY),
    no_effect("OpenDRIVE", "vmsGroup", GROUPS),
];

/// The elements that occur at most once within their parent.
const ONCE: &[&str] = &[
    "header",
    "link",
    "planView",
    "elevationProfile",
    "lateralProfile",
    "lanes",
    "left",
    "center",
    "right",
    "line",
    "arc",
    "spiral",
    "poly3",
    "paramPoly3",
];

/// Returns the table of all elements of OpenDRIVE.
pub(super) fn schema() -> Schema {
    Schema::new(ROWS, Counts::Once(ONCE))
}

/// Returns all elements of OpenDRIVE, without the contents of elements that have no effect.
pub fn elements() -> impl Iterator<Item = Supported> {
    ROWS.iter().flat_map(Row::each)
}
