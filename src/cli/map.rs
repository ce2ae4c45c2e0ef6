//! `paracosm-fuzz map`: a failure map again, over other parameters; and the map that every campaign ends with.

use super::draw::{Kind, Target};
use super::output::{Format, Table, json, percent};
use super::{Failure, Found, Verbosity, print};
use crate::failure_estimate;
use crate::folder::write_whole;
use crate::{Error, FailureMap, Folder, Picture, Study, Trial};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// The map's files in a campaign's folder, but for their endings.
const NAME: &str = "failure-map";

/// What `map` takes.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    #[command(flatten)]
    axes: Axes,
    /// Write to this file, .svg, .png or .csv [default: failure-map.svg, .png and .csv in DIR]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// How to print what the map says [default: table on a terminal, json elsewhere]
    #[arg(long)]
    format: Option<Format>,
}

/// What the axes of a map are to be.
#[derive(Debug, Args)]
pub(super) struct Axes {
    /// The parameter along the horizontal axis [default: the first continuous one that is open]
    #[arg(long, value_name = "NAME")]
    x: Option<String>,
    /// The parameter along the vertical axis [default: the next one]
    #[arg(long, value_name = "NAME")]
    y: Option<String>,
}

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<Found, Failure> {
        let kinds = [Kind::Svg, Kind::Png, Kind::Csv];
        let target = self.out.as_ref().map(|file| Target::new("--out", file, &kinds)).transpose()?;
        let (study, trials) = Folder::read(&self.dir)?;
        let nowhere = "a map needs two continuous parameters, and the campaign varies fewer";
        let [x, y] = self.axes.find(&study)?.ok_or_else(|| Error::Usage(nowhere.into()))?;
        let map = FailureMap::over(&study, &trials, [&x, &y])?;
        match &target {
            Some(target) => verbosity.note(target.write(|kind| contents(&map, kind))?),
            None => {
                write(&self.dir, &map)?;
                verbosity.note(format_args!("written to {}", self.dir.join(format!("{NAME}.svg")).display()));
            }
        }
        let estimate = map.estimate.as_ref();
        print(&match Format::or_fitting(self.format) {
            Format::Table => {
                let mut table = Table::default();
                table.heading(&format!("{}: {}", map.title, map.note));
                table.row("axes", &format!("{} and {}", map.x.label, map.y.label));
                match estimate {
                    None => table.row("estimated failing", "unknown: that takes a test that fails and one that passes"),
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
            Format::Json => json(&json!({"tests": trials.len(), "x": x, "y": y, "others": map.others,
                "failing": estimate.map(crate::FailureEstimate::mean),
                "invalid": estimate.map(crate::FailureEstimate::invalid),
                "decided": estimate.map(crate::FailureEstimate::decided)})),
        })?;
        Ok(Found::Nothing)
    }
}

impl Axes {
    /// The names that were given, the first continuous coordinates in place of those that were not; `None` where there are
    /// too few of these.
    ///
    /// # Errors
    /// A name is none of a continuous coordinate, or both are one.
    pub fn find(&self, study: &Study) -> Result<Option<[String; 2]>, Error> {
        let given = [&self.x, &self.y];
        let coordinates = study.space.continuous().map(|coordinate| coordinate.name());
        let mut free = coordinates.filter(|name| given.iter().all(|given| given.as_deref() != Some(name)));
        let [x, y] = given.map(|given| given.clone().or_else(|| free.next()));
        let (Some(x), Some(y)) = (x, y) else { return Ok(None) };
        failure_estimate::axes(study, [&x, &y])?;
        Ok(Some([x, y]))
    }
}

/// How much of a map is decided, in words.
fn decided(share: f64) -> String {
    if share == 0.0 {
        return "nothing of the map: that takes more tests".to_owned();
    }
    format!("{} of the map, by this estimate", percent(share))
}

/// The map of a campaign that has ended, over its first two continuous coordinates; `None` where it has less.
pub(super) fn of_campaign(study: &Study, trials: &[Trial]) -> Result<Option<FailureMap>, Error> {
    let names: Vec<String> = study.space.continuous().take(2).map(|coordinate| coordinate.name()).collect();
    let [x, y] = &names[..] else { return Ok(None) };
    FailureMap::over(study, trials, [x, y]).map(Some)
}

/// Writes the failure map into the folder of its campaign: the pictures, and the estimate's numbers if there is one.
pub(super) fn write(dir: &Path, map: &FailureMap) -> Result<(), Error> {
    write_as(dir, NAME, map)
}

/// Writes a map into the folder of its campaign under this name.
pub(super) fn write_as(dir: &Path, name: &str, map: &FailureMap) -> Result<(), Error> {
    let kinds = [("svg", Kind::Svg), ("png", Kind::Png), ("csv", Kind::Csv)];
    for (ending, kind) in kinds.into_iter().filter(|(_, kind)| *kind != Kind::Csv || map.estimate.is_some()) {
        let path = dir.join(format!("{name}.{ending}"));
        let drawn =
            contents(map, kind).map_err(|error| Error::Picture { path: path.clone(), message: error.to_string() })?;
        write_whole(&path, &drawn)?;
    }
    Ok(())
}

fn contents(map: &FailureMap, kind: Kind) -> Result<Vec<u8>, Failure> {
    match kind {
        Kind::Csv => {
            let estimate = map.estimate.as_ref();
            Ok(estimate.ok_or("nothing is estimated: that takes a test that fails and one that passes")?.csv())
        }
        Kind::Png => Picture::of(map.clone()).png(),
        Kind::Svg | Kind::Gif => Ok(Picture::of(map.clone()).svg()?.into_bytes()),
    }
}
