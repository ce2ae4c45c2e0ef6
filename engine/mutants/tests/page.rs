//! The page of the kinds of defects, which is written from their list.

use paracosm_mutants::ALL;
use std::fs;
use std::path::Path;

#[test]
fn the_page_of_mutants_is_written_from_the_list_of_kinds() {
    let mut page = include_str!("page.head.md").to_owned();
    for kind in ALL {
        let sizes: Vec<String> = kind.sizes.iter().map(f64::to_string).collect();
        let sizes = format!("{} {}", sizes.join(", "), kind.unit);
        page += &format!("| `{}` | {} | {sizes} | {} |\n", kind.name, kind.about, kind.source);
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/mutants.md");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&path, &page).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(found == page, "docs/mutants.md is old; write it again with UPDATE_GOLDEN=1");
}
