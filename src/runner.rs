//! The whole job in one call: a study is run, and all that is known of its tests is written into a folder.

use crate::analysis::{Coverage, Explanation, LocatedReport, Modes, Promise, Summary, SuspectReport};
use crate::campaign::{
    Artefact, Campaign, Error, Extension, Finish, Folder, Learned, Log, Observer, Reason, Study, Trial,
};
use crate::coverage::Measure;
use crate::oracles::Verdict;
use crate::report::{FailureMap, Junit, TrialTable, plot::MapFiles};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use thiserror::Error;

/// The time that `coverage.json` may take.
const COVERAGE_LIMIT: Duration = Duration::from_secs(5);

/// Runs the tests of a study, and writes into a folder all that is known of them: the study, the log, the trials as a table,
/// the coverage, the failure map, the failure modes and the explanation. `paracosm-fuzz run` writes the same files, byte for
/// byte. [`Runner`] has options.
///
/// # Errors
/// The study cannot be run, the folder cannot be written or holds a campaign already, or an observer fails. The trials that
/// were run until then are in the folder.
///
/// ```
/// use paracosm::{Study, catalogue, run_into};
///
/// let study = Study::of(catalogue().find("pedestrian-crossing")?).budget(20).build()?;
/// let folder = tempfile::tempdir().expect("a new folder");
/// let mut failures = 0;
/// let mut count = |trial: &paracosm::Trial| failures += usize::from(trial.is_failure());
/// let report = run_into(&study, &folder.path().join("out"), &mut [&mut count])?;
/// assert_eq!(report.modes.failures, failures);
/// # Ok::<(), paracosm::Error>(())
/// ```
pub fn run_into(study: &Study, folder: &Path, observers: &mut [&mut dyn Observer]) -> Result<Report, Error> {
    Runner::new(study).run_into(folder, observers)
}

/// How a study is run into a folder.
#[derive(Debug, Clone)]
#[must_use = "a study is run by `run_into`"]
pub struct Runner<'a> {
    study: &'a Study,
    extension: Option<&'a Extension>,
    jobs: Option<NonZeroUsize>,
    resume: bool,
    locate: Option<usize>,
    junit: bool,
    program: String,
    stop: Arc<AtomicBool>,
}

/// All that is known of a campaign that was run to its end.
#[derive(Debug, Clone)]
pub struct Report {
    /// The study with its trials.
    pub log: Log,
    /// How the campaign came to its end.
    pub finish: Finish,
    /// Counts of verdicts, and what became of each requirement.
    pub summary: Summary,
    /// How well the tests cover their space.
    pub coverage: Coverage,
    /// Where tests fail; `None` where less than two continuous parameters are open.
    pub map: Option<FailureMap>,
    /// The combinations of discrete values that only failing tests have; `None` where there is nothing to tell apart.
    pub suspects: Option<SuspectReport>,
    /// The combinations that further tests found guilty; `None` where nobody asked, or there is nothing to tell apart.
    pub located: Option<LocatedReport>,
    /// The ways in which tests fail.
    pub modes: Modes,
    /// Which tests fail, in words; `None` where too few failed or passed.
    pub explanation: Option<Explanation>,
    /// What random rows promise; `None` where rows are not random, or the campaign was ended before all of them were run.
    pub promise: Option<Promise>,
    /// The tests as CI systems read them, if anybody asked.
    pub junit: Option<Junit>,
}

/// A search for guilty combinations where there are none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("--locate is for discrete parameters, of which none is open; --open NAME=A,B,C opens one")]
pub struct NothingToLocate;

impl Reason for NothingToLocate {}

impl Report {
    /// Hands over everything that is written beside the log, in this order: the one list of artefacts.
    ///
    /// # Errors
    /// The first error of `put`, after which nothing more is handed over.
    pub fn artefacts(&self, mut put: impl FnMut(&dyn Artefact) -> Result<(), Error>) -> Result<(), Error> {
        put(&TrialTable(&self.log))?;
        put(&self.coverage)?;
        self.map.iter().try_for_each(|map| put(&MapFiles::Failures(map)))?;
        put(&self.modes)?;
        self.explanation.iter().try_for_each(|explanation| put(explanation))?;
        self.located.iter().try_for_each(|located| put(located))?;
        self.junit.iter().try_for_each(|junit| put(junit))
    }

    fn of(log: Log, finish: Finish, summary: Summary) -> Result<Self, Error> {
        let coverage = Coverage::of(&log.test_set()?, &Measure::all().collect::<Vec<_>>(), None, Some(COVERAGE_LIMIT))?;
        let names: Vec<String> = log.study().space().continuous().take(2).map(|axis| axis.name()).collect();
        let map = match &names[..] {
            [x, y] => Some(FailureMap::over(&log, [x, y])?),
            _ => None,
        };
        let has_levels = !log.study().space().levels().is_empty();
        Ok(Self {
            coverage,
            map,
            suspects: if has_levels { SuspectReport::of(&log)? } else { None },
            located: None,
            modes: Modes::of(&log),
            explanation: Explanation::of(&log)?,
            // Rows that were not run promise nothing.
            promise: if finish == Finish::Stopped { None } else { Promise::of_campaign(&log)? },
            junit: None,
            log,
            finish,
            summary,
        })
    }
}

impl<'a> Runner<'a> {
    /// A runner of a study on all cores, into a new folder.
    pub fn new(study: &'a Study) -> Self {
        Self {
            study,
            extension: None,
            jobs: None,
            resume: false,
            locate: None,
            junit: false,
            program: "paracosm-fuzz".to_owned(),
            stop: Arc::default(),
        }
    }

    /// Counts these tests as done, so that the tests of the study complete them.
    pub fn extending(mut self, extension: &'a Extension) -> Self {
        self.extension = Some(extension);
        self
    }

    /// Runs this many tests at a time. Results do not depend on it.
    pub fn jobs(mut self, tests: NonZeroUsize) -> Self {
        self.jobs = Some(tests);
        self
    }

    /// Continues the campaign in the folder, or begins it if there is none.
    pub fn resuming(mut self) -> Self {
        self.resume = true;
        self
    }

    /// Finds the combinations of discrete values behind the failures with at most this many further tests.
    pub fn locating(mut self, tests: usize) -> Self {
        self.locate = Some(tests);
        self
    }

    /// Writes the tests as CI systems read them, too.
    pub fn with_junit(mut self) -> Self {
        self.junit = true;
        self
    }

    /// Names this program in commands that repeat a test; without it, `paracosm-fuzz`.
    pub fn program(mut self, name: &str) -> Self {
        name.clone_into(&mut self.program);
        self
    }

    /// Ends with [`Error::Interrupted`] once `stop` is set.
    pub fn until(mut self, stop: Arc<AtomicBool>) -> Self {
        self.stop = stop;
        self
    }

    /// Runs the study into a folder, as [`run_into`].
    ///
    /// # Errors
    /// As [`run_into`]; or nothing is discrete where combinations are to be located.
    pub fn run_into(&self, folder: &Path, observers: &mut [&mut dyn Observer]) -> Result<Report, Error> {
        if self.locate.is_some() && self.study.space().levels().is_empty() {
            return Err(NothingToLocate.into());
        }
        let campaign = self.campaign()?;
        let (kept, known) = if self.resume {
            Folder::resume(folder, self.study, self.extension)?
        } else {
            (Folder::create(folder, self.study, self.extension)?, Vec::new())
        };
        let (learned, summary) = (Learned::new(), Summary::default());
        let mut record = Record { runner: self, folder: kept, trials: Vec::new(), learned, summary };
        let mut all: Vec<&mut dyn Observer> = vec![&mut record];
        all.extend(observers.iter_mut().map(|observer| &mut **observer as &mut dyn Observer));
        let finish = campaign.resume(known).run(&mut all)?;
        let Record { folder: kept, trials, learned, summary, .. } = record;
        let log = Log::new(self.study.clone(), learned, self.extension.cloned(), trials);
        if !log.scales().learned().is_empty() {
            kept.write_study(self.study, log.scales().learned(), self.extension)?;
        }
        let mut report = Report::of(log, finish, summary)?;
        report.junit = self.junit.then(|| Junit::of_campaign(&report.log, folder, &self.program));
        report.artefacts(|artefact| kept.put(artefact))?;
        if let Some(limit) = self.locate {
            report.located = self.located(&report.log, limit)?;
            report.located.iter().try_for_each(|located| kept.put(located))?;
        }
        Ok(report)
    }

    fn campaign(&self) -> Result<Campaign<'a>, Error> {
        let mut campaign = Campaign::until(self.study, Arc::clone(&self.stop))?;
        if let Some(extension) = self.extension {
            campaign = campaign.extending(extension)?;
        }
        campaign.check()?;
        Ok(match self.jobs {
            Some(jobs) => campaign.jobs(jobs),
            None => campaign,
        })
    }

    fn located(&self, log: &Log, limit: usize) -> Result<Option<LocatedReport>, Error> {
        let campaign = self.campaign()?.resume(log.trials().to_vec());
        let mut next = log.trials().len();
        LocatedReport::of(log, limit, |test| {
            let mut verdict = Verdict::Error;
            campaign.run_tests(std::slice::from_ref(test), next, |trial| {
                verdict = trial.verdict;
                Ok(())
            })?;
            next += 1;
            Ok(verdict)
        })
    }
}

/// Keeps the trials of a campaign, in its folder and in memory.
struct Record<'r, 'a> {
    runner: &'r Runner<'a>,
    folder: Folder,
    trials: Vec<Trial>,
    learned: Learned,
    summary: Summary,
}

impl Record<'_, '_> {
    fn keep(&mut self, trial: &Trial) {
        self.summary.add(trial);
        self.trials.push(trial.clone());
    }
}

impl Observer for Record<'_, '_> {
    fn trial(&mut self, trial: &Trial) -> Result<ControlFlow<()>, Error> {
        self.folder.append(trial)?;
        self.keep(trial);
        Ok(ControlFlow::Continue(()))
    }

    fn known(&mut self, trial: &Trial) -> Result<ControlFlow<()>, Error> {
        self.keep(trial);
        Ok(ControlFlow::Continue(()))
    }

    fn learned(&mut self, scales: &Learned) -> Result<(), Error> {
        self.learned.clone_from(scales);
        self.folder.write_study(self.runner.study, scales, self.runner.extension)
    }
}
