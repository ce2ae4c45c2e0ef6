//! The summary at the end of a campaign, as a table and as JSON.

use super::odd;
use super::output::{Table, digits, impacts_in_words, percent, plural, value_words};
use super::suspects;
use crate::Report;
use crate::engine::Violation;
use crate::oracles::Verdict;
use crate::space::Value;
use paracosm_analysis::{Effects, Inconclusive, Judged, Modes, Plausible, RangeRecall, Segmented, Worst};
use paracosm_campaign::{Artefact, Extension, ExtensionRecord, Finish, Number, Study, Trial};
use paracosm_report::plot::MapFiles;
use paracosm_report::{command_option, shell_word};
use serde_json::json;
use std::collections::BTreeSet;
use std::path::Path;

/// The number of failure modes in a table.
const MODES_SHOWN: usize = 5;

/// A report with all that the summary needs.
pub(super) struct Printed<'a> {
    pub report: &'a Report,
    pub out: &'a Path,
    /// The name by which the user called the program.
    pub program: &'a str,
    /// True if the user asked to locate guilty combinations.
    pub locate: bool,
}

impl Printed<'_> {
    pub(super) fn table(&self) -> String {
        let (study, summary) = (self.study(), &self.report.summary);
        let mut table = Table::default();
        let strategy = if study.is_one_test() { String::new() } else { format!(", strategy {}", study.sampling()) };
        table.heading(&format!("{}{strategy}: {}", study.title(), plural(summary.tests(), "test")));
        for verdict in Verdict::ALL {
            let count = summary.count(verdict);
            if count > 0 || matches!(verdict, Verdict::Fail | Verdict::Pass) {
                let share = percent(count as f64 / summary.tests().max(1) as f64);
                let meaning = meaning(verdict);
                table.row(&verdict.to_string(), &format!("{count:<5} {share}{meaning}"));
                let first = self.report.log.trials().iter().find(|trial| trial.verdict == verdict);
                if let Some((index, problem)) = first.and_then(|trial| Some((trial.index, trial.error()?))) {
                    table.row("", &format!("such as test {index}: {}", problem.lines().next().unwrap_or_default()));
                }
            }
        }
        for (i, doubt) in self.report.doubts.iter().enumerate() {
            table.row(if i == 0 { "doubts" } else { "" }, doubt);
        }
        for (i, judged) in summary.requirements().iter().enumerate() {
            table.row(if i == 0 { "requirements" } else { "" }, &self.in_words(judged));
        }
        for (i, (name, words)) in odd::lines(study, self.report.effects.as_ref()).iter().enumerate() {
            table.row(if i == 0 { "design domain" } else { "" }, &format!("{name}: {words}"));
        }
        if self.stopped() {
            table.row(
                "stopped",
                &format!("at the first failing test; the budget was {}", plural(study.sampling().budget, "test")),
            );
        }
        self.show_perceived(&mut table);
        if let Some(impacts) = &self.report.impacts {
            table.row("impact speed", &impacts_in_words(impacts));
        }
        if let Some(points) = &self.report.points {
            table.row("points on this grid", &points.in_words());
            if points.points.is_none() {
                let (program, scenario) =
                    (self.program, study.subject().scenario().map_or("", |simulation| simulation.scenario()));
                let how = format!("`{} describe {scenario}` has the options of the whole grid", shell_word(program));
                table.row("", &how);
            }
            table.row("  protocol", points.protocol);
        }
        self.show_modes(&mut table);
        if let Some(explanation) = &self.report.explanation {
            let rules = explanation.rules_in_words();
            let lines = rules.iter().map(|rule| ("", rule.as_str()));
            let trust = explanation.trust_in_words();
            let lines = lines.chain([(if rules.is_empty() { "" } else { "  how good" }, trust.as_str())]);
            for (i, (name, line)) in lines.enumerate() {
                table.row(if i == 0 { "explanation" } else { name }, line);
            }
        }
        let mut label = "inconclusive";
        for line in self.report.inconclusive.iter().flat_map(Inconclusive::in_words) {
            table.row(std::mem::take(&mut label), &line);
        }
        let mut label = "no effect";
        for line in self.report.effects.iter().flat_map(Effects::in_words) {
            table.row(std::mem::take(&mut label), &line);
        }
        suspects::show(&mut table, self.report, self.locate);
        if let Some(map) = &self.report.map {
            let file =
                MapFiles::Failures(map).files().into_iter().find(|file| file.ends_with(".png")).unwrap_or_default();
            let path = self.out.join(file);
            table.row("picture", &format!("{}, over {} and {}", path.display(), map.x.label, map.y.label));
        }
        if let Some(known) = self.extends() {
            table.row(
                "extends",
                &format!("{} of {}; the coverage counts them", plural(known.tests, "test"), known.name),
            );
        }
        match self.report.coverage.tests {
            0 => table.row("coverage", "nothing is covered, because no test has a result"),
            _ => table.coverage(&self.report.coverage),
        }
        if let Some(promise) = &self.report.promise {
            table.row("random rows", &format!("{}, {} of them different", promise.rows, self.different_rows()));
            table.row("  guaranteed", &promise.words());
            if let Some(Some(measured)) = &self.report.coverage.discrete {
                table.row("  measured", &format!("{} of {} covered", measured.covered, measured.valid));
            }
        }
        table.row("written to", &self.out.display().to_string());
        let worst = summary.worst(self.report.log.scales());
        if let Some(worst) = &worst {
            self.show_worst(&mut table, "worst test", worst);
        }
        if let Some(plausible) = &self.report.plausible {
            let range = |(name, [least, most]): (&str, &[f64; 2])| {
                let unit = study.space().find(name).and_then(|parameter| parameter.unit.as_deref()).unwrap_or_default();
                format!("{name} {}..{} {unit}", digits(*least), digits(*most)).trim_end().to_owned()
            };
            let ranges = plausible.ranges.iter().map(range).collect::<Vec<_>>().join(", ");
            let tests = plural(plausible.summary.tests(), "test");
            let failing = plausible.summary.count(Verdict::Fail);
            let words = format!("{ranges}; {failing} of {tests} fail");
            match plausible.summary.worst(self.report.log.scales()) {
                None if plausible.summary.tests() == 0 => table.row("plausible", &format!("no test has {ranges}")),
                None => table.row("plausible", &words),
                Some(found) if worst.as_ref() == Some(&found) => {
                    table.row("  plausible", &words);
                }
                Some(found) => {
                    self.show_worst(&mut table, "worst plausible", &found);
                    table.row("  plausible", &words);
                }
            }
        }
        table.finish()
    }

    pub(super) fn json(&self) -> serde_json::Value {
        let counts = Verdict::ALL.map(|verdict| (verdict.to_string(), self.report.summary.count(verdict).into()));
        let (study, summary) = (self.study(), &self.report.summary);
        let as_json = |worst: Worst| {
            let trial = &self.report.log.trials()[worst.index];
            let mut said = json!({"index": worst.index, "requirement": worst.requirement, "test": trial.test,
                "robustness": trial.robustness(&worst.requirement), "replay": self.replay(worst.index)});
            if let Some(Violation { time, part, .. }) = trial.violation(&worst.requirement) {
                said["cause"] = json!({"time": time, "part": part});
            }
            said
        };
        let worst = summary.worst(self.report.log.scales()).map(as_json);
        let requirements: Vec<_> = summary
            .requirements()
            .iter()
            .map(|judged| {
                let worst = judged
                    .worst
                    .map(|(robustness, index)| json!({"index": index, "robustness": Number(Some(robustness))}));
                let mut said =
                    json!({"id": judged.id, "violated": judged.violated, "undecided": judged.undecided, "worst": worst});
                if let Some(stated) = study.requirement(&judged.id) {
                    said["text"] = stated.text.as_str().into();
                    let more = [("source", &stated.source), ("severity", &stated.severity)];
                    for (key, value) in more.into_iter().filter_map(|(key, value)| Some((key, value.as_ref()?))) {
                        said[key] = value.as_str().into();
                    }
                }
                said
            })
            .collect();
        let mut printed = json!({"tests": summary.tests(), "verdicts": serde_json::Map::from_iter(counts),
            "requirements": requirements,
            "coverage": self.report.coverage, "out": self.out, "worst": worst});
        if !self.report.doubts.is_empty() {
            printed["doubts"] = json!(self.report.doubts);
        }
        if let Some(Plausible { ranges, summary }) = &self.report.plausible {
            printed["plausible"] = json!(ranges);
            printed["worst_plausible"] = json!(summary.worst(self.report.log.scales()).map(as_json));
        }
        if let Some(impacts) = &self.report.impacts {
            printed["impact_speed"] = json!(impacts);
        }
        if let Some(points) = &self.report.points {
            printed["points"] = json!(points);
        }
        if let Some(odd) = study.odd() {
            printed["odd"] = json!(odd);
        }
        if let Some(known) = self.extends() {
            printed["extends"] = json!(known);
        }
        if let Some(promise) = &self.report.promise {
            printed["random_rows"] = json!(promise);
            printed["random_rows"]["different"] = self.different_rows().into();
        }
        if let Some(explanation) = &self.report.explanation {
            printed["explanation"] = json!(explanation);
        }
        if let Some(inconclusive) = &self.report.inconclusive {
            printed["inconclusive"] = json!(inconclusive);
        }
        suspects::add_to(&mut printed, self.report);
        if study.sampling().stop_at_first {
            printed["stopped_at_first"] = self.stopped().into();
        }
        if let Some(perceived) = &self.report.perceived {
            printed["perception"] = json!(perceived);
        }
        printed["without_effect"] =
            self.report.effects.iter().flat_map(Effects::without_effect).map(|(name, _)| name).collect();
        printed["modes"] = json!(self.report.modes.modes);
        printed
    }

    fn study(&self) -> &Study {
        self.report.log.study()
    }

    /// Returns the record of the tests that count as done.
    fn extends(&self) -> Option<&ExtensionRecord> {
        self.report.log.done_before().map(Extension::record)
    }

    /// Describes the result of a requirement.
    fn in_words(&self, judged: &Judged) -> String {
        let Judged { id, violated, undecided, worst } = judged;
        let mut text = format!("{id}: violated in {}", plural(*violated, "test"));
        if *undecided > 0 {
            text.push_str(&format!(", undecided in {undecided}"));
        }
        if let Some((robustness, index)) = worst {
            text.push_str(&format!("; at worst {} (test {index})", self.robustness(id, *robustness)));
        }
        if let Some(stated) = self.study().requirement(id) {
            let said = stated.severity.iter().chain(&stated.source);
            said.for_each(|word| text.push_str(&format!("; {word}")));
        }
        text
    }

    /// Prints a robustness with the unit of its requirement.
    fn robustness(&self, requirement: &str, robustness: f64) -> String {
        let unit = self.study().requirement(requirement).map_or("", |requirement| requirement.unit.as_str());
        format!("{} {unit}", digits(robustness)).trim_end().to_owned()
    }

    /// Returns true if the first failing test has ended the campaign.
    fn stopped(&self) -> bool {
        self.report.finish == Finish::Stopped
    }

    /// Adds the results of the perceiver to the table.
    fn show_perceived(&self, table: &mut Table) {
        let Some(perceived) = &self.report.perceived else { return };
        table.row("images", &perceived.images.to_string());
        if let Some(Segmented { overlap, recall, precision }) = &perceived.segmentation {
            let [overlap, recall, precision] = [overlap, recall, precision].map(|share| percent(*share));
            table.row("pixels", &format!("overlap (IoU) {overlap}, recall {recall}, precision {precision}"));
        }
        if let Some(detected) = &perceived.detection {
            let recall = detected.recall.map_or("none".to_owned(), percent);
            let alarms = format!("{:.2}", detected.false_alarms_per_image);
            table.row(
                "recall",
                &format!(
                    "{recall} of {}, false alarms an image {alarms}",
                    plural(detected.objects as usize, "road user")
                ),
            );
            table.row("encounters", &detected.encounters_in_words());
            for (i, RangeRecall { words, objects, matches, .. }) in detected.ranges.iter().enumerate() {
                let share = percent(*matches as f64 / *objects as f64);
                table.row(if i == 0 { "recall by" } else { "" }, &format!("{words}: {share} of {objects}"));
            }
        }
    }

    /// Adds the failure modes to the table.
    fn show_modes(&self, table: &mut Table) {
        let Modes { modes, .. } = &self.report.modes;
        for (i, mode) in modes.iter().take(MODES_SHOWN).enumerate() {
            let tests = match mode.count {
                1 => format!("test {}", mode.representative),
                count => format!("{count} tests, such as test {}", mode.representative),
            };
            table.row(if i == 0 { "failure modes" } else { "" }, &format!("{tests}: {}", mode.words));
        }
        if modes.len() > MODES_SHOWN {
            table.row("", &format!("and {} more in modes.json", modes.len() - MODES_SHOWN));
        }
    }

    /// Adds a test with the requirement that makes it the worst, and the commands about it.
    fn show_worst(&self, table: &mut Table, label: &str, Worst { index, requirement }: &Worst) {
        let trial = &self.report.log.trials()[*index];
        let robustness = self.robustness(requirement, trial.robustness(requirement).unwrap_or(f64::NAN));
        table.row(label, &format!("{index}: {requirement} {robustness}"));
        table.row("  where", &in_words(self.study(), trial));
        if let Some(Violation { time, part, .. }) = trial.violation(requirement) {
            table.row("  why", &format!("`{part}` at {} s", digits(*time)));
        }
        if trial.is_failure() {
            table.row("  shrink", &self.command("shrink", *index));
        }
        table.row("  replay", &self.replay(*index));
    }

    /// Counts the different combinations of all discrete values among the tests.
    fn different_rows(&self) -> usize {
        let space = self.study().space();
        let points = self.report.log.trials().iter().filter_map(|trial| space.encode(&trial.test).ok());
        points.map(|point| point.discrete).collect::<BTreeSet<_>>().len()
    }

    /// Returns the command that runs a test again.
    fn replay(&self, index: usize) -> String {
        self.command("replay", index)
    }

    /// Returns a command about a test, with the program as it was called.
    fn command(&self, verb: &str, index: usize) -> String {
        let (program, out) = (shell_word(self.program), shell_word(&self.out.to_string_lossy()));
        format!("{program} {verb} {out} {index}{}", command_option(self.study()))
    }
}

/// Explains a verdict that is neither pass nor fail.
fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Unpreventable => "; no reference driver avoids them",
        Verdict::Inconclusive => "; their situation never came about, or they ended too early",
        Verdict::Invalid => "; their worlds cannot be built, and they cover nothing",
        Verdict::Error => "; they broke, and cover nothing",
        Verdict::Pass | Verdict::Fail => "",
    }
}

/// Describes a test by its values with their units.
pub(super) fn in_words(study: &Study, trial: &Trial) -> String {
    let value = |(name, value): (&str, &Value)| {
        let value = value_words(value);
        let unit = study.space().find(name).and_then(|p| p.unit.as_deref()).unwrap_or_default();
        format!("{name} {value} {unit}").trim_end().to_owned()
    };
    let values = if study.is_one_test() { study.fixed() } else { &trial.test };
    values.iter().map(value).collect::<Vec<_>>().join(", ")
}
