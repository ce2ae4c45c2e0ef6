//! `paracosm-fuzz list`: everything that can be chosen by name.

use super::output::{Format, digits, domain_words, json, value_words};
use super::{Failure, Found, print};
use crate::coverage::Parameter;
use crate::engine::{Declaration, Declared, driver};
use crate::generators::Strategy;
use crate::scenarios;
use clap::Args;
use serde_json::json;
use std::fmt::Write;

/// What `list` takes.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// How to print it [default: table on a terminal, json elsewhere]
    #[arg(long)]
    format: Option<Format>,
}

/// What there is to say of drivers in a process of their own.
const EXTERNAL: &str = "  \
  grpc://HOST:PORT      a driver of your own, which listens there; --driver-command COMMAND starts one
    latency              0 s           from when it is asked to when its answer takes effect
    seed                 0             where its chance and the noise of its sensors come from
";

impl Options {
    pub fn execute(&self) -> Result<Found, Failure> {
        let text = match Format::or_fitting(self.format) {
            Format::Table => table()?,
            Format::Json => json(&as_json()?),
        };
        print(&text).map(|()| Found::Nothing)
    }
}

fn table() -> Result<String, Failure> {
    let mut text = String::from("SCENARIOS\n");
    for program in scenarios::ALL {
        writeln!(text, "  {:<22}{}", program.name, program.about)?;
        let declaration = program.declare()?;
        let widths = widths(&declaration);
        for declared in &declaration.parameters {
            let parameter = &declared.parameter;
            let state = match declared.open {
                true => "open".to_owned(),
                false => format!("{} unless opened", value_words(&declared.nominal())),
            };
            let signal = parameter.signal.map(|shape| format!(", {shape}")).unwrap_or_default();
            let words = words(parameter);
            let [name, domain, unit] = [0, 1, 2].map(|i| format!("{:<1$}", words[i], widths[i]));
            writeln!(text, "    {name}{domain}{unit}{state}{signal}")?;
        }
        for requirement in &declaration.requirements {
            writeln!(text, "    {:<2$}{}", requirement.id, requirement.text, widths[0])?;
        }
    }
    text.push_str("\nSTRATEGIES\n");
    for strategy in Strategy::ALL {
        writeln!(text, "  {:<22}{}", strategy.name(), strategy.about())?;
    }
    text.push_str("\nDRIVERS\n");
    for kind in driver::ALL {
        writeln!(text, "  {:<22}{}", kind.name, kind.about)?;
        for setting in kind.settings {
            let value = format!("{} {}", digits(setting.default), setting.unit);
            writeln!(text, "    {:<21}{value:<14}{}", setting.name, setting.about)?;
        }
    }
    for (name, about) in NETWORKS {
        writeln!(text, "  {name:<22}{about}")?;
        writeln!(text, "    {:<21}{:<14}{}", "latency", "0 s", LATENCY)?;
    }
    text.push_str(EXTERNAL);
    text.push_str("\nParameters: --open NAME[=LO..HI], --set NAME=VALUE. Settings: --set driver.NAME=VALUE.\n");
    Ok(text)
}

/// How wide the columns of a scenario's parameters are at least: names, domains and units.
const COLUMNS: [usize; 3] = [20, 12, 6];

/// The same where something is longer.
fn widths(declaration: &Declaration) -> [usize; 3] {
    let longest = |of: &dyn Fn(&Declared) -> usize| declaration.parameters.iter().map(of).max().unwrap_or(0);
    let width = |i: usize| COLUMNS[i].max(1 + longest(&|declared| words(&declared.parameter)[i].chars().count()));
    [0, 1, 2].map(width)
}

/// What there is in the columns of a parameter.
fn words(parameter: &Parameter) -> [String; 3] {
    [parameter.name.clone(), domain_words(&parameter.domain), parameter.unit.clone().unwrap_or_default()]
}

/// What there is to say of the latency of a driver that has none of its own.
const LATENCY: &str = "from when it is asked to when its answer takes effect";

/// Drivers that are networks, which a program has only if it was built with them.
const NETWORKS: [(&str, &str); 2] = [
    ("cnn", "a network that comes with the software and drives by a camera (feature `neural`)"),
    ("MODEL.onnx", "a network of one's own in a file (feature `neural`)"),
];

fn as_json() -> Result<serde_json::Value, Failure> {
    let mut programs = Vec::new();
    for program in scenarios::ALL {
        let parameters = program.declare()?.parameters;
        let parameters: Vec<_> = parameters
            .iter()
            .map(|declared| json!({"parameter": declared.parameter, "open": declared.open, "nominal": declared.nominal()}))
            .collect();
        programs.push(json!({"name": program.name, "about": program.about, "parameters": parameters}));
    }
    let strategies = Strategy::ALL.map(|strategy| json!({"name": strategy.name(), "about": strategy.about()}));
    let own = driver::ALL.into_iter().map(|kind| {
        let settings: Vec<_> = kind
            .settings
            .iter()
            .map(|setting| {
                json!({"name": setting.name, "default": setting.default, "unit": setting.unit,
                    "range": [setting.range.0, setting.range.1], "about": setting.about})
            })
            .collect();
        json!({"name": kind.name, "about": kind.about, "settings": settings})
    });
    let networks = NETWORKS.into_iter().map(|(name, about)| {
        let latency = json!({"name": "latency", "default": 0.0, "unit": "s", "range": [0.0, 100.0], "about": LATENCY});
        json!({"name": name, "about": about, "settings": [latency]})
    });
    let drivers: Vec<_> = own.chain(networks).collect();
    Ok(json!({"scenarios": programs, "strategies": strategies, "drivers": drivers}))
}
