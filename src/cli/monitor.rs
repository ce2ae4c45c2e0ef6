//! `paracosm-fuzz monitor`: evaluates formulas on a trace, sample by sample.

use super::output::{Format, FormatOption, Table, digits, json, plural};
use super::usage;
use super::{Failure, Status, Verbosity, print};
use crate::notes::only_at_begin;
use crate::oracles::{Cause, Evaluation, Formula, Monitor, Semantics, Trace, Truth};
use clap::Args;
use paracosm_campaign::files::Lines;
use paracosm_campaign::{Error, Number, read_trace};
use serde_json::{Value, json};
use std::io::{self, Read};
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz monitor trace-17.csv --spec 'always (car.speed < 17)' --spec 'eventually[0,9] (car.x > 50)'
  ./vehicle --log-csv | paracosm-fuzz monitor --spec 'always (speed < 30)' --stop-when-decided
  paracosm-fuzz monitor drive.csv --every 0.01 --spec 'always (speed < 30)'
  paracosm-fuzz monitor trace-17.csv --dense --spec 'always[0,0.25] (car.speed > 1)'

A trace is CSV with a header: a column `time` in seconds, evenly spaced from 0 on, and a column for each signal. \
    With --every, the times only need to rise. \
    As soon as a formula is decided, whatever follows, a line on standard error says so.

Exit status: 0 done; 1 a formula is violated (with --fail-on-violation); 2 wrong use or bad input, or a formula \
    stays undecided and none is violated (with --fail-on-violation).";

/// The options of `monitor`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The trace; `-` is standard input
    #[arg(default_value = "-", value_name = "TRACE.csv")]
    trace: PathBuf,
    /// A formula to evaluate; the option can be repeated
    #[arg(long, value_name = "FORMULA", required = true)]
    spec: Vec<String>,
    /// Evaluate formulas in dense time: signals are straight lines between samples, and formulas are about every
    /// instant
    #[arg(long)]
    dense: bool,
    /// Sample the trace again with this period
    ///
    /// The trace may then have any ascending times. Between two samples, a signal is a straight line; a signal with `true` or
    /// `false` keeps its value.
    #[arg(long, value_name = "SECONDS")]
    every: Option<f64>,
    /// End when all formulas are decided, without reading the rest of the trace
    #[arg(long, conflicts_with = "dense")]
    stop_when_decided: bool,
    /// Exit with status 1 if a formula is violated
    #[arg(long)]
    fail_on_violation: bool,
    #[command(flatten)]
    form: FormatOption,
}

/// A formula with its verdict so far.
struct Asked {
    id: String,
    formula: Formula,
    monitor: Option<Monitor>,
    /// The time at which the formula was decided, if this was before the end of the trace.
    decided_at: Option<f64>,
}

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<Status, Failure> {
        let mut asked = Vec::new();
        for (i, text) in self.spec.iter().enumerate() {
            let formula = text.parse().map_err(|error| usage(format!("--spec {text}: {error}")))?;
            let id = format!("spec-{}", i + 1);
            only_at_begin(&id, Some(&formula)).iter().for_each(|note| verbosity.note(note));
            asked.push(Asked { id, formula, monitor: None, decided_at: None });
        }
        let source: Box<dyn Read> = if self.trace.as_os_str() == "-" {
            Box::new(Lines::of(io::stdin().lock()))
        } else {
            Box::new(Lines::open(&self.trace)?)
        };
        if let Some(every) = self.every.filter(|every| !(*every > 0.0 && every.is_finite())) {
            return Err(usage(format!("--every {every}: expected a number of seconds above 0")).into());
        }
        let mut seen = 0;
        let (trace, skipped) = read_trace(&self.trace, source, self.every, |trace| {
            if seen == 0 {
                self.begin(&mut asked, trace)?;
            }
            for (tick, row) in trace.rows().enumerate().skip(seen) {
                for asked in &mut asked {
                    asked.step(row, tick as f64 * trace.dt(), verbosity)?;
                }
            }
            seen = trace.len();
            Ok(!(self.stop_when_decided && asked.iter().all(|asked| asked.decided_at.is_some())))
        })?;
        if skipped.samples > 0 {
            verbosity.note(format_args!(
                "{} of {} read count for nothing in some signal, because they lie between samples of the new period; with --every \
                 {}, every sample but perhaps the last one counts",
                skipped.samples,
                plural(skipped.of, "sample"),
                digits(0.999 * skipped.shortest)
            ));
        }
        let judged: Vec<(&Asked, Evaluation, Option<Cause>)> =
            asked.iter().map(|asked| self.judged(asked, &trace)).collect::<Result<_, Error>>()?;
        print(&match self.form.format {
            Format::Table => self.table(&trace, &judged),
            Format::Json => json(&self.json(&trace, &judged)),
        })?;
        let violated = judged.iter().any(|(_, evaluation, _)| evaluation.truth == Truth::Violated);
        // A gate that says yes although the trace decides nothing would be false assurance.
        let undecided = judged.iter().find(|(_, evaluation, _)| evaluation.truth == Truth::Undecided);
        if let Some((Asked { id, formula, .. }, ..)) = undecided.filter(|_| self.fail_on_violation && !violated) {
            let end = digits((trace.len() - 1) as f64 * trace.dt());
            return Err(format!(
                "{id} `{formula}` is undecided: the trace ends at {end} s, counted from its beginning"
            )
            .into());
        }
        Ok(if self.fail_on_violation && violated { Status::Violation } else { Status::Nothing })
    }

    fn time(&self) -> Semantics {
        if self.dense { Semantics::Dense } else { Semantics::Sampled }
    }

    /// Checks the formulas against the signals, and starts a monitor for each formula in sampled time.
    fn begin(&self, asked: &mut [Asked], trace: &Trace) -> Result<(), Error> {
        for (asked, text) in asked.iter_mut().zip(&self.spec) {
            let wrong = |error: String| usage(format!("--spec {text}: {error}"));
            Formula::parse(text, trace.signals()).map_err(|error| wrong(error.to_string()))?;
            if self.time() == Semantics::Sampled {
                let monitor = Monitor::new(&asked.formula, trace.signals(), trace.dt());
                asked.monitor = Some(monitor.map_err(|error| wrong(error.to_string()))?);
            }
        }
        Ok(())
    }

    fn judged<'a>(&self, asked: &'a Asked, trace: &Trace) -> Result<(&'a Asked, Evaluation, Option<Cause<'a>>), Error> {
        let wrong = |error| usage(format!("{}: {error}", asked.id));
        let evaluation = asked.formula.evaluate_in(self.time(), trace).map_err(wrong)?;
        let cause = asked.formula.explain_in(self.time(), trace).map_err(wrong)?;
        Ok((asked, evaluation, cause))
    }

    fn table(&self, trace: &Trace, judged: &[(&Asked, Evaluation, Option<Cause>)]) -> String {
        let mut table = Table::default();
        table.heading(&format!("{} every {} s", plural(trace.len(), "sample"), digits(trace.dt())));
        for (Asked { id, formula, decided_at, .. }, evaluation, cause) in judged {
            let since = decided_at.map(|time| format!(", known at {} s", digits(time))).unwrap_or_default();
            table.row(id, &formula.to_string());
            table.row("  truth", &format!("{}{since}", word(evaluation.truth)));
            let Evaluation { robustness, lower, upper, .. } = evaluation;
            let open = if lower == upper { String::new() } else { format!(", open from {lower} to {upper}") };
            table.row("  robustness", &format!("{}{open}", digits(*robustness)));
            if let Some(Cause { time, part, .. }) = cause {
                table.row("  cause", &format!("`{part}` at {} s", digits(*time)));
            }
        }
        table.finish()
    }

    fn json(&self, trace: &Trace, judged: &[(&Asked, Evaluation, Option<Cause>)]) -> Value {
        let formula = |(asked, evaluation, cause): &(&Asked, Evaluation, Option<Cause>)| {
            let number = |number: f64| Number(Some(number));
            let cause = cause.map(|cause| json!({"time": cause.time, "part": cause.part.to_string()}));
            json!({"id": asked.id, "formula": asked.formula.to_string(), "truth": word(evaluation.truth),
                "decided_at": asked.decided_at, "robustness": number(evaluation.robustness),
                "lower": number(evaluation.lower), "upper": number(evaluation.upper), "cause": cause})
        };
        let requirements: Vec<Value> = judged.iter().map(formula).collect();
        json!({"samples": trace.len(), "dt": trace.dt(), "complete": trace.is_complete(), "time": self.time(),
            "requirements": requirements})
    }
}

impl Asked {
    /// Takes the next sample.
    fn step(&mut self, row: &[f64], time: f64, verbosity: Verbosity) -> Result<(), Error> {
        let Some(monitor) = &mut self.monitor else { return Ok(()) };
        let truth = monitor.step(row).map_err(|error| usage(format!("{}: {error}", self.id)))?;
        if truth != Truth::Undecided && self.decided_at.is_none() {
            self.decided_at = Some(time);
            verbosity.note(format_args!("{} {} at {} s", self.id, word(truth), digits(time)));
        }
        Ok(())
    }
}

fn word(truth: Truth) -> &'static str {
    match truth {
        Truth::Holds => "holds",
        Truth::Violated => "violated",
        Truth::Undecided => "undecided",
    }
}
