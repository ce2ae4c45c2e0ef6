use crate::{ALL, DefectError, find};
use std::collections::BTreeSet;

#[test]
fn every_kind_has_a_name_of_its_own_a_sentence_a_source_and_a_ladder_of_sizes() {
    assert!(ALL.len() >= 30, "{} kinds", ALL.len());
    let names: BTreeSet<_> = ALL.iter().map(|kind| kind.name).collect();
    assert_eq!(names.len(), ALL.len());
    for kind in ALL {
        let name = kind.name;
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{name}");
        assert!((6..=10).contains(&kind.sizes.len()), "{name} has {} sizes", kind.sizes.len());
        let rises = kind.sizes.is_sorted_by(|a, b| a < b);
        assert!(rises || kind.sizes.is_sorted_by(|a, b| a > b), "{name}: {:?}", kind.sizes);
        assert!(kind.range().0 >= 0.0 && kind.sizes.iter().all(|size| size.is_finite()), "{name}");
        assert!(!kind.unit.is_empty() && !kind.source.is_empty(), "{name}");
        let speaks_of_its_size = kind.about.contains("size");
        assert!(speaks_of_its_size && !kind.about.ends_with('.'), "{name}: {}", kind.about);
    }
}

#[test]
fn an_unknown_kind_is_refused_with_the_nearest_name() {
    assert_eq!(find("late-reaction").unwrap().unit, "s");
    let error = find("late-reactoin").unwrap_err();
    assert_eq!(error, DefectError::Unknown { name: "late-reactoin".into(), nearest: Some("late-reaction") });
    let words = "no kind of defect is called `late-reactoin` (did you mean `late-reaction`?)";
    assert_eq!(error.to_string(), words);
}
