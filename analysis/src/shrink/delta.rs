//! Implements delta debugging: finds the fewest things of a set that are needed.

/// Removes as many of `items` as possible, and returns the items from which no further single item can be removed. The
/// algorithm is `ddmin` of Zeller and Hildebrandt, "Simplifying and isolating failure-inducing input", IEEE
/// Transactions on Software Engineering 28(2), 2002. `suffices` checks whether some items are enough; all items
/// together are assumed to be.
pub(super) fn needed<E>(
    items: Vec<usize>,
    mut suffices: impl FnMut(&[usize]) -> Result<bool, E>,
) -> Result<Vec<usize>, E> {
    if items.is_empty() || suffices(&[])? {
        return Ok(Vec::new());
    }
    let (mut kept, mut parts) = (items, 2);
    while kept.len() > 1 {
        let bounds = |part: usize| part * kept.len() / parts..(part + 1) * kept.len() / parts;
        let subsets = (0..parts).map(|part| (kept[bounds(part)].to_vec(), 2));
        let complements = (0..parts).map(|part| {
            let without = bounds(part);
            let rest = kept.iter().enumerate().filter(|(i, _)| !without.contains(i)).map(|(_, item)| *item);
            (rest.collect::<Vec<_>>(), (parts - 1).max(2))
        });
        let mut smaller = None;
        for (candidate, parts) in subsets.chain(complements) {
            if suffices(&candidate)? {
                smaller = Some((candidate, parts));
                break;
            }
        }
        match smaller {
            Some((fewer, next)) => (kept, parts) = (fewer, next),
            None if parts >= kept.len() => break,
            None => parts *= 2,
        }
        parts = parts.min(kept.len()).max(2);
    }
    Ok(kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::convert::Infallible;

    proptest! {
        #[test]
        fn no_single_item_of_what_is_needed_can_be_left_out(
            count in 0_usize..20,
            // Enough is what contains one of these sets.
            enough in prop::collection::vec(prop::collection::btree_set(0_usize..20, 0..4), 1..4),
        ) {
            let suffices = |kept: &[usize]| enough.iter().any(|set| set.iter().all(|item| kept.contains(item)));
            let all: Vec<usize> = (0..count).collect();
            prop_assume!(suffices(&all));
            let Ok(kept) = needed(all, |kept| Ok::<_, Infallible>(suffices(kept)));
            prop_assert!(suffices(&kept));
            for left_out in &kept {
                let fewer: Vec<usize> = kept.iter().copied().filter(|item| item != left_out).collect();
                prop_assert!(!suffices(&fewer), "{kept:?} without {left_out}");
            }
        }
    }
}
