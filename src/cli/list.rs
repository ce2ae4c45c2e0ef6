//! `paracosm-fuzz list`: shows everything that has a name.

mod markdown;
mod standards;

use super::output::{column, digits, domain_words, json, value_words};
use super::{Failure, Status, print};
use crate::campaign::study::ListedDriver;
use crate::engine::driver::Setting;
use crate::engine::sensor::CameraSetting;
use crate::engine::{Declaration, Declared, Program};
use crate::space::{Domain, Parameter};
use crate::standards::{opendrive, openscenario};
use crate::{Catalogue, Lists};
use clap::{Args, ValueEnum};
use markdown::{markdown, named};
use serde_json::json;
use standards::standard;
use std::fmt::Write;

/// The options of `list`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The kind to list [default: all kinds]
    #[arg(value_enum)]
    kind: Option<ListKind>,
    /// The form of the list
    #[arg(long, value_enum, default_value_t)]
    format: Form,
}

/// The form of what is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Form {
    /// For people
    #[default]
    Table,
    /// For programs
    Json,
    /// For a document
    Markdown,
}

/// The kinds of named things.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ListKind {
    /// Worlds with their parameters and requirements
    Scenarios,
    /// Strategies, which choose tests
    Strategies,
    /// Drivers, which are systems under test, with their settings
    Drivers,
    /// Measures of how well tests cover a space
    Measures,
    /// Sensors of drivers
    Sensors,
    /// Settings of cameras
    Cameras,
    /// Signals of the ego vehicle, for formulas
    Signals,
    /// Elements of files of roads, ASAM OpenDRIVE (only if it is named)
    Opendrive,
    /// Elements of files of scenarios, ASAM OpenSCENARIO XML (only if it is named)
    Openscenario,
}

impl ListKind {
    /// The kinds of things that have a name in this software.
    const NAMED: [Self; 7] =
        [Self::Scenarios, Self::Strategies, Self::Drivers, Self::Measures, Self::Sensors, Self::Cameras, Self::Signals];
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue) -> Result<Status, Failure> {
        let lists = Lists::of(catalogue);
        let kinds = self.kind.map_or_else(|| ListKind::NAMED.to_vec(), |kind| vec![kind]);
        let text = match self.format {
            form if self.kind == Some(ListKind::Opendrive) => standard(opendrive::elements(), &standards::ROADS, form),
            form if self.kind == Some(ListKind::Openscenario) => {
                standard(openscenario::elements(), &standards::SCENARIOS, form)
            }
            Form::Table => table(&lists, &kinds)?,
            Form::Json => json(&as_json(&lists, &kinds)?),
            Form::Markdown => markdown(&lists, &kinds)?,
        };
        print(&text).map(|()| Status::Nothing)
    }
}

fn table(lists: &Lists, kinds: &[ListKind]) -> Result<String, Failure> {
    let mut text = String::new();
    for kind in kinds {
        let key = key(*kind);
        writeln!(text, "{}{}", if text.is_empty() { "" } else { "\n" }, key.to_uppercase())?;
        match kind {
            ListKind::Scenarios => scenarios(lists, &mut text)?,
            ListKind::Drivers => drivers(lists, &mut text)?,
            ListKind::Strategies
            | ListKind::Measures
            | ListKind::Sensors
            | ListKind::Cameras
            | ListKind::Signals
            | ListKind::Opendrive
            | ListKind::Openscenario => {
                let named = named(lists, *kind);
                let width = column(named.iter().map(|(name, _)| name.len() + 1).max().unwrap_or_default().max(22));
                for (name, about) in named {
                    writeln!(text, "  {name:<width$}{about}")?;
                }
            }
        }
    }
    text.push_str("\nParameters: --open NAME[=LO..HI], --set NAME=VALUE. Settings: --set driver.NAME=VALUE.\n");
    Ok(text)
}

/// The key of a kind in JSON, and its heading.
fn key(kind: ListKind) -> String {
    kind.to_possible_value().expect("no kind is hidden").get_name().to_owned()
}

fn scenarios(lists: &Lists, text: &mut String) -> Result<(), Failure> {
    for program in &lists.scenarios {
        writeln!(text, "  {:<22}{}", program.name(), program.about())?;
        let declaration = match program.declare() {
            Ok(declaration) => declaration,
            // A wrong scenario must not hide the others.
            Err(error) => {
                writeln!(text, "    error: {error}")?;
                continue;
            }
        };
        let widths = widths(&declaration);
        for declared in &declaration.parameters {
            let parameter = &declared.parameter;
            let signal = parameter.signal.map(|shape| format!(", {shape}")).unwrap_or_default();
            let words = scenario_words(declared);
            let state = if declared.open { "open".to_owned() } else { format!("{} unless opened", words[3]) };
            let [name, domain, unit] = [0, 1, 2].map(|i| format!("{:<1$}", words[i], widths[i]));
            writeln!(text, "    {name}{domain}{unit}{state}{signal}")?;
        }
        for requirement in &declaration.requirements {
            writeln!(text, "    {:<2$}{}", requirement.id, requirement.text, widths[0])?;
        }
    }
    Ok(())
}

fn drivers(lists: &Lists, text: &mut String) -> Result<(), Failure> {
    for driver in &lists.drivers {
        writeln!(text, "  {:<22}{}", driver.name, driver.about)?;
        for setting in driver.settings {
            let value = format!("{} {}", digits(setting.default), setting.unit);
            writeln!(text, "    {:<21}{value:<14}{}", setting.name, setting.about)?;
        }
    }
    Ok(())
}

/// The least widths of the columns of a scenario's parameters: names, domains and units.
const COLUMNS: [usize; 3] = [20, 12, 6];

/// Returns the widths of the columns for this scenario.
fn widths(declaration: &Declaration) -> [usize; 3] {
    let longest = |of: &dyn Fn(&Declared) -> usize| declaration.parameters.iter().map(of).max().unwrap_or(0);
    let width = |i: usize| column(COLUMNS[i].max(1 + longest(&|declared| scenario_words(declared)[i].chars().count())));
    [0, 1, 2].map(width)
}

/// Describes a parameter: its name, its domain, its unit, and its value if it is not opened.
fn scenario_words(declared: &Declared) -> [String; 4] {
    let Parameter { name, domain, unit, .. } = &declared.parameter;
    let nominal = if declared.open { "open".to_owned() } else { value_words(&declared.nominal()) };
    let opened = declared.opens.as_ref().map(|opened| format!(", opened {}", domain_words(opened)));
    let plausible =
        declared.plausible.map(|[lo, hi]| format!(", plausible {}", domain_words(&Domain::Interval { lo, hi })));
    let texts = declared.takes_texts.then(|| " or a text".to_owned());
    [
        name.clone(),
        domain_words(domain) + &opened.or(plausible).or(texts).unwrap_or_default(),
        unit.clone().unwrap_or_default(),
        nominal,
    ]
}

fn as_json(lists: &Lists, kinds: &[ListKind]) -> Result<serde_json::Value, Failure> {
    let mut all = serde_json::Map::new();
    for kind in kinds {
        let list: Vec<serde_json::Value> = match kind {
            ListKind::Scenarios => lists.scenarios.iter().map(scenario).collect(),
            ListKind::Drivers => lists.drivers.iter().map(driver).collect(),
            ListKind::Cameras => lists.cameras.iter().map(camera).collect(),
            ListKind::Strategies
            | ListKind::Measures
            | ListKind::Sensors
            | ListKind::Signals
            | ListKind::Opendrive
            | ListKind::Openscenario => {
                named(lists, *kind).into_iter().map(|(name, about)| json!({"name": name, "about": about})).collect()
            }
        };
        all.insert(key(*kind), list.into());
    }
    Ok(all.into())
}

fn scenario(program: &Program) -> serde_json::Value {
    let declaration = match program.declare() {
        Ok(declaration) => declaration,
        Err(error) => {
            return json!({"name": program.name(), "about": program.about(), "error": error.to_string()});
        }
    };
    let parameters: Vec<_> = declaration
        .parameters
        .iter()
        .map(|declared| {
            json!({"parameter": declared.parameter, "open": declared.open, "nominal": declared.nominal(),
                "opened": declared.opened(), "plausible": declared.plausible()})
        })
        .collect();
    json!({"name": program.name(), "about": program.about(), "parameters": parameters})
}

fn camera(setting: &CameraSetting) -> serde_json::Value {
    json!({"name": setting.name, "key": setting.key, "default": setting.default, "unit": setting.unit,
        "range": [setting.range.0, setting.range.1], "about": setting.about})
}

fn driver(driver: &ListedDriver) -> serde_json::Value {
    let setting = |setting: &Setting| {
        json!({"name": setting.name, "default": setting.default, "unit": setting.unit,
            "range": [setting.range.0, setting.range.1], "about": setting.about})
    };
    let settings: Vec<_> = driver.settings.iter().map(setting).collect();
    json!({"name": driver.name, "about": driver.about, "settings": settings})
}

#[cfg(test)]
mod tests;
