//! Roads and scenarios of others: files of ASAM OpenDRIVE and of ASAM OpenSCENARIO XML.
//!
//! A file is checked, element by element, against the table of its standard. Elements that are not supported end the reading
//! with their names and places; elements without an effect are listed as notes.

mod map_traffic;
pub mod opendrive;
pub mod openscenario;
mod xml;

pub use map_traffic::map_traffic;
pub use xml::{ExpressionFlaw, Flaw, Malformed, Misfit, NoEffect, ReadError, Support, Supported};
