//! Studies that were written before their scenario asked for all that it asks for now.

use crate::{Study, Subject};

/// Fixes what the scenario has come to ask for since the study was written at its nominal value, which changes nothing.
pub(crate) fn complete(study: &mut Study) {
    let Subject::Scenario(simulation) = &mut study.subject else { return };
    // What keeps a scenario from being declared is said when it is run.
    let declared = simulation.program().ok().and_then(|program| program.declare().ok());
    for declared in declared.into_iter().flat_map(|declaration| declaration.parameters) {
        let name = &declared.parameter.name;
        if !declared.open && simulation.fixed.get(name).is_none() && study.space.parameter(name).is_err() {
            simulation.fixed.set(name, declared.nominal());
        }
    }
}
