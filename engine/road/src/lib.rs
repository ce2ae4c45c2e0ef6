//! Road networks: elements that are connected to one another, with a graph of their lanes.
//!
//! An element (a straight or curved [`RoadSegment`], a [`TIntersection`], a [`CrossIntersection`], a [`Roundabout`])
//! has named points. Other elements can be connected to these points. A connection gives the child its place and yields
//! a [`Composite`], to which further elements can be connected. [`Composite::build`] checks it and makes a
//! [`RoadNetwork`]: immutable, shared by an [`Arc`](std::sync::Arc), the same for every run. This is section 2 of the
//! paper. Its example:
//!
//! ```
//! use paracosm_road::{RoadSegment, TIntersection};
//!
//! let east = RoadSegment::new(50.0).lanes(4).named("east");
//! let south = RoadSegment::new(50.0).lanes(4).named("south");
//! let west = RoadSegment::new(20.0).lanes(4).named("west");
//! let net = TIntersection::new()
//!     .lanes(4)
//!     .connect("one", east, "two")
//!     .connect("two", south, "one")
//!     .connect("three", west, "one")
//!     .build()?;
//!
//! // A lane is a line or an arc; any position has its place on one, and between two places there is a way.
//! let here = net.project(net.on_lane("east", 1, 10.0)?.position);
//! let there = net.project(net.on_lane("south", 1, 30.0)?.position);
//! assert!((here.s - 10.0).abs() < 1e-9 && here.offset.abs() < 1e-9);
//! let route = net.route(here.place(), there.place(), 20.0).expect("it turns left at the intersection");
//! assert_eq!(route.lanes.len(), 3);
//! # Ok::<(), paracosm_road::RoadError>(())
//! ```
//!
//! Traffic keeps to the right. Positions are in metres, x to the east, y to the north. Headings are in radians,
//! counter-clockwise from x. Curvatures and offsets are positive to the left. All geometry consists of lines and
//! circular arcs ([`Curve`]) in 64 bits.

mod bounds;
mod centreline;
mod city;
mod composite;
mod curve;
mod element;
mod error;
mod geometry;
mod lane;
mod layout;
mod network;
mod overlap;
mod path;
mod projection;
mod route;
mod strip;
mod survey;

pub use bounds::Bounds;
pub use centreline::Centreline;
pub use city::grid_city;
pub use composite::Composite;
pub use curve::Curve;
pub use element::{
    Cross, CrossIntersection, Element, Paved, Ring, RoadSegment, Roundabout, Segment, TIntersection, Tee,
};
pub use error::RoadError;
pub use geometry::{Frame, Pose, Side, wrapped};
pub use lane::{Lane, LaneConflict, LaneId, LaneKind, SpeedLimit};
pub use network::{Crossing, EvenRoad, RoadNetwork};
pub use path::Path;
pub use projection::LanePosition;
pub use route::{Route, RoutePosition};
pub use strip::{Strip, Surface};
pub use survey::{Survey, SurveyedLane, SurveyedRoad};
