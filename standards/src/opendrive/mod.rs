//! ASAM OpenDRIVE 1.4 to 1.8: road networks of files.
//!
//! A [`Map`] holds the roads and junctions of a file as the file describes them: reference lines, polynomials of widths, links.
//! Every element of a file is read, or has no effect and is listed in [`Map::notes`], or is refused.
//!
//! ```
//! use paracosm_standards::opendrive::Map;
//!
//! let text = r#"<OpenDRIVE><header revMajor="1" revMinor="6"/>
//!     <road id="1" length="50" junction="-1">
//!         <planView><geometry s="0" x="0" y="0" hdg="0" length="50"><arc curvature="0.01"/></geometry></planView>
//!         <lanes><laneSection s="0">
//!             <center><lane id="0" type="none"/></center>
//!             <right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right>
//!         </laneSection></lanes>
//!     </road></OpenDRIVE>"#;
//! let map = Map::parse("bend.xodr".as_ref(), text.to_owned())?;
//! let road = &map.roads[0];
//! assert_eq!(road.border(0, -1, 20.0), Some(-3.5));
//! assert!((road.line.at(50.0).heading - 0.5).abs() < 1e-12);
//! # Ok::<(), paracosm_standards::ReadError>(())
//! ```

mod arcs;
mod bodies;
mod cubics;
mod elements;
mod file;
mod junction;
mod limits;
mod links;
mod map;
mod network;
mod note;
mod object;
mod paving;
mod place;
mod plan_view;
mod read;
mod road;
mod speed;
mod table;
mod thing;
mod write;

pub(crate) use arcs::just_before;
pub use cubics::{Cubic, Cubics};
pub use elements::elements;
pub use junction::{Connection, Junction, JunctionKind};
pub use map::Map;
pub(crate) use network::GAP;
pub use note::Note;
pub use object::Object;
pub use plan_view::{Geometry, PlanView, Polynomials, Shape, Spiral};
pub use road::{Direction, End, Extent, Lane, LaneChange, LaneType, Link, MarkType, Road, RoadMark, Section, Traffic};
pub use table::{Border, borders};
pub(crate) use thing::Thing;
pub use write::{LaneByLane, write};
