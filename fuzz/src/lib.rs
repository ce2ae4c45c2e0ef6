//! The parsers of PARACOSM as targets of `cargo fuzz`.

mod parsers;

pub use parsers::{PARSERS, Parser};

/// Calls the parser with the given name.
///
/// # Panics
/// No parser has the name, or the parser panics.
pub fn read(name: &str, data: &[u8]) {
    let parser = PARSERS.iter().find(|parser| parser.name == name).expect("the parser is in the table");
    (parser.read)(data);
}
