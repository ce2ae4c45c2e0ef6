//! `paracosm-fuzz describe`: shows the parameters, the requirements and the world of a scenario.

use super::draw::{FileKind, Target};
use super::output::{Format, FormatOption, Table, digits, domain_words, json, value_words};
use super::subject::Subject;
use super::{Failure, Status, Verbosity, print};
use crate::engine::{self, signal::SignalAbout};
use crate::engine::{DEFAULT_DT, Declaration, Declared, Program, Run, Setup};
use crate::notes::unjudged;
use crate::oracles::signal;
use crate::space::{Domain, Value};
use crate::standards::opendrive;
use clap::Args;
use paracosm_analysis::points;
use paracosm_campaign::{Catalogue, Error, Study};
use paracosm_report::{birds_eye, plot};
use serde_json::json;
use std::path::PathBuf;

/// The options of `describe`.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    subject: Subject,
    /// Print the graph of the streams in the language of Graphviz
    #[arg(long, conflicts_with = "format")]
    dot: bool,
    /// Draw the world from above at time 0, with values of --set and nominal values, to a file: .svg or .png
    #[arg(long, value_name = "FILE", conflicts_with_all = ["dot", "format"])]
    draw: Option<PathBuf>,
    /// Write the roads of the world to a file of ASAM OpenDRIVE: .xodr
    #[arg(long, value_name = "FILE", conflicts_with_all = ["dot", "draw", "format"])]
    roads: Option<PathBuf>,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let study = self.subject.study(catalogue, verbosity)?.maybe_one_test().build()?;
        unjudged(&study).iter().for_each(|note| verbosity.note(note));
        let program = study.program()?;
        let declaration = program.declare()?;
        if let Some(file) = &self.draw {
            let target = Target::new("--draw", file, &[FileKind::Svg, FileKind::Png], &self.subject.files())?;
            verbosity.note(target.write(|kind| draw(&study, program, &declaration, kind))?);
            return Ok(Status::Nothing);
        }
        if let Some(file) = &self.roads {
            let target = Target::new("--roads", file, &[FileKind::Xodr], &self.subject.files())?;
            let run = world(&study, program, &declaration)?;
            verbosity.note(target.write(|_| Ok(opendrive::write(run.network(), program.name())?.into_bytes()))?);
            return Ok(Status::Nothing);
        }
        let text = match self.form.format {
            _ if self.dot => program.dot()?,
            Format::Table => table(&study, program, &declaration)?,
            Format::Json => as_json(&study, program, &declaration)?,
        };
        print(&text).map(|()| Status::Nothing)
    }
}

/// The world at the beginning of a run.
fn world(study: &Study, program: &Program, declaration: &Declaration) -> Result<Run, Failure> {
    let values = declaration.parameters.iter().map(|declared| {
        let name = &declared.parameter.name;
        (name.clone(), study.fixed().get(name).cloned().unwrap_or_else(|| declared.nominal()))
    });
    Ok(Run::new(program, &values.collect(), Setup::asking_every(DEFAULT_DT))?)
}

/// The world from above.
fn draw(study: &Study, program: &Program, declaration: &Declaration, kind: FileKind) -> Result<Vec<u8>, Failure> {
    let drawing = birds_eye::world(&world(study, program, declaration)?, program.name());
    match kind {
        FileKind::Svg => Ok(drawing.svg().into_bytes()),
        FileKind::Png | FileKind::Gif | FileKind::Csv | FileKind::Xodr => plot::drawing_png(&drawing),
    }
}

fn table(study: &Study, program: &Program, declaration: &Declaration) -> Result<String, Error> {
    let mut table = Table::default();
    table.heading(&format!("{}: {}; {} s", program.name(), program.about(), digits(declaration.duration)));
    table.heading("parameters");
    for declared in &declaration.parameters {
        let opened = study.space().find(&declared.parameter.name);
        let parameter = opened.unwrap_or(&declared.parameter);
        let unit = parameter.unit.as_deref().map(|unit| format!(" {unit}")).unwrap_or_default();
        let nominal = value_words(&declared.nominal());
        let state = match (opened, set(study, declared)) {
            (Some(_), _) => ", open".to_owned(),
            (None, Some(value)) => format!(", set to {}", value_words(value)),
            (None, None) => ", unless opened".to_owned(),
        };
        let signal = parameter.signal.map(|shape| format!(", {shape} over time")).unwrap_or_default();
        let whole = if declared.whole && opened.is_none() { "whole numbers of " } else { "" };
        let domain = format!("{whole}{}", domain_words(&parameter.domain));
        let plausible = declared.plausible().map(|[least, most]| {
            let interval = Domain::Interval { lo: least, hi: most };
            format!(", plausibly {}", domain_words(&interval))
        });
        let plausible = plausible.unwrap_or_default();
        table.row(&parameter.name, &format!("{domain}{unit}, nominally {nominal}{plausible}{state}{signal}"));
    }
    let constraints = constraints(declaration);
    if !constraints.is_empty() {
        table.heading("constraints");
        constraints.iter().for_each(|constraint| table.row("", constraint));
    }
    if let Some(premise) = &declaration.premise {
        table.heading("premise: without this event, a test that violates nothing is inconclusive");
        table.row("", premise);
    }
    table.heading("requirements");
    for requirement in study.requirements() {
        table.row(&requirement.id, &requirement.text);
        let unit = if requirement.unit.is_empty() { "" } else { " " };
        let scale = requirement.scale.map(|scale| format!(", scale {}{unit}{}", digits(scale), requirement.unit));
        let formula = requirement.formula.as_ref().map(ToString::to_string).unwrap_or_default();
        table.row("", &format!("{formula}{}", scale.unwrap_or_default()));
    }
    if let Some(grid) = points::grid(program.name()) {
        table.heading("points");
        table.row(
            grid.name,
            &format!("{} of {}, for a campaign with these options:", digits(grid.points), points::PROTOCOL),
        );
        table.row("", &grid.options());
    }
    table.heading("signals of a trace, for formulas");
    let recorded = study.signals()?.unwrap_or_default();
    for name in &recorded {
        let about =
            engine::signal::about(name).map_or_else(|| "as this formula says".to_owned(), |about| about.in_words());
        table.row(&signal(name).to_string(), &about);
    }
    table.heading("signals that are measured if a formula uses them");
    for (name, about) in on_request(&recorded) {
        table.row(name, &about.in_words());
    }
    let notes = study.notes()?;
    if !notes.is_empty() {
        table.heading("notes");
        notes.iter().for_each(|note| table.row("", note));
    }
    Ok(table.finish())
}

/// Returns the fixed value of a parameter, if it differs from the nominal value.
fn set<'a>(study: &'a Study, declared: &Declared) -> Option<&'a Value> {
    study.fixed().get(&declared.parameter.name).filter(|value| **value != declared.nominal())
}

/// Returns the constraints between the parameters of the scenario.
fn constraints(declaration: &Declaration) -> Vec<String> {
    declaration.constraints.iter().map(|constraint| constraint.expression.to_string()).collect()
}

/// Returns the signals of the scenario, as formulas name them.
fn signals(study: &Study) -> Result<Vec<String>, Error> {
    Ok(study.signals()?.unwrap_or_default().into_iter().map(|name| signal(name).to_string()).collect())
}

/// Returns the signals that are measured if a formula uses them, without the recorded ones.
fn on_request(recorded: &[String]) -> impl Iterator<Item = (&'static str, SignalAbout)> {
    engine::signal::on_request().filter(|(name, _)| !recorded.iter().any(|known| known == name))
}

/// Describes the signals that a formula can use.
fn described(recorded: &[String]) -> Vec<serde_json::Value> {
    let bound = |bound: f64| bound.is_finite().then_some(bound);
    let as_json = |name: &str, about: Option<SignalAbout>, recorded: bool| {
        let mut said = json!({"name": name, "recorded": recorded});
        if let Some(SignalAbout { unit, about, range: [least, greatest] }) = about {
            said["unit"] = unit.into();
            said["about"] = about.into();
            said["range"] = json!([bound(least), bound(greatest)]);
        }
        said
    };
    let of_trace = recorded.iter().map(|name| as_json(name, engine::signal::about(name), true));
    of_trace.chain(on_request(recorded).map(|(name, about)| as_json(name, Some(about), false))).collect()
}

fn as_json(study: &Study, program: &Program, declaration: &Declaration) -> Result<String, Error> {
    let parameters: Vec<_> = declaration
        .parameters
        .iter()
        .map(|declared| {
            let opened = study.space().find(&declared.parameter.name);
            let parameter = opened.unwrap_or(&declared.parameter);
            let mut said = json!({"parameter": parameter, "open": opened.is_some(), "nominal": declared.nominal(),
                "plausible": declared.plausible()});
            if let Some(value) = set(study, declared) {
                said["set"] = json!(value);
            }
            if declared.whole {
                said["whole"] = json!(true);
            }
            said
        })
        .collect();
    let points = points::grid(program.name()).map(
        |grid| json!({"grid": grid.name, "of": grid.points, "protocol": points::PROTOCOL, "options": grid.options()}),
    );
    Ok(json(&json!({"name": program.name(), "about": program.about(), "duration": declaration.duration,
        "parameters": parameters, "constraints": constraints(declaration), "premise": declaration.premise,
        "requirements": study.requirements(), "points": points, "signals": signals(study)?,
        "described_signals": described(&study.signals()?.unwrap_or_default()),
        "notes": study.notes()?})))
}
