//! The pictures of the catalogue are those that its scenarios give. `UPDATE_GOLDEN=1` draws them anew.

use paracosm_engine::{Run, Setup};
use paracosm_report::birds_eye;
use paracosm_scenarios::ALL;
use std::path::Path;

#[test]
fn every_scenario_has_its_picture_in_the_catalogue() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let catalogue = std::fs::read_to_string(folder.join("README.md")).unwrap();
    for program in ALL {
        let name = program.name();
        let run = Run::new(program, &program.declare().unwrap().nominal(), Setup::asking_every(0.01)).unwrap();
        let svg = birds_eye::world(&run, name).svg();
        let file = folder.join(format!("pictures/{name}.svg"));
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::create_dir_all(folder.join("pictures")).unwrap();
            std::fs::write(&file, &svg).unwrap();
        }
        let drawn = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(drawn == svg, "{name}.svg differs; UPDATE_GOLDEN=1 accepts the new one");
        assert!(catalogue.contains(&format!("## {name}\n\n![](pictures/{name}.svg)\n")), "{name} is not in README.md");
    }
}
