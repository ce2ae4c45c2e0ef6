//! The nearest valid name to one that is unknown, for error messages that help.

/// The candidate most like `name`, unless none is alike enough to be what was meant.
///
/// Similarity is the normalised Damerau-Levenshtein distance, ignoring case; below 0.4 nothing is suggested.
///
/// ```
/// assert_eq!(paracosm_space::nearest("haltom", ["random", "halton"]), Some("halton"));
/// assert_eq!(paracosm_space::nearest("zzz", ["random", "halton"]), None);
/// ```
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| {
            let likeness = strsim::normalized_damerau_levenshtein(&name, &candidate.to_lowercase());
            (likeness, candidate)
        })
        .filter(|(likeness, _)| *likeness >= 0.4)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// The end of a message about an unknown name: ` (did you mean `halton`?)`, or nothing.
pub fn did_you_mean(nearest: &Option<impl AsRef<str>>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{}`?)", name.as_ref())).unwrap_or_default()
}
