//! `paracosm-fuzz map`: draws the failure map of a campaign again, over other parameters, or the map of its impact speeds.

use super::draw::{FileKind, Target};
use super::output::{Format, FormatOption, Table, impacts_in_words, json, percent};
use super::trust::read_results;
use super::usage;
use super::{Failure, Status, Verbosity, print};
use clap::{Args, ValueEnum};
use paracosm_analysis::{Effects, Impacts, explanation, failure_estimate};
use paracosm_campaign::files::write_whole_here;
use paracosm_campaign::{Artefact, Catalogue, Error, JsonArtefact, Log};
use paracosm_report::plot::MapFiles;
use paracosm_report::{FailureMap, Picture};
use serde_json::json;
use std::fmt;
use std::path::PathBuf;

/// The options of `map`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    #[command(flatten)]
    axes: Axes,
    /// The property of each test that the map shows
    ///
    /// `failures` shows verdicts and the estimated probability of failure, and `severity` shows the speed of the ego vehicle at its first
    /// contact.
    #[arg(long, value_name = "WHAT", default_value_t = Show::Failures)]
    show: Show,
    /// Write to this file, .svg, .png or .csv [default: failure-map.svg, .png and .csv in DIR]
    ///
    /// With --show severity, the default is severity-map.svg and .png.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    form: FormatOption,
}

/// The property of each test that a map shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Show {
    Failures,
    Severity,
}

impl fmt::Display for Show {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Failures => "failures",
            Self::Severity => "severity",
        })
    }
}

/// The options for the axes of a map.
#[derive(Debug, Args)]
pub(super) struct Axes {
    /// The parameter of the horizontal axis
    ///
    /// [default: of the two continuous parameters that separate failing tests from passing tests best, the first]
    #[arg(long, value_name = "NAME")]
    x: Option<String>,
    /// The parameter of the vertical axis
    ///
    /// [default: the second of these parameters]
    #[arg(long, value_name = "NAME")]
    y: Option<String>,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let kinds = [FileKind::Svg, FileKind::Png, FileKind::Csv];
        let target = self.out.as_ref().map(|file| Target::new("--out", file, &kinds, &[])).transpose()?;
        let log = read_results(&self.dir, catalogue, verbosity)?;
        let nowhere = "a map needs two open continuous parameters, and this campaign has fewer";
        let [x, y] = self.axes.find(&log)?.ok_or_else(|| usage(nowhere.into()))?;
        let effects = Effects::read(&self.dir)?;
        let impacts = Impacts::of(&log);
        let map = match (self.show, impacts) {
            (Show::Failures, _) => FailureMap::over(&log, [&x, &y])?,
            (Show::Severity, Some(_)) => FailureMap::of_severity(&log, [&x, &y])?,
            (Show::Severity, None) => {
                let message = "no test of this campaign has a contact, so that there is no impact speed to show";
                return Err(usage(message.into()).into());
            }
        };
        let map = effects.iter().fold(map, FailureMap::noting);
        match &target {
            Some(target) => verbosity.note(target.write(|kind| contents(&map, kind))?),
            None => {
                let files = match self.show {
                    Show::Failures => MapFiles::Failures(&map),
                    Show::Severity => MapFiles::Severity(&map),
                };
                for file in files.files() {
                    write_whole_here(&self.dir.join(file), &files.contents(file)?)?;
                }
                let written = files.files().into_iter().map(|file| self.dir.join(file).display().to_string());
                verbosity.note(format_args!("written to {}", written.collect::<Vec<_>>().join(", ")));
            }
        }
        let without = effects.iter().flat_map(Effects::without_effect);
        for (name, why) in without.filter(|(name, _)| [&x, &y].iter().any(|axis| axis == name)) {
            verbosity.note(format_args!("{name} has no effect: {why}"));
        }
        let estimate = map.estimate.as_ref();
        print(&match self.form.format {
            Format::Table => {
                let mut table = Table::default();
                table.heading(&format!("{}: {}", map.title, map.note));
                table.row("axes", &format!("{} and {}", map.x.label, map.y.label));
                match estimate {
                    None if self.show == Show::Severity => {
                        impacts.iter().for_each(|impacts| table.row("impact speed", &impacts_in_words(impacts)));
                    }
                    None => {
                        table.row("estimated failing", "unknown: an estimate needs a failing test and a passing test");
                    }
                    Some(estimate) => {
                        table.row("estimated failing", &percent(estimate.mean()));
                        if estimate.invalid() > 0.0 {
                            table.row(
                                "estimated invalid",
                                &format!(
                                    "{} of the map, where most tests cannot be built",
                                    percent(estimate.invalid())
                                ),
                            );
                        }
                        table.row("decided", &decided(estimate.decided()));
                    }
                }
                table.finish()
            }
            Format::Json if self.show == Show::Severity => json(&json!({"tests": log.trials().len(), "x": x, "y": y,
                "others": map.others, "impact_speed": impacts})),
            Format::Json => json(&json!({"tests": log.trials().len(), "x": x, "y": y, "others": map.others,
                "failing": estimate.map(paracosm_analysis::FailureEstimate::mean),
                "invalid": estimate.map(paracosm_analysis::FailureEstimate::invalid),
                "decided": estimate.map(paracosm_analysis::FailureEstimate::decided)})),
        })?;
        Ok(Status::Nothing)
    }
}

impl Axes {
    /// Returns the names of the parameters on both axes of the map. The coordinates that separate failing tests from passing tests
    /// best take the place of names that were not given. Returns `None` if the study has too few continuous coordinates.
    ///
    /// # Errors
    /// A name does not belong to a continuous coordinate, or both names are the same.
    pub fn find(&self, log: &Log) -> Result<Option<[String; 2]>, Error> {
        let found = explanation::axes(log, [self.x.as_deref(), self.y.as_deref()])?;
        let Some([x, y]) = found else { return Ok(None) };
        failure_estimate::axes(log.study(), [&x, &y])?;
        Ok(Some([x, y]))
    }
}

/// Says in words how much of a map is decided.
fn decided(share: f64) -> String {
    if share == 0.0 {
        return "nothing of the map: more tests are needed".to_owned();
    }
    format!("{} of the map, by this estimate", percent(share))
}

fn contents(map: &FailureMap, kind: FileKind) -> Result<Vec<u8>, Failure> {
    match kind {
        FileKind::Csv => {
            let estimate = map.estimate.as_ref();
            let nothing = if map.tints.is_some() {
                "a severity map has no table; trials.csv has the impact speed of each test as `impact_speed`"
            } else {
                "nothing is estimated: an estimate needs a failing test and a passing test"
            };
            Ok(estimate.ok_or(nothing)?.csv())
        }
        FileKind::Png => Picture::of(map.clone()).png(),
        FileKind::Svg | FileKind::Gif | FileKind::Xodr => Ok(Picture::of(map.clone()).svg()?.into_bytes()),
    }
}
