//! Notes for the user on a study, before its tests run.

use crate::analysis::effects::{foreseen, foreseen_fixed};
use crate::campaign::{Error, StatedRequirement, Study, Subject};
use crate::oracles::Formula;
use crate::space::{Space, did_you_mean, nearest, plural};

/// Returns notes on a study: remarks on its worlds, parameters that nothing reads, and formulas that may mean something else.
///
/// # Errors
/// The world of the study cannot be built with nominal values.
pub fn notes_before(study: &Study) -> Result<Vec<String>, Error> {
    let mut notes = study.notes()?;
    let unread = foreseen(study)?;
    if !unread.is_empty() {
        let (names, driver) = (unread.join(", "), study.subject().scenario()?.driver().name());
        notes.push(format!("no effect: {names}: read by neither the world nor the driver `{driver}`"));
    }
    let changed = foreseen_fixed(study)?;
    if !changed.is_empty() {
        let (names, driver) = (changed.join(", "), study.subject().scenario()?.driver().name());
        notes.push(format!(
            "no effect: the given values of {names}: read by neither the world nor the driver `{driver}`"
        ));
    }
    // The requirements of a system that answers with a robustness are not known here.
    if study.requirements().is_empty() && matches!(study.subject(), Subject::Scenario(_)) {
        let how = "a formula (`spec`) or a file (`requirements`) states one";
        notes.push(format!("there is no requirement, so every test passes; {how}"));
    }
    notes.extend(unjudged(study));
    notes.extend(study.given().filter_map(|given| only_at_begin(&given.id, given.formula.as_ref())));
    Ok(notes)
}

/// Returns a note for each requirement of a file that is not judged, because its name may be misspelled.
pub fn unjudged(study: &Study) -> Vec<String> {
    if matches!(study.subject(), Subject::System(_)) {
        return Vec::new();
    }
    let (judged, unjudged): (Vec<_>, Vec<_>) = study.requirements().iter().partition(|one| one.formula.is_some());
    let note = |StatedRequirement { id, .. }: &StatedRequirement| {
        let meant = did_you_mean(&nearest(id, judged.iter().map(|requirement| requirement.id.as_str())));
        format!(
            "requirement `{id}` is not judged: it has no formula, and the scenario has no requirement of this name{meant}"
        )
    };
    unjudged.into_iter().map(note).collect()
}

/// Returns a note if a part of a formula counts at the beginning of a run alone.
pub fn only_at_begin(id: &str, formula: Option<&Formula>) -> Option<String> {
    let part = formula?.only_at_begin()?;
    Some(format!("{id}: `{part}` counts at the beginning of a run alone; `always {part}` is about the whole run"))
}

/// Returns a note if `k` is more than the number of discrete parameters and the space also has continuous parameters.
pub fn capped_strength(k: Option<usize>, space: &Space) -> Option<String> {
    let (discrete, dims) = (space.levels().len(), space.dims());
    let k = k.filter(|k| dims > 0 && (1..*k).contains(&discrete) && *k <= discrete + dims)?;
    let are = if discrete == 1 { "is" } else { "are" };
    Some(format!(
        "k is {k}, but only {} {are} discrete: k is {discrete} for discrete parameters",
        plural(discrete, "parameter")
    ))
}
