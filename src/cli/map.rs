//! `paracosm-fuzz map`: draws the failure map of a campaign again, over other parameters.

use super::draw::{FileKind, Target};
use super::output::{Format, FormatOption, Table, json, percent};
use super::usage;
use super::{Failure, Status, Verbosity, print};
use clap::Args;
use paracosm_analysis::{Effects, explanation, failure_estimate};
use paracosm_campaign::files::write_whole_here;
use paracosm_campaign::{Artefact, Catalogue, Error, JsonArtefact, Log};
use paracosm_report::plot::MapFiles;
use paracosm_report::{FailureMap, Picture};
use serde_json::json;
use std::path::PathBuf;

/// The options of `map`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    #[command(flatten)]
    axes: Axes,
    /// Write to this file, .svg, .png or .csv [default: failure-map.svg, .png and .csv in DIR]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    form: FormatOption,
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
        let log = Log::read(&self.dir, catalogue)?;
        let nowhere = "a map needs two open continuous parameters, and this campaign has fewer";
        let [x, y] = self.axes.find(&log)?.ok_or_else(|| usage(nowhere.into()))?;
        let effects = Effects::read(&self.dir)?;
        let map = effects.iter().fold(FailureMap::over(&log, [&x, &y])?, FailureMap::noting);
        match &target {
            Some(target) => verbosity.note(target.write(|kind| contents(&map, kind))?),
            None => {
                let files = MapFiles::Failures(&map);
                for file in files.files() {
                    write_whole_here(&self.dir.join(file), &files.contents(file)?)?;
                }
                verbosity.note(format_args!("written to {}", self.dir.join("failure-map.svg").display()));
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
            Ok(estimate.ok_or("nothing is estimated: an estimate needs a failing test and a passing test")?.csv())
        }
        FileKind::Png => Picture::of(map.clone()).png(),
        FileKind::Svg | FileKind::Gif | FileKind::Xodr => Ok(Picture::of(map.clone()).svg()?.into_bytes()),
    }
}
