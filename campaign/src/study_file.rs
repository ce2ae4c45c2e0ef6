//! The file `campaign.json`: a study, the scales that its campaign learned, and the tests that it extends.

use crate::json_text::{JsonFlaw, read_json};
use crate::study::{
    Appearances, DriverChoice, EntryFlaw, Maker, Odd, PerceiverChoice, Sampling, Simulation, StatedRequirement, Study,
    Subject, check_scale,
};
use crate::{BlackBox, Catalogue, Extension, ExtensionRecord, Learned, Reason};
use paracosm_engine::vehicle::{Resistance, VehicleModel, VehicleSetup};
use paracosm_generators::{Aim, DiscreteFamily, GeneratorError, OwnStrategy, Strategy};
use paracosm_space::{Space, Values};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::mem;
use thiserror::Error;
use xxhash_rust::xxh3::xxh3_64;

/// The name of the file in the folder of a campaign.
pub(crate) const STUDY: &str = "campaign.json";

/// The version of the files that this software writes.
const FORMAT: u32 = 1;

/// The contents of `campaign.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Entries", into = "Entries")]
pub struct StudyFile {
    /// The study that the file describes. After reading it has no program yet; [`Study::with_program_of`] finds the
    /// program.
    pub study: Study,
    /// The scales that the campaign has learned.
    pub learned: Learned,
    /// The number and the hash of the tests that the campaign extends; `None` if the campaign extends no tests.
    pub extends: Option<ExtensionRecord>,
}

/// The entries of the file, in their order. The subject is a scenario, or a system with its time-out.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the entries of a study")]
struct Entries {
    format: u32,
    version: String,
    target: String,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    scenario: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    scenario_files: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    vehicle: Option<VehicleModel>,
    #[serde(skip_serializing_if = "Resistance::is_none", default)]
    resistance: Resistance,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    fixed: Option<Values>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    driver: Option<DriverChoice>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    perceiver: Option<PerceiverChoice>,
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    references: Vec<DriverChoice>,
    #[serde(skip_serializing_if = "Appearances::is_empty", default)]
    models: Appearances,
    /// True if runs ended as soon as all requirements were decided, as older versions allowed.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    stop_runs_early: bool,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    dt: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    duration: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    system: Option<String>,
    /// True if the system was a function of the program that ran the campaign.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    system_is_function: bool,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    timeout: Option<f64>,
    space: Space,
    requirements: Vec<StatedRequirement>,
    #[serde(skip_serializing_if = "Learned::is_empty", default)]
    learned_scales: Learned,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    odd: Option<Odd>,
    strategy: String,
    /// The name of the strategy of the program that ran the campaign.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    own_strategy: Option<String>,
    discrete: String,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    delta: Option<f64>,
    k: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    epsilon: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    measure: Option<String>,
    skip: Option<u64>,
    seed: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    batch: Option<usize>,
    budget: usize,
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    stop_at_first: bool,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    extends: Option<ExtensionRecord>,
}

/// The reason why a file does not hold a study that this software understands.
#[derive(Debug, Error)]
pub enum FormatFlaw {
    /// The file has a different version of the format.
    #[error("found format {found}, expected {FORMAT}: version {version} of the software wrote the campaign")]
    Format {
        /// The number of the format in the file.
        found: u32,
        /// The version of the software that wrote the file.
        version: String,
    },
    /// The file names a strategy, a family or an aim that does not exist.
    #[error(transparent)]
    Sampling(#[from] GeneratorError),
    /// An entry cannot be right.
    #[error(transparent)]
    Entry(#[from] EntryFlaw),
    /// The file is not JSON, or the JSON does not describe a study.
    #[error(transparent)]
    Json(#[from] JsonFlaw),
}

impl Reason for FormatFlaw {}

impl FormatFlaw {
    /// Returns the line number, from 1, of an error in the JSON; `None` for other errors.
    pub fn line(&self) -> Option<usize> {
        match self {
            Self::Json(error) => Some(error.line()),
            Self::Format { .. } | Self::Sampling(_) | Self::Entry(_) => None,
        }
    }
}

impl StudyFile {
    /// Makes the contents of `campaign.json` from a study, the learned scales, and the tests that the campaign extends.
    pub fn new(study: &Study, learned: &Learned, extension: Option<&Extension>) -> Self {
        let extends = extension.map(|extension| extension.record().clone());
        Self { study: study.clone(), learned: learned.clone(), extends }
    }

    /// Reads the text of a `campaign.json`, and looks for the program of the scenario in a catalogue.
    ///
    /// # Errors
    /// The text is not a study, or is of another version.
    pub fn parse(text: &str, catalogue: &Catalogue) -> Result<Self, FormatFlaw> {
        let entries: Entries = read_json(text)?;
        Ok(Self::try_from(entries)?.with_program_of(catalogue)?)
    }

    /// Looks for the program of the scenario in a catalogue.
    ///
    /// # Errors
    /// This version of the software wrote the file, and the file does not agree with the program.
    pub fn with_program_of(self, catalogue: &Catalogue) -> Result<Self, EntryFlaw> {
        let study = self.study.with_program_of(catalogue);
        study.check_program()?;
        Ok(Self { study, ..self })
    }

    /// Returns the entries that determine the tests of the campaign and the verdicts on the tests. Two files with the
    /// same entries hold the same campaign. The result does not have the learned scales, which a campaign learns on its
    /// way; the name of the file that the campaign extends, since the same tests may stand in another file; and the
    /// texts that explain requirements, which another version of the software may word differently.
    pub fn identity(&self) -> Value {
        identity(serde_json::to_value(self).expect("a study is always JSON"))
    }

    /// Returns the study, the learned scales and the extended tests as the text of a `campaign.json`.
    pub fn text(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("a study is always JSON");
        text.push('\n');
        text
    }
}

/// Returns the hash of the study in the text of a `campaign.json`: the 64-bit XXH3 of its [identity](StudyFile::identity),
/// as 16 hexadecimal digits. The hash is that of the text, and not of what this version of the software makes of it:
/// another version finds the same hash.
pub(crate) fn hash_of_text(text: &str) -> String {
    let entries = serde_json::from_str(text).unwrap_or_default();
    format!("{:016x}", xxh3_64(identity(entries).to_string().as_bytes()))
}

/// Removes the entries that do not determine the tests and their verdicts.
fn identity(mut entries: Value) -> Value {
    if let Some(hash) = entries.pointer_mut("/extends/hash").map(Value::take) {
        entries["extends"] = hash;
    }
    if let Some(entries) = entries.as_object_mut() {
        entries.remove("learned_scales");
    }
    for requirement in entries.get_mut("requirements").and_then(Value::as_array_mut).into_iter().flatten() {
        requirement.as_object_mut().map(|entries| entries.remove("text"));
    }
    entries
}

/// Takes an entry that a study with the entry `of` has.
fn must<T>(entry: &'static str, of: &'static str, found: Option<T>) -> Result<T, EntryFlaw> {
    found.ok_or(EntryFlaw::Lacks { entry, of })
}

/// Checks that a study with the entry `of` does not have another entry.
fn must_not(entry: &'static str, of: &'static str, is_there: bool) -> Result<(), EntryFlaw> {
    if is_there { Err(EntryFlaw::Surplus { entry, of }) } else { Ok(()) }
}

impl Entries {
    /// Takes the entries of the subject out.
    fn take_subject(&mut self) -> Result<Subject, EntryFlaw> {
        let of = if self.system.is_some() { "system" } else { "scenario" };
        let Some(command) = self.system.take() else {
            must_not("timeout", of, self.timeout.is_some())?;
            must_not("system_is_function", of, self.system_is_function)?;
            return Ok(Subject::Scenario(Box::new(Simulation {
                scenario: self.scenario.take().ok_or(EntryFlaw::NoSubject)?,
                files: self.scenario_files.take(),
                vehicle: VehicleSetup { model: must("vehicle", of, self.vehicle)?, resistance: self.resistance },
                fixed: must("fixed", of, self.fixed.take())?,
                driver: must("driver", of, self.driver.take())?,
                perceiver: self.perceiver.take(),
                appearances: mem::take(&mut self.models),
                stop_runs_early: self.stop_runs_early,
                dt: must("dt", of, self.dt)?,
                duration: must("duration", of, self.duration)?,
                program: Default::default(),
            })));
        };
        must_not("scenario", of, self.scenario.is_some())?;
        must_not("scenario_files", of, self.scenario_files.is_some())?;
        must_not("vehicle", of, self.vehicle.is_some())?;
        must_not("resistance", of, !self.resistance.is_none())?;
        must_not("fixed", of, self.fixed.is_some())?;
        must_not("driver", of, self.driver.is_some())?;
        must_not("perceiver", of, self.perceiver.is_some())?;
        must_not("references", of, !self.references.is_empty())?;
        must_not("models", of, !self.models.is_empty())?;
        must_not("stop_runs_early", of, self.stop_runs_early)?;
        must_not("dt", of, self.dt.is_some())?;
        must_not("duration", of, self.duration.is_some())?;
        Ok(Subject::System(BlackBox::of_file(command, must("timeout", of, self.timeout)?, self.system_is_function)))
    }

    /// Sets the entries of the subject.
    fn put_subject(self, subject: &Subject) -> Self {
        match subject.clone() {
            Subject::Scenario(simulation) => Self {
                scenario: Some(simulation.scenario),
                scenario_files: simulation.files,
                vehicle: Some(simulation.vehicle.model),
                resistance: simulation.vehicle.resistance,
                fixed: Some(simulation.fixed),
                driver: Some(simulation.driver),
                perceiver: simulation.perceiver,
                models: simulation.appearances,
                stop_runs_early: simulation.stop_runs_early,
                dt: Some(simulation.dt),
                duration: Some(simulation.duration),
                ..self
            },
            Subject::System(system) => Self {
                system_is_function: system.is_function(),
                timeout: Some(system.timeout),
                system: Some(system.command),
                ..self
            },
        }
    }
}

impl TryFrom<Entries> for StudyFile {
    type Error = FormatFlaw;

    fn try_from(mut entries: Entries) -> Result<Self, FormatFlaw> {
        if entries.format != FORMAT {
            return Err(FormatFlaw::Format { found: entries.format, version: entries.version });
        }
        let subject = entries.take_subject()?;
        let Entries { version, target, space, requirements, odd, references, .. } = entries;
        // This sequence had the name `halton-shifted`, with or without a seed, until it was found to be the seeded
        // `halton`.
        let (strategy, seed) = match entries.strategy.as_str() {
            "halton-shifted" => (Strategy::HALTON, Some(entries.seed.unwrap_or(0))),
            name => (name.parse()?, entries.seed),
        };
        let discrete: DiscreteFamily = entries.discrete.parse()?;
        let sampling = Sampling {
            strategy,
            own: entries.own_strategy.as_deref().map(OwnStrategy::named),
            discrete: discrete.with_delta(entries.delta)?,
            k: entries.k,
            epsilon: entries.epsilon,
            aim: entries.measure.as_deref().map(str::parse::<Aim>).transpose()?,
            skip: entries.skip,
            seed,
            batch: entries.batch,
            budget: entries.budget,
            stop_at_first: entries.stop_at_first,
        };
        let made_by = Maker { version, target };
        let study = Study::of_file(made_by, subject, space, requirements, odd, sampling);
        study.check_entries()?;
        // The entries of a system have no reference drivers, so this is no error.
        let study = study.with_references(references).map_err(|_| EntryFlaw::NoSubject)?;
        for (id, scale) in &entries.learned_scales {
            check_scale(&format!("learned_scales.{id}"), *scale)?;
        }
        Ok(Self { study, learned: entries.learned_scales, extends: entries.extends })
    }
}

impl From<StudyFile> for Entries {
    fn from(file: StudyFile) -> Self {
        let StudyFile { study, learned, extends } = file;
        let (made_by, sampling) = (study.made_by().clone(), study.sampling());
        let delta = match sampling.discrete {
            DiscreteFamily::Random { delta } => Some(delta).filter(|delta| *delta != DiscreteFamily::DELTA),
            DiscreteFamily::Ipog | DiscreteFamily::Cross => None,
        };
        let driver = |study: &Study| Some(study.subject().scenario().ok()?.driver().clone());
        Self {
            format: FORMAT,
            version: made_by.version,
            target: made_by.target,
            scenario: None,
            scenario_files: None,
            vehicle: None,
            resistance: Resistance::default(),
            fixed: None,
            driver: None,
            perceiver: None,
            references: study.references().iter().filter_map(driver).collect(),
            models: Appearances::default(),
            stop_runs_early: false,
            dt: None,
            duration: None,
            system: None,
            system_is_function: false,
            timeout: None,
            space: study.space().clone(),
            requirements: study.requirements().to_vec(),
            learned_scales: learned,
            odd: study.odd().cloned(),
            strategy: sampling.strategy.name().to_owned(),
            own_strategy: sampling.own.as_ref().map(|own| own.name().to_owned()),
            discrete: sampling.discrete.name().to_owned(),
            delta,
            k: sampling.k,
            epsilon: sampling.epsilon,
            measure: sampling.aim.as_ref().map(|aim| aim.name().to_owned()),
            skip: sampling.skip,
            seed: sampling.seed,
            batch: sampling.batch_size(),
            budget: sampling.budget,
            stop_at_first: sampling.stop_at_first,
            extends,
        }
        .put_subject(study.subject())
    }
}
