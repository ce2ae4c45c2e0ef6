//! Finds the levels of long choices: a list of tests over a choice of hundreds of thousands of values is read in time
//! that grows with its length, and not with the product of both.

use crate::value::Meaning;
use crate::{Parameter, Value};
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

/// The greatest number of levels among which a value is looked for one by one.
const FEW: usize = 32;

/// The levels of the parameters of a space by their values. The index of a parameter is made when it is first needed.
#[derive(Debug, Clone)]
pub(super) struct Levels(Arc<[OnceLock<Index>]>);

/// The positions of the levels of a choice.
#[derive(Debug, Default)]
struct Index {
    /// The levels that are the same number in several notations, by the bits of the number.
    numbers: HashMap<u64, Vec<usize>>,
    words: HashMap<String, usize>,
}

/// The index follows from the parameters, so that it makes no difference between spaces.
impl PartialEq for Levels {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Levels {
    /// Makes the index of a number of parameters.
    pub fn of(parameters: usize) -> Self {
        Self((0..parameters).map(|_| OnceLock::new()).collect())
    }

    /// Returns the position of a value among the levels of a parameter, as [`Parameter::level`] does. `position` is the
    /// position of the parameter in the space.
    pub fn level(&self, position: usize, parameter: &Parameter, value: &Value) -> Option<usize> {
        let levels = parameter.levels()?;
        if levels.len() <= FEW {
            return parameter.level(value);
        }
        let index = self.0[position].get_or_init(|| Index::of(levels));
        match value.meaning() {
            Meaning::Word(word) => index.words.get(word).copied(),
            Meaning::List(_) => None,
            Meaning::Number(number) => {
                let same = index.numbers.get(&number)?;
                let alike = same.iter().find(|level| levels[**level] == *value);
                alike.or_else(|| same.first().filter(|_| same.len() == 1)).copied()
            }
        }
    }
}

impl Index {
    fn of(levels: &[Value]) -> Self {
        let mut index = Self::default();
        for (level, value) in levels.iter().enumerate() {
            match value.meaning() {
                Meaning::Number(number) => index.numbers.entry(number).or_default().push(level),
                Meaning::Word(word) => drop(index.words.insert(word.to_owned(), level)),
                Meaning::List(_) => (),
            }
        }
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Domain;
    use proptest::prelude::*;

    #[test]
    fn a_value_has_the_level_that_a_search_one_by_one_finds() {
        let notation = |text: &str| Value::parse(text);
        let mut levels: Vec<Value> = (0..100).map(|i| Value::Number(f64::from(i) * 0.5)).collect();
        levels.extend(["1.0", "1.00", "0.50", "007", "-0", "a", "b", "1e3"].map(notation));
        let parameter = Parameter::new("p", Domain::Choice(levels.clone()));
        let index = Levels::of(1);
        let others = ["1", "1.000", "7", "7.0", "0", "-0.0", "1000", "c", "", "0.5", "99"].map(notation);
        for value in levels.iter().chain(&others) {
            assert_eq!(index.level(0, &parameter, value), parameter.level(value), "{value}");
        }
    }

    proptest! {
        #[test]
        fn any_value_has_the_level_that_a_search_one_by_one_finds(
            levels in prop::collection::btree_set("[0-9.]{1,3}|[a-c]{1,2}", 33..60), value in "[0-9.]{1,3}|[a-c]{1,2}",
        ) {
            let levels = levels.iter().map(|text| Value::parse(text)).collect();
            let parameter = Parameter::new("p", Domain::Choice(levels));
            let value = Value::parse(&value);
            prop_assert_eq!(Levels::of(1).level(0, &parameter, &value), parameter.level(&value));
        }
    }
}
