//! What a campaign says at its end, for people and as JSON.

use super::output::{Table, digits, percent, plural, shell_word, value_words};
use super::suspects::Guilt;
use crate::coverage::Value;
use crate::oracles::Verdict;
use crate::{Coverage, Explanation, Promise, Study, Summary, Trial};
use serde_json::json;
use std::collections::BTreeSet;
use std::path::Path;

/// What is printed at the end.
pub(super) struct Report<'a> {
    pub(super) study: &'a Study,
    pub(super) trials: &'a [Trial],
    pub(super) summary: &'a Summary,
    pub(super) coverage: &'a Coverage,
    pub(super) promise: Option<&'a Promise>,
    pub(super) guilt: &'a Guilt,
    pub(super) explanation: Option<&'a Explanation>,
    pub(super) out: &'a Path,
}

const VERDICTS: [Verdict; 5] = [Verdict::Fail, Verdict::Pass, Verdict::Inconclusive, Verdict::Invalid, Verdict::Error];

impl Report<'_> {
    pub(super) fn table(&self) -> String {
        let Self { study, summary, .. } = self;
        let mut table = Table::default();
        table.heading(&format!(
            "{}, driver {}, strategy {}: {} tests",
            study.scenario,
            study.driver.name,
            study.strategy_label(),
            summary.tests()
        ));
        for verdict in VERDICTS {
            let count = summary.count(verdict);
            if count > 0 || matches!(verdict, Verdict::Fail | Verdict::Pass) {
                let share = percent(count as f64 / summary.tests().max(1) as f64);
                table.row(&verdict.to_string(), &format!("{count:<6}{share}"));
            }
        }
        if let Some(known) = &study.extends {
            table.row(
                "extends",
                &format!("{} of {}, which the coverage counts", plural(known.tests, "test"), known.name),
            );
        }
        table.coverage(self.coverage);
        if let Some(promise) = self.promise {
            table.row("random rows", &format!("{}, {} of them different", promise.rows, self.different_rows()));
            table.row("  guaranteed", &promise.words());
            if let Some(Some(measured)) = &self.coverage.discrete {
                table.row("  measured", &format!("{} of {} covered", measured.covered, measured.valid));
            }
        }
        self.guilt.show(&mut table);
        if let Some(explanation) = self.explanation {
            table.row("explanation", &explanation.words);
        }
        table.row("written to", &self.out.display().to_string());
        if let Some(worst) = summary.worst() {
            let trial = &self.trials[worst.index];
            let requirement = study.requirements.iter().find(|r| r.id == worst.requirement);
            let robustness = trial.robustness(&worst.requirement).map(digits).unwrap_or_default();
            let unit = requirement.map(|r| r.unit.as_str()).unwrap_or_default();
            table.row("worst test", &format!("{}: {} {robustness} {unit}", worst.index, worst.requirement));
            table.row("  where", &in_words(study, trial));
            table.row("  replay", &self.replay(worst.index));
        }
        table.finish()
    }

    pub(super) fn json(&self) -> serde_json::Value {
        let counts = VERDICTS.map(|verdict| (verdict.to_string(), self.summary.count(verdict).into()));
        let worst = self.summary.worst().map(|worst| {
            json!({"index": worst.index, "requirement": worst.requirement, "test": self.trials[worst.index].test,
                "robustness": self.trials[worst.index].robustness(&worst.requirement), "replay": self.replay(worst.index)})
        });
        let mut summary = json!({"tests": self.summary.tests(), "verdicts": serde_json::Map::from_iter(counts),
            "coverage": self.coverage, "out": self.out, "worst": worst});
        if let Some(known) = &self.study.extends {
            summary["extends"] = json!(known);
        }
        if let Some(promise) = self.promise {
            summary["random_rows"] = json!(promise);
            summary["random_rows"]["different"] = self.different_rows().into();
        }
        if let Some(explanation) = self.explanation {
            summary["explanation"] = json!(explanation);
        }
        self.guilt.add_to(&mut summary);
        summary
    }

    /// How many different combinations of all discrete values were tested.
    fn different_rows(&self) -> usize {
        let points = self.trials.iter().filter_map(|trial| self.study.space.encode(&trial.test).ok());
        points.map(|point| point.discrete).collect::<BTreeSet<_>>().len()
    }

    /// The command that runs a test again, with the program as it was called.
    fn replay(&self, index: usize) -> String {
        let program = std::env::args().next().unwrap_or_else(|| "paracosm-fuzz".into());
        format!("{} replay {} {index}", shell_word(&program), shell_word(&self.out.to_string_lossy()))
    }
}

/// Where a test is: its values with their units.
pub(super) fn in_words(study: &Study, trial: &Trial) -> String {
    let value = |(name, value): (&str, &Value)| {
        let value = value_words(value);
        let unit = study.space.parameter(name).ok().and_then(|p| p.unit.as_deref()).unwrap_or_default();
        format!("{name} {value} {unit}").trim_end().to_owned()
    };
    trial.test.iter().map(value).collect::<Vec<_>>().join(", ")
}
