//! The log of a campaign: its study, and the result of each test.

use crate::files::{Lines, read_text_here};
use crate::folder::EXTENDED;
use crate::scales::{Learned, Scales};
use crate::study_file::{STUDY, StudyFile, hash_of_text};
use crate::test_set::TestSet;
use crate::trials_file::{TRIALS, read_trials};
use crate::{Catalogue, Error, Extension, Folder, Reason, Shard, SpaceFile, Study, Trial, Trust, run_in, shard};
use paracosm_engine::driver::Driver;
use paracosm_space::Point;
use paracosm_space::pict::Aliases;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The log of a campaign, with the study and the trials of all tests that were run. All analyses take a log.
#[derive(Debug, Clone)]
pub struct Log {
    study: Study,
    scales: Scales,
    extension: Option<Extension>,
    trials: Vec<Trial>,
    /// The hash of the study in the folder of the campaign; `None` if the log is in no folder.
    hash: Option<String>,
    /// The folder in which the commands of the campaign ran, if the folder of the campaign says so.
    run_in: Option<PathBuf>,
}

/// The error that a space was given for the folder of a campaign, which has its own space.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{} is the folder of a campaign, which has its own space: leave --space out", path.display())]
pub struct HasSpace {
    /// The path of the campaign's folder.
    pub path: PathBuf,
}

impl Reason for HasSpace {}

impl Log {
    /// Makes a log from a study and the trials of the study's tests. Scales that the campaign has not learned yet are
    /// learned from the trials.
    pub fn new(study: Study, learned: Learned, extension: Option<Extension>, trials: Vec<Trial>) -> Self {
        let mut scales = Scales::of(&study, learned);
        scales.learn(&trials);
        Self { study, scales, extension, trials, hash: None, run_in: None }
    }

    /// Reads the log of a campaign from the campaign's folder.
    ///
    /// # Errors
    /// The folder holds no campaign, or one of its files is broken. If the catalogue does not have the scenario, the
    /// error comes only when a test is run.
    pub fn read(path: &Path, catalogue: &Catalogue) -> Result<Self, Error> {
        shard::is_whole(path)?;
        Self::read_range(path, catalogue, |study| 0..study.sampling().budget)
    }

    /// Reads the log of a shard from its folder.
    pub(crate) fn read_shard(path: &Path, catalogue: &Catalogue, shard: Shard) -> Result<Self, Error> {
        Self::read_range(path, catalogue, |study| shard.range(study.sampling().budget))
    }

    /// Reads the log of a campaign whose trials are known already.
    pub(crate) fn read_study(path: &Path, catalogue: &Catalogue, trials: Vec<Trial>) -> Result<Self, Error> {
        Self::read_with(path, catalogue, |_, _| Ok(trials))
    }

    fn read_range(path: &Path, catalogue: &Catalogue, indices: impl Fn(&Study) -> Range<usize>) -> Result<Self, Error> {
        let log = path.join(TRIALS);
        Self::read_with(path, catalogue, |study, hash| {
            Ok(read_trials(&log, Lines::open_here(&log)?, study, hash, indices(study))?.trials)
        })
    }

    fn read_with(
        path: &Path,
        catalogue: &Catalogue,
        trials: impl FnOnce(&Study, &str) -> Result<Vec<Trial>, Error>,
    ) -> Result<Self, Error> {
        let file = path.join(STUDY);
        let text = read_text_here(&file)?;
        let read = StudyFile::parse(&text, &catalogue.near(path));
        let hash = hash_of_text(&text);
        let StudyFile { study, learned, extends } = read.map_err(|flaw| Error::in_file(&file, flaw.line(), flaw))?;
        let trials = trials(&study, &hash)?;
        let extension = extends.map(|record| Extension::kept(record, path.join(EXTENDED)));
        Ok(Self { run_in: run_in::read(path), hash: Some(hash), ..Self::new(study, learned, extension, trials) })
    }

    /// Returns the log with the trust of the user in the command that its study names. Without trust, no test of a log
    /// that was read from a file can be run if it needs the command. With trust in all commands, they run in the folder in which they ran
    /// in the campaign. Otherwise they run in the folder of this process, because the folder of a stranger may name any other.
    pub fn trusting(self, trust: &Trust) -> Self {
        let there = self.run_in.iter().filter(|folder| trust.is_all() && folder.is_dir());
        let trust = there.fold(trust.clone(), |trust, folder| trust.running_in(folder));
        Self { study: self.study.trusting(&trust), ..self }
    }

    /// Returns a copy of the log with another command in the study, as [`Study::with_command`] describes.
    ///
    /// # Errors
    /// The study names no command for the option, or the new command is invalid.
    pub fn with_command(&self, option: &'static str, command: &str) -> Result<Self, Error> {
        Ok(Self { study: self.study.with_command(option, command)?, ..self.clone() })
    }

    /// Returns a copy of the log whose study has the driver that the given function makes, as [`Study::with_own_driver`] describes.
    ///
    /// # Errors
    /// The driver of the study has another name, or the study is that of an external system.
    pub fn with_own_driver(
        &self,
        name: &str,
        make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        Ok(Self { study: self.study.with_own_driver(name, make)?, ..self.clone() })
    }

    /// Returns the folder in which the commands of the campaign ran; `None` if the study runs no commands, or if the folder is not known.
    pub fn run_in(&self) -> Option<&Path> {
        self.run_in.as_deref().filter(|_| !self.study.commands().is_empty())
    }

    /// Returns the log with the hash of the study in the folder to which the log was written.
    #[must_use]
    pub fn written_to(self, folder: &Folder) -> Self {
        Self { hash: folder.hash().map(str::to_owned), ..self }
    }

    /// Returns the hash of the study, which each line of `trials.jsonl` has; `None` if the log is in no folder.
    pub fn hash(&self) -> Option<&str> {
        self.hash.as_deref()
    }

    /// Returns the study of the campaign.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Returns the scales of the requirements, by which values of robustness are compared.
    pub fn scales(&self) -> &Scales {
        &self.scales
    }

    /// Returns the tests of a file that the campaign extends or, with the strategy `given`, runs; `None` if there is no such file.
    pub fn extension(&self) -> Option<&Extension> {
        self.extension.as_ref()
    }

    /// Returns the trials of the campaign, in the order of their indices.
    pub fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// Returns the trials of the campaign.
    pub fn into_trials(self) -> Vec<Trial> {
        self.trials
    }

    /// Returns a copy of the log with the given trials in place of the present trials.
    pub fn with_trials(&self, trials: Vec<Trial>) -> Self {
        Self { trials, ..self.clone() }
    }

    /// Returns the tests that the campaign counts as done; `None` if there are none.
    pub fn done_before(&self) -> Option<&Extension> {
        self.extension.as_ref().filter(|_| !self.study.runs_given_tests())
    }

    /// Returns the tests that the campaign counts as done, as points of the space.
    ///
    /// # Errors
    /// The file of the tests cannot be read, or holds other tests.
    pub fn existing(&self) -> Result<Vec<Point>, Error> {
        self.done_before().map_or(Ok(Vec::new()), |extension| extension.points(self.study.space()))
    }

    /// Returns all tests of the campaign except tests with the verdict `error` or `invalid`. Tests that count as done
    /// come first.
    ///
    /// # Errors
    /// A test does not belong to the space, or the tests that count as done cannot be read.
    pub fn test_set(&self) -> Result<TestSet, Error> {
        let space = self.study.space();
        let mut points = self.existing()?;
        for trial in self.trials.iter().filter(|trial| trial.covers()) {
            points.push(space.encode(&trial.test)?);
        }
        Ok(TestSet { k: self.study.sampling().k, ..TestSet::new(space.clone(), points) })
    }
}

/// Reads tests from a file of tests or from the folder of a campaign.
///
/// # Errors
/// The file cannot be read, or does not hold tests of the space; or a space is given for a folder.
pub fn read_tests(path: &Path, space: Option<SpaceFile>) -> Result<TestSet, Error> {
    match (path.is_dir(), space) {
        (false, space) => read_tests_from(Lines::open(path)?, path, space),
        (true, Some(_)) => Err(HasSpace { path: path.to_owned() }.into()),
        (true, None) => Log::read(path, &Catalogue::default())?.test_set(),
    }
}

/// Reads tests from an input in the format of a file of tests; `path` is the name of the input in errors.
///
/// # Errors
/// The input cannot be read, or does not hold tests of the space.
pub fn read_tests_from(
    source: Lines<impl Read + 'static>,
    path: &Path,
    space: Option<SpaceFile>,
) -> Result<TestSet, Error> {
    let Some(SpaceFile { space, demand, aliases, .. }) = space else {
        return TestSet::read_from(source, path, None, &Aliases::default());
    };
    Ok(TestSet { demand, ..TestSet::read_from(source, path, Some(space), &aliases)? })
}
