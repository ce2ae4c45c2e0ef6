//! Finds the valid name that is nearest to an unknown name, so that error messages can suggest it.

/// The longest name in bytes for which a similar name is sought.
const LONGEST: usize = 200;

/// Returns the candidate that is most similar to `name`, or `None` if no candidate is similar enough.
///
/// Similarity is the normalised Damerau-Levenshtein similarity, ignoring case. A candidate needs at least 0.4. Names of
/// more than 200 bytes have no similar name, since the time grows with the square of the length.
///
/// ```
/// assert_eq!(paracosm_space::nearest("haltom", ["random", "halton"]), Some("halton"));
/// assert_eq!(paracosm_space::nearest("zzz", ["random", "halton"]), None);
/// ```
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let is_short = |name: &str| name.len() <= LONGEST;
    if !is_short(name) {
        return None;
    }
    let name = name.to_lowercase();
    candidates
        .into_iter()
        .filter(|candidate| is_short(candidate))
        .map(|candidate| {
            let likeness = strsim::normalized_damerau_levenshtein(&name, &candidate.to_lowercase());
            (likeness, candidate)
        })
        .filter(|(likeness, _)| *likeness >= 0.4)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// Returns the end of an error message, which suggests the given name. An example is ` (did you mean `halton`?)`. The
/// result is empty if there is no suggestion.
pub fn did_you_mean(nearest: &Option<impl AsRef<str>>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{}`?)", name.as_ref())).unwrap_or_default()
}
