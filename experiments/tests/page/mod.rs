//! Holds the marked tables of a page against tables that a test has computed from files.

use std::path::Path;
use std::{env, fs};

/// Checks that the page of this name has each table between its marks. With UPDATE_GOLDEN=1 it writes the tables into the page instead.
///
/// # Panics
/// A table of the page is old, or has no marks.
pub fn assert_tables(page: &str, tables: &[(&str, String)]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(page);
    let old = fs::read_to_string(&path).unwrap();
    let mut new = old.clone();
    for (name, table) in tables {
        let (begin, end) = (format!("<!-- table: {name} -->\n\n"), "\n<!-- end -->");
        let from = new.find(&begin).unwrap_or_else(|| panic!("{page} has no mark {begin}")) + begin.len();
        let to = from + new[from..].find(end).expect("a table ends");
        new.replace_range(from..to, table);
    }
    if env::var_os("UPDATE_GOLDEN").is_some_and(|update| update == "1") {
        fs::write(&path, new).unwrap();
    } else {
        assert!(old == new, "the tables of {page} are old; with UPDATE_GOLDEN=1 the test writes these: {tables:#?}");
    }
}
