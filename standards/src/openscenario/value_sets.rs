//! Tests of a scenario as a distribution of its parameters, for simulators that run such a file.

use super::parameters::EGO;
use super::program::{ROOT, Xosc};
use crate::xml::{Attributes, ReadError, Writer};
use paracosm_space::Values;
use std::collections::BTreeSet;
use std::fmt::Display;
use std::path::{Component, Path, PathBuf};
use thiserror::Error;

/// The date in the headers of files. It is always the same, so that the same tests give the same file.
pub const DATE: &str = "2026-01-01T00:00:00";

/// The reason why tests cannot be written as a distribution of parameters.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ValueSetFlaw {
    /// The scenario cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A parameter of the tests is none that the scenario declares.
    #[error("the scenario declares no parameter `{name}`, so a distribution of its parameters cannot have it")]
    NotDeclared {
        /// The name of the parameter.
        name: String,
    },
    /// There are no tests.
    #[error("found no tests, expected at least one for a distribution of parameters")]
    NoTest,
    /// The path of the scenario from the folder of the distribution leads through the root of the file system.
    #[error(
        "the path of {} from the folder {} leads through the root of the file system, and such paths are not read",
        scenario.display(), folder.display()
    )]
    FarAway {
        /// The path of the scenario.
        scenario: PathBuf,
        /// The path of the folder.
        folder: PathBuf,
    },
}

/// Returns the text of a file, for a folder, that lists tests of a scenario: a `ParameterValueDistribution` with one set of values for
/// each test. `scenario` is the path of the scenario, or of a distribution of its parameters, whose scenario is then named. All
/// `tests` have values of the same parameters. Closed parameters have the values `fixed`, which are listed where they differ from the
/// declarations. A test that occurs twice is listed once. Read again, the file has one parameter with exactly these tests as its values.
///
/// # Errors
/// The scenario cannot be read, declares no such parameters, or is too far away from the folder; or there are no tests.
pub fn value_sets(scenario: &Path, folder: &Path, tests: &[Values], fixed: &Values) -> Result<String, ValueSetFlaw> {
    let read = Xosc::read(scenario)?;
    let path = path_from(folder, read.document.file())?;
    let sets = read.assignments(tests, fixed)?;
    let mut xml = Writer::new();
    xml.within(ROOT, &[], |xml| {
        let about = format!("tests of {}", path.rsplit('/').next().unwrap_or_default());
        let header: Attributes<'_> =
            &[("revMajor", &1), ("revMinor", &2), ("date", &DATE), ("description", &about), ("author", &"PARACOSM")];
        xml.empty("FileHeader", header);
        xml.within("ParameterValueDistribution", &[], |xml| {
            xml.empty("ScenarioFile", &[("filepath", &path)]);
            xml.within("Deterministic", &[], |xml| {
                xml.within("DeterministicMultiParameterDistribution", &[], |xml| {
                    xml.within("ValueSetDistribution", &[], |xml| sets.iter().for_each(|set| write(set, xml)));
                });
            });
        });
    });
    Ok(xml.finish())
}

fn write(set: &[(&str, String)], xml: &mut Writer) {
    xml.within("ParameterValueSet", &[], |xml| {
        for (name, value) in set {
            xml.empty("ParameterAssignment", &[("parameterRef", name), ("value", value as &dyn Display)]);
        }
    });
}

impl Xosc {
    /// Returns the values of declared parameters in each test, with their names, in the order of the declarations.
    fn assignments(&self, tests: &[Values], fixed: &Values) -> Result<Vec<Vec<(&str, String)>>, ValueSetFlaw> {
        if tests.is_empty() {
            return Err(ValueSetFlaw::NoTest);
        }
        let parameters = &self.parameters;
        let all = || parameters.declarations().iter().filter_map(|of| Some((of, parameters.source(of)?)));
        for (name, _) in tests.iter().flat_map(Values::iter) {
            if name == EGO || all().all(|(_, source)| source != name) {
                return Err(ValueSetFlaw::NotDeclared { name: name.to_owned() });
            }
        }
        let (mut sets, mut known): (Vec<Vec<(&str, String)>>, _) = (Vec::new(), BTreeSet::new());
        for test in tests {
            let assigned = all().filter_map(|(declaration, _)| {
                let kind = declaration.demand.kind;
                let differs = |text: &String| kind.value(text) != kind.value(&declaration.text);
                let value = parameters.given(declaration, test);
                let value = value.or_else(|| parameters.given(declaration, fixed).filter(differs))?;
                Some((declaration.demand.name.as_str(), value))
            });
            let set: Vec<_> = assigned.collect();
            if known.insert(set.clone()) {
                sets.push(set);
            }
        }
        Ok(sets)
    }
}

/// Returns the path of a file from a folder, with `/` between its parts.
fn path_from(folder: &Path, file: &Path) -> Result<String, ValueSetFlaw> {
    let real = |path: &Path| path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or(path.to_owned());
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (whole, base) = (real(file), real(here));
    let common = whole.components().zip(base.components()).take_while(|(one, two)| one == two).count();
    // The root itself is a common part.
    if common < 2 && !whole.starts_with(&base) {
        return Err(ValueSetFlaw::FarAway { scenario: file.to_owned(), folder: folder.to_owned() });
    }
    let up = base.components().skip(common).map(|_| Component::ParentDir);
    let parts = up.chain(whole.components().skip(common));
    Ok(parts.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect::<Vec<_>>().join("/"))
}
