//! `paracosm-fuzz export`: writes a test as a scenario and its roads, for other simulators.

use super::output::plural;
use super::replay::logged;
use super::{Failure, Status, Verbosity, print, trust};
use crate::space::Values;
use crate::standards::opendrive;
use crate::standards::openscenario::{Concrete, DATE, EgoAs, Export, Xosc};
use clap::{Args, ValueEnum};
use paracosm_campaign::files::{create_folder, is_new, write_whole_here};
use paracosm_campaign::{Catalogue, Error, Log, Reason, Study, Trial, Worker};
use std::path::{Path, PathBuf};

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz export paracosm-out 17 --out case-17
  paracosm-fuzz export paracosm-out 17 --out case-17 --ego-as controller

The folder of --out gets a scenario with the name of the folder, such as case-17.xosc (ASAM OpenSCENARIO XML \
    1.2), and roads.xodr (ASAM OpenDRIVE). Every road user follows the trajectory that the test had. With --ego-as \
    controller, the ego vehicle begins at its place and with its speed, and the other simulator drives it from there \
    on. If the scenario is a file, the export is then its own storyboard with the values of the test.";

/// The name of the exported scenario, if its folder has no name.
const SCENARIO: &str = "scenario";
/// The ending of files of scenarios.
pub(super) const XOSC: &str = "xosc";
/// The name of the file of the roads.
const ROADS: &str = "roads.xodr";

/// The options of `export`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The folder of the campaign
    dir: PathBuf,
    /// The index of a test
    index: usize,
    /// The new folder for the scenario and its roads
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// The motion of the ego vehicle in the exported scenario
    #[arg(long, value_name = "WHO", default_value = "trajectory")]
    ego_as: Ego,
    #[command(flatten)]
    trust: trust::Options,
}

/// The motion of the ego vehicle in the exported scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Ego {
    /// The ego vehicle follows the trajectory that the test had
    Trajectory,
    /// The other simulator drives the ego vehicle from its first place on
    Controller,
}

/// The reason why a test cannot be exported.
#[derive(Debug, thiserror::Error)]
enum ExportFlaw {
    /// The roads cannot be written.
    #[error("the roads of the test cannot be written: {0}")]
    Roads(#[source] opendrive::LaneByLane),
}

impl Reason for ExportFlaw {}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<Status, Failure> {
        let (log, _) = self.trust.read(&self.dir, catalogue, verbosity)?;
        let (study, logged) = (log.study(), logged(&self.dir, &log, self.index)?);
        let stem = self.out.file_name().and_then(|name| name.to_str()).unwrap_or(SCENARIO);
        let files = [self.out.join(format!("{stem}.{XOSC}")), self.out.join(ROADS)];
        for file in &files {
            is_new(file, "an export")?;
        }
        let (texts, notes) = match file_of(study)? {
            Some(file) if self.ego_as == Ego::Controller => storyboard(&file, &study.complete(&logged.test))?,
            file => self.trajectories(&log, logged, file.as_deref())?,
        };
        create_folder(&self.out)?;
        for (file, text) in files.iter().zip(texts) {
            write_whole_here(file, text.as_bytes())?;
        }
        notes.iter().for_each(|note| verbosity.note(note));
        print(&files.map(|file| format!("{}\n", file.display())).concat())?;
        Ok(Status::Nothing)
    }

    /// Returns the texts of the scenario and of its roads if everything follows the trajectories of the test, with notes. `file` is
    /// the file of the scenario.
    fn trajectories(&self, log: &Log, logged: &Trial, file: Option<&Path>) -> Result<Written, Failure> {
        let study = log.study();
        let recording = Worker::new(study)?.record(logged)?;
        let about = format!("{}, test {}", study.title(), self.index);
        let roads =
            opendrive::write(&recording.network, &about).map_err(|flaw| Error::from(ExportFlaw::Roads(flaw)))?;
        // The file of the roads has its objects and signals, too.
        let map = opendrive::Map::parse(&self.out.join(ROADS), roads.clone())?;
        let ego = match self.ego_as {
            Ego::Trajectory => EgoAs::Trajectory,
            Ego::Controller => EgoAs::Controller,
        };
        let originals = match file {
            Some(file) => Xosc::read(file)?.originals(&study.complete(&logged.test))?,
            None => Vec::new(),
        };
        let motion = &recording.motion;
        let export = Export { about: &about, date: DATE, roads: ROADS, map: &map, motion, originals: &originals, ego };
        let mut notes: Vec<String> = unwritten(study, logged)?.into_iter().collect();
        let missing: Vec<&str> = export.never_there().collect();
        if !missing.is_empty() {
            let (count, names) = (plural(missing.len(), "road user is"), missing.join(", "));
            notes.push(format!("{count} never in the world during the test, and left out: {names}"));
        }
        if ego == EgoAs::Controller {
            notes.push(
                "all road users except the ego vehicle follow the trajectories of the test, because the scenario is a \
                 program and no storyboard"
                    .to_owned(),
            );
        }
        Ok(([export.text(), roads], notes))
    }
}

/// The parameters of the surroundings, which the scenario of an export does not have.
const SURROUNDINGS: [&str; 6] = ["friction", "fog", "light", "rain", "sun_elevation", "sun_azimuth"];

/// Says which values of the surroundings the export does not have; `None` if all are nominal.
fn unwritten(study: &Study, logged: &Trial) -> Result<Option<String>, Error> {
    let declared = study.program()?.declare().map_err(Error::from)?;
    let nominal = declared.nominal();
    let test = study.complete(&logged.test);
    let is_other = |name: &&str| test.get(name).is_some_and(|value| nominal.get(name) != Some(value));
    let values: Vec<String> = SURROUNDINGS
        .iter()
        .filter(|name| is_other(name))
        .map(|name| format!("{name} = {}", test.get(name).expect("it was found")))
        .collect();
    Ok((!values.is_empty()).then(|| {
        format!(
            "the export does not have {}: a driver that takes the car in another simulator meets a dry road in clear air by day, and may end otherwise",
            values.join(", ")
        )
    }))
}

/// The texts of the scenario and of its roads, and notes on them.
type Written = ([String; 2], Vec<String>);

/// Returns the file of the scenario of a study if the scenario is a file.
pub(super) fn file_of(study: &Study) -> Result<Option<PathBuf>, Error> {
    let file = PathBuf::from(study.program()?.name());
    Ok(file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(XOSC)).then_some(file))
}

/// Returns the texts of the scenario of a file and of its roads with the values of a test, with notes.
fn storyboard(file: &Path, test: &Values) -> Result<Written, Failure> {
    let Concrete { scenario, roads, ego, notes: remarks } = Xosc::read(file)?.concrete(test, ROADS)?;
    let says =
        format!("the controller of `{ego}` is left to the other simulator, and all others do what the storyboard says");
    let notes = [says].into_iter().chain(remarks).collect();
    Ok(([scenario, roads.to_string()], notes))
}
