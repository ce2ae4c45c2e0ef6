//! Describes in words which part of the operational design domain the tests cover.

use super::output::domain_words;
use crate::space::Parameter;
use paracosm_analysis::Effects;
use paracosm_campaign::Study;

/// Returns a line for each attribute, and a line for open parameters that no attribute names. Empty if no design domain
/// is stated.
pub(super) fn lines(study: &Study, effects: Option<&Effects>) -> Vec<(String, String)> {
    let Some(odd) = study.odd() else { return Vec::new() };
    let mut lines: Vec<(String, String)> = Vec::new();
    let range = |parameter: &Parameter| {
        let has_none =
            effects.iter().flat_map(|effects| effects.without_effect()).any(|(name, _)| name == parameter.name);
        format!("{}{}", range(parameter), if has_none { " (no effect)" } else { "" })
    };
    for (name, attribute) in odd.iter() {
        let parameters = attribute.varied.iter().filter_map(|name| study.space().find(name));
        let ranges: Vec<String> = parameters.map(&range).collect();
        let varied = (!ranges.is_empty()).then(|| format!("varied by {}", ranges.join(", ")));
        let fixed = attribute.fixed.as_ref().map(|fixed| format!("fixed: {fixed}"));
        let excluded = attribute.excluded.as_ref().map(|excluded| format!("excluded: {excluded}"));
        let said: Vec<String> = [varied, fixed, excluded].into_iter().flatten().collect();
        lines.push((name.to_owned(), said.join("; ")));
    }
    let named = |parameter: &&Parameter| odd.iter().any(|(_, attribute)| attribute.varied.contains(&parameter.name));
    let others: Vec<String> = study.space().parameters().iter().filter(|p| !named(p)).map(&range).collect();
    if !others.is_empty() {
        lines.push(("no attribute".to_owned(), format!("varied by {}", others.join(", "))));
    }
    lines
}

/// Describes a parameter with its domain.
fn range(parameter: &Parameter) -> String {
    let unit = parameter.unit.as_deref().unwrap_or_default();
    format!("{} {} {unit}", parameter.name, domain_words(&parameter.domain)).trim_end().to_owned()
}
