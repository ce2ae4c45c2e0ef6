//! Scenarios of files with the values of tests, written as files of their own and read back.

use super::bad::changed_in;
use super::others::{files_of_others, with_ending};
use super::worlds::{driven_with, file, led_with};
use paracosm_engine::Program;
use paracosm_oracles::Trace;
use paracosm_space::{Value, Values};
use paracosm_standards::openscenario::{Concrete, Xosc};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

fn read(path: &Path) -> Xosc {
    Xosc::read(path).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the nominal values of a file, of which some are changed.
fn test(path: &Path, changed: &[(&str, Value)]) -> Values {
    let mut test = read(path).program().declare().unwrap().nominal();
    changed.iter().for_each(|(name, value)| test.set(*name, value.clone()));
    test
}

/// Writes a scenario with the values of a test into a folder of its own. Returns the folder, the program that is read from it,
/// and what was written.
fn written(path: &Path, test: &Values) -> (TempDir, Program, Concrete) {
    let concrete = read(path).concrete(test, "roads.xodr").unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.xosc");
    fs::write(&case, &concrete.scenario).unwrap();
    fs::write(folder.path().join("roads.xodr"), concrete.roads.as_bytes()).unwrap();
    let program = read(&case).program();
    (folder, program, concrete)
}

/// Checks that a scenario moves everything as before when it is written with the values of a test and read again.
fn same_when_written(path: &Path, test: &Values) -> Concrete {
    let (_folder, again, concrete) = written(path, test);
    let original = read(path).program();
    let ego = Value::from(concrete.ego.as_str());
    let mut nominal = again.declare().unwrap().nominal();
    nominal.set("ego", ego);
    let hashes = |one: Option<Trace>, other: Option<Trace>| [one, other].map(|trace| trace.map(|trace| trace.hash()));
    let [one, other] = hashes(led_with(&original, test).unwrap().trace, led_with(&again, &nominal).unwrap().trace);
    assert!(one.is_some() && one == other, "{}: another trace", path.display());
    let [one, other] = hashes(driven_with("aeb", &original, test).trace, driven_with("aeb", &again, &nominal).trace);
    assert_eq!(one, other, "{}: another trace with a driver", path.display());
    concrete
}

#[test]
fn our_own_scenarios_are_written_and_read_with_the_same_traces() {
    for path in with_ending(&file(""), "xosc").iter().filter(|path| !path.ends_with("catalogs/entities.xosc")) {
        same_when_written(path, &test(path, &[]));
    }
    let variation = file("slow-leader-variation.xosc");
    let changed = [("speed", 20.0.into()), ("gap", 20.0.into())];
    let concrete = same_when_written(&variation, &test(&variation, &changed));
    for part in [
        "<ParameterDeclaration name=\"speed\" parameterType=\"double\" value=\"20\">",
        "<ParameterDeclaration name=\"gap\" parameterType=\"double\" value=\"20\"/>",
        "<ParameterDeclaration name=\"start\" parameterType=\"double\" value=\"30\"/>",
        "<LogicFile filepath=\"roads.xodr\"/>",
        "<CatalogLocations/>",
        "<ParameterDeclaration name=\"length\" parameterType=\"double\" value=\"4\"/>",
        "<ParameterDeclaration name=\"target\" parameterType=\"double\" value=\"10\"/>",
        "<Maneuver name=\"slow-down\">",
        "<Controller name=\"system under test\">",
    ] {
        assert!(concrete.scenario.contains(part), "{part} is missing in {}", concrete.scenario);
    }
    assert!(!concrete.scenario.contains("CatalogReference") && !concrete.scenario.contains("${"));
    // The scenario activates the controller itself.
    assert_eq!(concrete.scenario.matches("<ActivateControllerAction").count(), 1);
    assert_eq!(concrete.notes, [""; 0]);
}

#[test]
fn the_controller_of_the_chosen_ego_vehicle_is_activated() {
    let path = file("slow-leader.xosc");
    let concrete = same_when_written(&path, &test(&path, &[("ego", "Leader".into())]));
    let activation = "<Private entityRef=\"Leader\"><PrivateAction><ControllerAction><ActivateControllerAction";
    assert!(concrete.scenario.contains(activation), "{}", concrete.scenario);
    let leader = concrete.scenario.find("name=\"Leader\"").unwrap();
    assert!(concrete.scenario[leader..].contains("<Controller name=\"system under test\">"));
}

#[test]
fn an_export_has_the_version_that_all_its_parts_have() {
    let version = |folder: &TempDir, path: &Path, catalog: (&str, &str)| {
        let file = folder.path().join("catalogs/entities.xosc");
        let text = fs::read_to_string(&file).unwrap().replacen("revMinor=\"3\"", "revMinor=\"0\"", 1);
        fs::write(&file, text.replacen(catalog.0, catalog.1, 1)).unwrap();
        let scenario = same_when_written(path, &test(path, &[])).scenario;
        let at = scenario.find("revMinor=\"").unwrap() + "revMinor=\"".len();
        scenario[at..=at].to_owned()
    };
    for (minor, catalog, expected) in [
        ("3", ("", ""), "3"),
        ("2", ("", ""), "2"),
        ("0", ("", ""), "2"),
        ("0", ("revMinor=\"0\"", "revMinor=\"3\""), "3"),
        ("1", ("</Axles>", "</Axles><TrailerHitch dx=\"1\"/>"), "3"),
    ] {
        let (folder, path) = changed_in("slow-leader.xosc", "revMinor=\"3\"", &format!("revMinor=\"{minor}\""));
        assert_eq!(version(&folder, &path, catalog), expected, "{minor} {catalog:?}");
    }
}

#[test]
fn comments_stay_and_what_is_left_out_is_noted() {
    let (_folder, path) = changed_in("everything.xosc", "<Entities>", "<!-- Ärger & <more> --><Entities>");
    let concrete = same_when_written(&path, &test(&path, &[]));
    assert!(concrete.scenario.contains("<!-- Ärger & <more> --><Entities>"));
    assert!(!concrete.scenario.contains("SceneGraphFile"));
    assert!(
        concrete.notes.iter().any(|note| note.contains("bad.xosc:25: `SceneGraphFile` is left out")),
        "{:?}",
        concrete.notes
    );
    let reference = "<ObjectController><CatalogReference catalogName=\"pilots\" entryName=\"a\"/></ObjectController>";
    let found = "entryName=\"car\"/></ScenarioObject>";
    let (_folder, path) = changed_in("slow-leader.xosc", found, &found.replace("</", &format!("{reference}</")));
    let concrete = same_when_written(&path, &test(&path, &[]));
    assert!(concrete.notes[0].contains("bad.xosc:19: no catalog has the entry"), "{:?}", concrete.notes);
}

#[test]
fn an_element_to_which_a_condition_refers_has_a_name_of_its_own() {
    let (folder, path) = changed_in("slow-leader.xosc", "\"slowing down\"", "\"slow-down\"");
    let catalog = folder.path().join("catalogs/entities.xosc");
    let text = fs::read_to_string(&catalog).unwrap().replacen("\"slowing down\"", "\"slow-down\"", 1);
    fs::write(&catalog, text).unwrap();
    let concrete = same_when_written(&path, &test(&path, &[]));
    for part in ["<Maneuver name=\"slow-down\">", "<Event name=\"slow-down (event)\"", "Ref=\"slow-down (event)\""] {
        assert!(concrete.scenario.contains(part), "{part} is missing in {}", concrete.scenario);
    }
    assert!(concrete.notes[0].contains("the event `slow-down` is called `slow-down (event)`"), "{:?}", concrete.notes);
}

#[test]
fn a_condition_names_an_element_by_the_elements_around_it() {
    let event = ("<Event name=\"activation\"", "<Event name=\"slowing down\"");
    let (_folder, path) = changed_in("slow-leader.xosc", event.0, event.1);
    for around in ["slow-down", "group::slow-down", "story::act::group::slow-down"] {
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.replacen("Ref=\"slowing down\"", &format!("Ref=\"{around}::slowing down\""), 1)).unwrap();
        // The leader needs 10 s from 5 s on, and the scenario ends 5 s later.
        let concrete = same_when_written(&path, &test(&path, &[]));
        for part in [
            "<Event name=\"slowing down (event)\" priority",
            "Ref=\"slowing down (event)\"",
            "<Event name=\"slowing down\"",
        ] {
            assert!(concrete.scenario.contains(part), "{part} is missing in {}", concrete.scenario);
        }
        fs::write(&path, text).unwrap();
    }
}

#[test]
fn an_entry_that_refers_to_itself_ends() {
    let (folder, path) = changed_in(
        "slow-leader.xosc",
        "entryName=\"car\"/></ScenarioObject>",
        "entryName=\"car\"/><ObjectController><CatalogReference catalogName=\"entities\" entryName=\"driver\"/>\
         </ObjectController></ScenarioObject>",
    );
    let catalog = folder.path().join("catalogs/entities.xosc");
    let again = "<Properties/><ObjectController><CatalogReference catalogName=\"entities\" entryName=\"driver\"/></ObjectController>";
    let text = fs::read_to_string(&catalog).unwrap().replacen(
        "<Properties/></Controller>",
        &format!("{again}</Controller>"),
        1,
    );
    fs::write(&catalog, text).unwrap();
    let concrete = read(&path).concrete(&test(&path, &[]), "roads.xodr").unwrap();
    assert!(concrete.notes[0].contains("no catalog has the entry"), "{:?}", concrete.notes);
}

#[test]
fn scenarios_of_others_are_written_and_read_with_the_same_traces() {
    let Some(folder) = files_of_others() else { return };
    let mut count = 0;
    for suite in ["alks/logical_scenarios", "ncap/OpenSCENARIO/NCAP", "esmini/resources/xosc"] {
        for path in with_ending(&folder.join(suite), "xosc") {
            // Catalogs are no scenarios, and some files of esmini have elements that are refused.
            let Ok(program) = Xosc::read(&path).map(Xosc::program) else { continue };
            let Ok(declaration) = program.declare() else { continue };
            let nominal = declaration.nominal();
            if program.check(&nominal).is_ok() {
                same_when_written(&path, &nominal);
                count += 1;
            }
        }
    }
    assert!(count >= 30, "{count} scenarios");
}

#[test]
fn a_second_property_of_a_name_and_an_expression_without_a_value_have_other_names() {
    let twice = "<Properties><Property name=\"colour\" value=\"blue\"/>";
    let (folder, path) =
        changed_in("slow-leader.xosc", "name=\"5 s after the maneuver\"", "name=\"${5 s + _ + $gap}\"");
    let catalog = folder.path().join("catalogs/entities.xosc");
    let text = fs::read_to_string(&catalog).unwrap().replacen("<Properties>", twice, 1);
    fs::write(&catalog, text).unwrap();
    let (_folder, _, concrete) = written(&path, &test(&path, &[]));
    for part in
        ["name=\"colour\" value=\"blue\"", "name=\"colour 2\" value=\"red\"", "<Condition name=\"5 s + _ + gap\""]
    {
        assert!(concrete.scenario.contains(part), "{part} is missing in {}", concrete.scenario);
    }
    assert!(concrete.notes[0].contains("the property `colour` is called `colour 2`"), "{:?}", concrete.notes);
}

/// Returns the exports of the scenarios of others, each in a folder of its own.
fn exports_of_others(folder: &Path) -> Vec<std::path::PathBuf> {
    let Some(others) = files_of_others() else { return Vec::new() };
    let mut files = Vec::new();
    for suite in ["alks/logical_scenarios", "ncap/OpenSCENARIO/NCAP", "esmini/resources/xosc"] {
        for path in with_ending(&others.join(suite), "xosc") {
            let Ok(scenario) = Xosc::read(&path) else { continue };
            let Ok(declaration) = Xosc::read(&path).map(Xosc::program).unwrap().declare() else { continue };
            let Ok(concrete) = scenario.concrete(&declaration.nominal(), "roads.xodr") else { continue };
            let case = folder.join(files.len().to_string());
            fs::create_dir(&case).unwrap();
            fs::write(case.join("roads.xodr"), concrete.roads.as_bytes()).unwrap();
            files.push(case.join("case.xosc"));
            fs::write(&files[files.len() - 1], concrete.scenario).unwrap();
        }
    }
    files
}

#[test]
fn exported_storyboards_of_others_pass_the_quality_checker_of_asam() {
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/checker/bin/python3");
    let found = Command::new(&python).args(["-c", "import qc_openscenario"]).stderr(Stdio::null()).status();
    let folder = tempfile::tempdir().unwrap();
    let files = exports_of_others(folder.path());
    if files.is_empty() || !found.is_ok_and(|status| status.success()) {
        return eprintln!("no checker of ASAM, or no scenarios of others: the test is skipped");
    }
    assert!(files.len() >= 40, "{} files", files.len());
    let program = "import sys; from qc_openscenario.main import main\n\
                   for file in sys.argv[1:]: sys.argv = ['qc_openscenario', '-c', file + '.xml']; main()";
    for file in &files {
        let (input, output) = (file.display(), file.with_extension("xqar"));
        let settings = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Config><Param name=\"InputFile\" value=\"{input}\"/>\
             <CheckerBundle application=\"xoscBundle\"><Param name=\"resultFile\" value=\"{}\"/></CheckerBundle></Config>",
            output.display()
        );
        fs::write(format!("{input}.xml"), settings).unwrap();
    }
    let run = Command::new(&python).args(["-c", program]).args(&files).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    for file in &files {
        let report = fs::read_to_string(file.with_extension("xqar")).unwrap();
        assert!(report.matches("status=\"completed\"").count() >= 15, "{report}");
        let text = fs::read_to_string(file).unwrap();
        assert!(!report.contains("<Issue"), "{report}\n{}", &text[..200]);
    }
}
