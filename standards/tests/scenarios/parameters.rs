//! The parameter spaces of scenarios of others, with their constraints.

use super::others::files_of_others;
use paracosm_space::{Domain, Value, Values};
use paracosm_standards::openscenario::Xosc;

/// The number of valid combinations of the published parameters, for each of the five models of
/// the vehicle that cuts in.
const VALID_OF_EACH_MODEL: usize = 29_750 / 5;

#[test]
fn constraints_leave_29750_of_52500_combinations_of_the_cut_in() {
    let Some(folder) = files_of_others() else { return };
    let file = folder.join("alks/logical_scenarios/alks_scenario_4_4_1_cut_in_no_collision_variation.xosc");
    let program = Xosc::read(&file).unwrap_or_else(|error| panic!("{error}")).program();
    let declaration = program.declare().unwrap();
    let levels = |name: &str, domain: &Domain| match domain {
        // The model has no constraint.
        Domain::Choice(levels) if name == "CutInVehicle_Model" => vec![levels[0].clone()],
        Domain::Choice(levels) => levels.clone(),
        Domain::Interval { .. } => panic!("{name} is no choice"),
    };
    let open: Vec<(String, Vec<Value>)> = declaration
        .parameters
        .iter()
        .filter(|declared| declared.open)
        .map(|declared| (declared.parameter.name.clone(), levels(&declared.parameter.name, &declared.opened().domain)))
        .collect();
    let all: usize = open.iter().map(|(_, levels)| levels.len()).product();
    assert_eq!(5 * all, 52_500);
    let valid = (0..all).filter(|index| {
        let mut test: Values = declaration.nominal();
        let mut rest = *index;
        for (name, levels) in &open {
            test.set(name.as_str(), levels[rest % levels.len()].clone());
            rest /= levels.len();
        }
        program.check(&test).is_ok()
    });
    assert_eq!(valid.count(), VALID_OF_EACH_MODEL);
}
