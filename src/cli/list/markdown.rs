//! The lists as tables of a document: `docs/reference.md` is the text that this module makes.

use super::{ListKind, key, scenario_words};
use crate::Lists;
use crate::cli::Failure;
use crate::cli::output::digits;
use crate::engine::object::VehicleKind;
use crate::engine::signal::{self, SignalAbout};
use crate::engine::vehicle::{Resistance, VehicleSetting};
use std::borrow::Cow;
use std::fmt::Write;

/// The lists of these kinds, each under a heading.
pub(super) fn markdown(lists: &Lists, kinds: &[ListKind]) -> Result<String, Failure> {
    let mut text = String::from("# Everything that can be chosen by name\n\n");
    text.push_str(
        "`paracosm-fuzz list --format markdown` prints this page. A test compares the page with the command.\n",
    );
    for kind in kinds {
        let key = key(*kind);
        let (first, rest) = key.split_at(1);
        write!(text, "\n## {}{rest}\n\n| name | about |\n| --- | --- |\n", first.to_uppercase())?;
        for (name, about) in named(lists, *kind) {
            writeln!(text, "| `{name}` | {about} |")?;
        }
        match kind {
            ListKind::Scenarios => {
                parameters(lists, &mut text)?;
                vehicles(&mut text)?;
                resistances(&mut text)?;
            }
            ListKind::Drivers => settings(lists, &mut text)?,
            ListKind::Cameras => cameras(lists, &mut text)?,
            ListKind::Strategies
            | ListKind::Measures
            | ListKind::Sensors
            | ListKind::Signals
            | ListKind::Opendrive
            | ListKind::Openscenario => {}
        }
    }
    Ok(text)
}

/// Name and meaning of all of a kind.
pub(super) fn named(lists: &Lists, kind: ListKind) -> Vec<(&str, Cow<'_, str>)> {
    let borrowed = |(name, about): (&'static str, &'static str)| (name, Cow::Borrowed(about));
    match kind {
        ListKind::Scenarios => lists.scenarios.iter().map(|it| (it.name(), Cow::Borrowed(it.about()))).collect(),
        ListKind::Strategies => lists.strategies.iter().map(|it| borrowed((it.name(), it.about()))).collect(),
        ListKind::Drivers => lists.drivers.iter().map(|it| borrowed((it.name, it.about))).collect(),
        ListKind::Measures => lists.measures.iter().map(|it| borrowed((it.name(), it.descriptor().about))).collect(),
        ListKind::Sensors => lists.sensors.iter().map(|it| borrowed((it.name, it.about))).collect(),
        ListKind::Cameras => lists.cameras.iter().map(|it| borrowed((it.name, it.about))).collect(),
        ListKind::Signals => signals(),
        // The elements of standards have lists of their own form.
        ListKind::Opendrive | ListKind::Openscenario => Vec::new(),
    }
}

/// The signals of the ego vehicle, and whether every trace has them.
fn signals() -> Vec<(&'static str, Cow<'static, str>)> {
    let line = |(name, about): (&'static str, SignalAbout), when: &str| {
        let values = [about.values(), when.to_owned()].into_iter().filter(|word| !word.is_empty());
        (name, Cow::Owned(with_values(about.about, &values.collect::<Vec<_>>().join("; "))))
    };
    let always = signal::always().map(|signal| line(signal, ""));
    always.chain(signal::on_request().map(|signal| line(signal, "only if a formula uses it"))).collect()
}

fn with_values(about: &str, values: &str) -> String {
    if values.is_empty() { about.to_owned() } else { format!("{about} ({values})") }
}

fn parameters(lists: &Lists, text: &mut String) -> Result<(), Failure> {
    text.push_str(
        "\n| scenario | parameter | domain | unit | value unless opened |\n| --- | --- | --- | --- | --- |\n",
    );
    for program in &lists.scenarios {
        let declaration = match program.declare() {
            Ok(declaration) => declaration,
            Err(error) => {
                writeln!(text, "| `{}` | error: {error} | | | |", program.name())?;
                continue;
            }
        };
        for declared in &declaration.parameters {
            let [name, domain, unit, nominal] = scenario_words(declared);
            writeln!(text, "| `{}` | `{name}` | {domain} | {unit} | {nominal} |", program.name())?;
        }
    }
    Ok(())
}

fn vehicles(text: &mut String) -> Result<(), Failure> {
    text.push_str("\n| vehicle | class | length, m | width, m | height, m | source of the dimensions |\n");
    text.push_str("| --- | --- | --- | --- | --- | --- |\n");
    for kind in VehicleKind::ALL {
        let (name, class, [length, width, height], source) = (kind.name, kind.class, kind.size, kind.source);
        writeln!(text, "| {name} | {class} | {length} | {width} | {height} | {source} |")?;
    }
    Ok(())
}

fn resistances(text: &mut String) -> Result<(), Failure> {
    text.push_str("\n| setting of the ego vehicle | range | meaning |\n| --- | --- | --- |\n");
    for VehicleSetting { name, unit, range: (low, high), about } in Resistance::SETTINGS {
        let range = format!("{low} to {high} {unit}");
        writeln!(text, "| `vehicle.{name}` | {} | {about} |", range.trim_end())?;
    }
    Ok(())
}

fn cameras(lists: &Lists, text: &mut String) -> Result<(), Failure> {
    text.push_str("\n| setting | key in a file | default | range |\n| --- | --- | --- | --- |\n");
    for setting in &lists.cameras {
        let (name, key, (low, high)) = (setting.name, setting.key, setting.range);
        let default =
            setting.default.map_or("has to be said".to_owned(), |default| format!("{default} {}", setting.unit));
        let range = format!("{low} to {high} {}", setting.unit);
        writeln!(text, "| `{name}` | `{key}` | {} | {} |", default.trim_end(), range.trim_end())?;
    }
    Ok(())
}

fn settings(lists: &Lists, text: &mut String) -> Result<(), Failure> {
    text.push_str("\n| driver | setting | default | range | meaning |\n| --- | --- | --- | --- | --- |\n");
    for driver in &lists.drivers {
        for setting in driver.settings {
            let (default, low, high) = (digits(setting.default), digits(setting.range.0), digits(setting.range.1));
            let (driver, name, unit, about) = (driver.name, setting.name, setting.unit, setting.about);
            let default = format!("{default} {unit}");
            writeln!(text, "| `{driver}` | `{name}` | {} | {low} to {high} | {about} |", default.trim_end())?;
        }
    }
    Ok(())
}
