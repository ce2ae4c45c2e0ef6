//! Writes the rules of a tree in words.

use super::table::Condition;
use super::{Explanation, FOLDS, MOST_LEAVES, Rule};
use paracosm_space::{Coordinate, Space, Value, plural};

/// The coordinates behind the columns of a tree, which give the columns their names.
pub(super) struct Names<'a> {
    columns: Vec<(Coordinate<'a>, Option<(usize, usize)>)>,
}

impl<'a> Names<'a> {
    /// Makes a column for each coordinate of the space.
    pub(super) fn of(space: &'a Space) -> Self {
        let mut discrete = 0..;
        let mut levels = |coordinate: &Coordinate| {
            let levels = coordinate.parameter.levels()?.len();
            Some((discrete.next()?, levels))
        };
        let column = |coordinate: Coordinate<'a>| {
            let levels = levels(&coordinate);
            (coordinate, levels)
        };
        Self { columns: space.coordinates().map(column).collect() }
    }

    /// Returns the coordinates. A discrete coordinate has its position among the discrete ones and its number of
    /// levels.
    pub(super) fn columns(&self) -> impl Iterator<Item = (Coordinate<'a>, Option<(usize, usize)>)> {
        self.columns.iter().copied()
    }

    /// Returns the conditions on the path to a leaf in words: one for each coordinate that the path uses.
    pub(super) fn conditions(&self, path: &[(&Condition, bool)]) -> Vec<String> {
        let of = |column: usize| path.iter().filter(move |(test, _)| test.column() == column);
        let asked = (0..self.columns.len()).filter(|&column| of(column).next().is_some());
        asked.map(|column| self.condition(column, of(column))).collect()
    }

    fn condition<'p>(&self, column: usize, asked: impl Iterator<Item = &'p (&'p Condition, bool)>) -> String {
        let coordinate = &self.columns[column].0;
        let name = coordinate.name();
        let (mut above, mut below) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut levels = vec![true; coordinate.parameter.levels().map_or(0, <[Value]>::len)];
        for (test, answer) in asked {
            match (test, answer) {
                (Condition::Below(_, limit), true) => below = below.min(*limit),
                (Condition::Below(_, limit), false) => above = above.max(*limit),
                (Condition::Among(_, among), answer) => {
                    levels.iter_mut().zip(among).for_each(|(level, among)| *level &= among == answer);
                }
            }
        }
        let unit = coordinate.parameter.unit.as_ref().map(|unit| format!(" {unit}")).unwrap_or_default();
        match (above > f64::NEG_INFINITY, below < f64::INFINITY) {
            (true, true) => format!("{name} between {above} and {below}{unit}"),
            (true, false) => format!("{name} > {above}{unit}"),
            (false, true) => format!("{name} < {below}{unit}"),
            (false, false) => {
                let named = |these: bool| {
                    let all = coordinate.parameter.levels().into_iter().flatten().zip(&levels);
                    let those = all.filter(|(_, level)| **level == these).map(|(value, _)| value.to_string());
                    those.collect::<Vec<_>>()
                };
                let (are, others) = (named(true), named(false));
                if others.len() == 1 && are.len() > 2 {
                    format!("{name} is not {}", others[0])
                } else {
                    format!("{name} is {}", are.join(" or "))
                }
            }
        }
    }
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// Returns the rules in words, one line for each rule.
pub(super) fn rules(explanation: &Explanation) -> Vec<String> {
    let line = |(i, Rule { conditions, tests, failures }): (usize, &Rule)| {
        let opening = if i == 0 { "fails in" } else { "and in" };
        format!("{opening} {failures} of {} where {}", plural(*tests, "test"), conditions.join(" and "))
    };
    explanation.rules.iter().enumerate().map(line).collect()
}

/// Returns a sentence about the reliability of the rules, or about the absence of rules.
pub(super) fn trust(explanation: &Explanation) -> String {
    let Explanation { tests, failures, cross_validated, .. } = explanation;
    if explanation.rules.is_empty() {
        let all = format!("{failures} of {} fail", plural(*tests, "test"));
        return format!("none: no tree of at most {MOST_LEAVES} leaves finds failing tests better than chance; {all}");
    }
    format!(
        "finds {} of the failing tests, and mistakes {} of the passing tests for failing, by {FOLDS}-fold cross-validation",
        percent(cross_validated.recall),
        percent(cross_validated.false_alarms()),
    )
}

/// Returns an explanation as a sentence.
pub(super) fn sentence(explanation: &Explanation) -> String {
    let mut lines = rules(explanation);
    lines.push(trust(explanation));
    lines.join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space() -> Space {
        let text = "parameter = [{ name = \"speed\", interval = [0, 10], unit = \"m/s\" },
            { name = \"weather\", choice = [\"clear\", \"rain\", \"fog\"] },
            { name = \"sky\", choice = [\"day\", \"dusk\", \"night\", \"dawn\"] },
            { name = \"friction\", interval = [0.2, 0.8] }]";
        Space::from_toml(text).unwrap()
    }

    #[test]
    fn what_is_asked_of_one_parameter_is_one_condition() {
        let space = space();
        let names = Names::of(&space);
        let (low, high) = (Condition::Below(0, 4.1), Condition::Below(0, 7.0));
        let (fog, night, slippery) = (
            Condition::Among(1, vec![true, false, false]),
            Condition::Among(2, vec![true, true, false, true]),
            Condition::Below(3, 0.45),
        );
        let conditions = |path: &[(&Condition, bool)]| names.conditions(path);
        assert_eq!(
            conditions(&[(&slippery, true), (&low, false), (&fog, false)]),
            ["speed > 4.1 m/s", "weather is rain or fog", "friction < 0.45"]
        );
        assert_eq!(conditions(&[(&high, true), (&low, false)]), ["speed between 4.1 and 7 m/s"]);
        assert_eq!(conditions(&[(&low, true), (&high, true)]), ["speed < 4.1 m/s"]);
        assert_eq!(conditions(&[(&night, true)]), ["sky is not night"]);
        assert_eq!(conditions(&[(&night, false)]), ["sky is night"]);
        assert!(conditions(&[]).is_empty());
    }
}
