//! `paracosm-fuzz likelihood`: estimates the probability that a test fails.

use super::arguments::{ESTIMATED, RUNNING};
use super::output::{Format, FormatOption, Table, digits, json, plural, value_words};
use super::progress::bar;
use super::subject::Subject;
use super::usage;
use super::{Failure, Status, Verbosity, on_interrupt, perceiver, print};
use crate::notes::notes_before;
use crate::space::{Distribution, Domain, Parameter, Record};
use clap::Args;
use paracosm_analysis::likelihood::{Likelihood, Method, Question, of_study};
use paracosm_campaign::{Campaign, Catalogue, Error, Study};
use serde::Serialize;
use std::num::NonZeroUsize;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz likelihood --distribution speed=normal:1.4,0.3 --distribution distance=beta:2,5
  paracosm-fuzz likelihood --open lanes --distribution lanes=weights:7,2,1 --budget 5000
  paracosm-fuzz likelihood --method subset --budget 20000 --set driver.ttc=3
  paracosm-fuzz likelihood highway-traffic --perceiver detector.onnx --open fog --distribution fog=beta:1,8
  paracosm-fuzz likelihood --system 'python3 model.py' --space SPACE.toml
      SPACE.toml has the distributions

monte-carlo counts independent tests. Its interval is valid for every system. qmc spreads tests evenly. Its \
    interval is narrower if few parameters decide. subset reaches rare failures level by level, when monte-carlo \
    finds almost no failure in thousands of tests. All methods estimate. No method proves that a system does not \
    fail.";

/// The options of `likelihood`.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    subject: Subject,
    #[command(flatten)]
    perceiver: perceiver::Options,
    /// The distribution of a parameter
    ///
    /// One of uniform, beta:A,B, normal:MEAN,DEVIATION, lognormal:MEAN,DEVIATION (of the logarithm), triangular:MODE,
    /// histogram:EDGE,WEIGHT,EDGE,.. (up to the last edge), or for a choice weights:W,W,.. in the order of its values [default: the distribution in SPACE.toml, or uniform].
    #[arg(long, value_name = "NAME=DISTRIBUTION", help_heading = ESTIMATED)]
    distribution: Vec<String>,
    /// monte-carlo, qmc or subset
    #[arg(long, value_name = "METHOD", default_value = "monte-carlo", help_heading = ESTIMATED)]
    method: String,
    /// The most tests to run
    #[arg(long, value_name = "N", default_value_t = 1000, help_heading = ESTIMATED)]
    budget: usize,
    /// The probability that the interval is right
    ///
    /// This is the probability that the interval contains the true value.
    #[arg(long, value_name = "C", default_value_t = 0.95, help_heading = ESTIMATED)]
    confidence: f64,
    /// The seed of all random choices
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = ESTIMATED)]
    seed: u64,
    /// The tests that run at a time
    ///
    /// Results do not depend on this number [default: one per core].
    #[arg(long, value_name = "N", help_heading = RUNNING)]
    jobs: Option<NonZeroUsize>,
    #[command(flatten)]
    form: FormatOption,
}

/// The estimate with the distributions of the parameters, as JSON.
#[derive(Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    likelihood: &'a Likelihood,
    budget: usize,
    seed: u64,
    /// The open parameters with their distributions.
    parameters: Record<&'a Distribution>,
    /// The first sentence of the table.
    sentence: String,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let study = self.study(catalogue, verbosity)?;
        let method: Method = self.method.parse()?;
        let question = Question { method, budget: self.budget, confidence: self.confidence, seed: self.seed };
        let supervision = verbosity.supervision();
        let mut campaign = Campaign::until(&study, supervision.clone())?;
        if let Some(jobs) = self.jobs {
            campaign = campaign.jobs(jobs);
        }
        on_interrupt(campaign.stop());
        let bar = bar(verbosity, self.budget);
        let mut failures = 0;
        let likelihood = of_study(&study, &campaign, &question, |trial| {
            failures += usize::from(trial.is_failure());
            bar.set_message(format!("{failures} fail"));
            bar.inc(1);
            Ok(())
        });
        bar.finish_and_clear();
        supervision.doubts.notes().iter().for_each(|note| verbosity.note(note));
        let likelihood = likelihood?;
        print(&match self.form.format {
            Format::Table => table(&likelihood, &study),
            Format::Json => json(&Report {
                likelihood: &likelihood,
                budget: self.budget,
                seed: self.seed,
                parameters: study.space().parameters().iter().map(|p| (p.name.clone(), &p.distribution)).collect(),
                sentence: sentence(&likelihood),
            }),
        })?;
        Ok(Status::Nothing)
    }

    fn study(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Study, Error> {
        self.perceiver.check(&self.subject)?;
        let mut study = self.perceiver.seen(self.subject.study(catalogue, verbosity)?)?;
        for text in &self.distribution {
            let (name, distribution) = text.split_once('=').ok_or_else(|| {
                usage(format!("--distribution {text}: expected NAME=DISTRIBUTION, such as speed=beta:2,5"))
            })?;
            let distribution: Distribution =
                distribution.parse().map_err(|error| usage(format!("--distribution {text}: {error}")))?;
            study = study.distribute(name, distribution);
        }
        let study = study.build()?;
        notes_before(&study)?.iter().for_each(|note| verbosity.note(note));
        Ok(study)
    }
}

fn sentence(likelihood: &Likelihood) -> String {
    let Likelihood { probability, lower, upper, confidence, .. } = likelihood;
    let [probability, lower, upper] = [probability, lower, upper].map(|share| three_digits(*share));
    let confidence = digits(100.0 * confidence);
    format!("A test fails with probability {probability} ({confidence} % interval {lower} to {upper})")
}

fn table(likelihood: &Likelihood, study: &Study) -> String {
    let mut table = Table::default();
    table.heading(&format!("{}, for these distributions:", sentence(likelihood)));
    for parameter in study.space().parameters() {
        table.row(&parameter.name, &distribution(parameter));
    }
    let Likelihood { method, interval, evaluations, failures, unjudged, notes, .. } = likelihood;
    table.heading("How the probability was estimated:");
    table.row("method", method.name());
    table.row("interval", interval);
    let failed = format!("{}, of which {failures} failed", plural(*evaluations, "test"));
    let unjudged = if *unjudged > 0 { format!(" and {unjudged} could not be judged") } else { String::new() };
    table.row("evaluations", &format!("{failed}{unjudged}"));
    for note in notes {
        table.row("note", note);
    }
    table.finish()
}

/// Describes the domain and the distribution of a parameter.
fn distribution(parameter: &Parameter) -> String {
    let unit = parameter.unit.as_ref().map(|unit| format!(" {unit}")).unwrap_or_default();
    let each = if parameter.signal.is_some() { ", each of its coordinates" } else { "" };
    match (&parameter.domain, &parameter.distribution) {
        (Domain::Interval { lo, hi }, distribution) => {
            format!("{distribution} on {}..{}{unit}{each}", digits(*lo), digits(*hi))
        }
        (Domain::Choice(levels), Distribution::Weights(weights)) => {
            let sum: f64 = weights.iter().sum();
            let share = |(level, weight)| format!("{}: {}", value_words(level), digits(weight / sum));
            let shares: Vec<String> = levels.iter().zip(weights).map(share).collect();
            format!("{}{unit}{each}", shares.join(", "))
        }
        (Domain::Choice(levels), distribution) => {
            let levels: Vec<String> = levels.iter().map(value_words).collect();
            format!("{distribution} over {}{unit}{each}", levels.join(", "))
        }
    }
}

/// Rounds an estimate to three digits.
fn three_digits(share: f64) -> String {
    let rounded = format!("{share:.2e}");
    let number: f64 = rounded.parse().expect("it was written so");
    if number != 0.0 && number < 1e-4 { rounded } else { digits(number) }
}
