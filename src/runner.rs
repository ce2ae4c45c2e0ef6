//! The whole job in one call: runs a study, and writes the log and all results into a folder.

use crate::analysis::{
    Coverage, Effects, Explanation, Impacts, Inconclusive, Limit, LocatedReport, Modes, Perceived, Plausible, Points,
    Promise, Summary, SuspectReport, explanation,
};
use crate::campaign::{
    Artefact, Campaign, Crew, Doubts, Error, Extension, Finish, Folder, JsonArtefact, Learned, Log, Observer, Reason,
    Shard, Study, Supervision, Trial,
};
use crate::coverage::Measure;
use crate::oracles::Verdict;
use crate::report::{FailureMap, Junit, TrialTable, plot::MapFiles};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use thiserror::Error;

/// Runs the tests of a study and writes the results into a folder. The folder gets the study, the log, the table of
/// trials, the coverage, the failure map, the failure modes and the explanation. `paracosm-fuzz run` writes the same
/// files, byte for byte. [`Runner`] has options.
///
/// # Errors
/// The study cannot be run, the folder cannot be written or already holds a campaign, or an observer fails. The folder
/// keeps the trials that were run before the error.
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

/// The options for running a study into a folder.
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
    supervision: Supervision,
    crew: Option<Arc<dyn Crew>>,
}

/// The results of a campaign that was run to its end.
#[derive(Debug, Clone)]
pub struct Report {
    /// The log of the campaign, which is the study with its trials.
    pub log: Log,
    /// The reason why the campaign ended.
    pub finish: Finish,
    /// The counts of verdicts, and the result of each requirement.
    pub summary: Summary,
    /// The coverage of the space by the tests.
    pub coverage: Coverage,
    /// The summary of the plausible tests, or `None` if the scenario calls all values of the open parameters plausible.
    pub plausible: Option<Plausible>,
    /// The impact speeds of the tests with a contact, or `None` if no test has one.
    pub impacts: Option<Impacts>,
    /// The points of Euro NCAP, or `None` if the scenario runs no tests of a grid of the protocol.
    pub points: Option<Points>,
    /// The failure map, or `None` if fewer than two continuous parameters are open, or if no test has a result.
    pub map: Option<FailureMap>,
    /// The combinations of discrete values that only failing tests have, or `None` if the search was not possible. The
    /// search needs an open discrete parameter, a failing test and a passing test.
    pub suspects: Option<SuspectReport>,
    /// The combinations of discrete values that make tests fail, as further tests have shown; `None` if no search was
    /// asked for, no test failed or no test passed.
    pub located: Option<LocatedReport>,
    /// The failure modes of the campaign.
    pub modes: Modes,
    /// The results of the perceiver on trial; `None` if no perceiver is on trial.
    pub perceived: Option<Perceived>,
    /// The explanation of the failures in words, or `None` if too few tests failed or passed.
    pub explanation: Option<Explanation>,
    /// The explanation of the inconclusive tests, or `None` if no test is inconclusive.
    pub inconclusive: Option<Inconclusive>,
    /// The effects of the open parameters; `None` until they are known.
    pub effects: Option<Effects>,
    /// The doubts about the programs of the campaign in words, which its log does not show.
    pub doubts: Vec<String>,
    /// The coverage guarantee of random rows of discrete values, or `None` if rows are not random, or if the campaign
    /// ended before all rows were run.
    pub promise: Option<Promise>,
    /// The JUnit report, or `None` if the user asked for no report.
    pub junit: Option<Junit>,
}

/// The error of a search for guilty combinations in a space without discrete parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "there are no combinations of discrete values to locate: no discrete parameter is open; open one with --open NAME=A,B,C"
)]
pub struct NothingToLocate;

impl Reason for NothingToLocate {}

impl Report {
    /// Calls `put` for each artefact that is written beside the log, in the order of writing. This is the one list of
    /// artefacts.
    ///
    /// # Errors
    /// Returns the first error of `put`, without handing over further artefacts.
    pub fn artefacts(&self, mut put: impl FnMut(&dyn Artefact) -> Result<(), Error>) -> Result<(), Error> {
        put(&TrialTable(&self.log))?;
        put(&self.coverage)?;
        self.map.iter().try_for_each(|map| put(&MapFiles::Failures(map)))?;
        put(&self.modes)?;
        self.points.iter().try_for_each(|points| put(points))?;
        self.perceived.iter().try_for_each(|perceived| put(perceived))?;
        self.explanation.iter().try_for_each(|explanation| put(explanation))?;
        self.effects.iter().try_for_each(|effects| put(effects))?;
        self.located.iter().try_for_each(|located| put(located))?;
        self.junit.iter().try_for_each(|junit| put(junit))
    }

    /// Derives the results of a campaign again from its folder. The effects are those of the folder's file,
    /// because they need further tests. A campaign that still runs has the results of its tests so far.
    ///
    /// # Errors
    /// The folder holds no campaign, or one of its files is broken.
    pub fn read(log: Log, folder: &Path) -> Result<Self, Error> {
        let mut summary = Summary::default();
        log.trials().iter().for_each(|trial| summary.add(trial));
        let sampling = log.study().sampling();
        let finish = match sampling.stop_at_first && summary.count(Verdict::Fail) > 0 {
            true => Finish::Stopped,
            false if log.trials().len() < sampling.budget => Finish::Exhausted,
            false => Finish::Budget,
        };
        let mut report = Self::of(log, finish, summary)?;
        report.effects = Effects::read(folder)?;
        report.doubts = Doubts::read(folder)?;
        report.explain()?;
        Ok(report)
    }

    /// Explains the failures again if parameters are known to have no effect: a rule about such a parameter would be chance.
    fn explain(&mut self) -> Result<bool, Error> {
        let without: Vec<&str> =
            self.effects.iter().flat_map(|effects| effects.without_effect().map(|(name, _)| name)).collect();
        if !without.is_empty() && self.explanation.is_some() {
            self.explanation = Explanation::without(&self.log, &without)?;
        }
        Ok(!without.is_empty())
    }

    /// Returns the names of the two continuous coordinates that explain the failures best; `None` if fewer are open, or if no test has a
    /// result.
    pub(crate) fn axes(&self) -> Result<Option<[String; 2]>, Error> {
        Self::axes_of(&self.log)
    }

    fn axes_of(log: &Log) -> Result<Option<[String; 2]>, Error> {
        let has_results = log.trials().iter().any(Trial::covers);
        if has_results { explanation::axes(log, [None, None]) } else { Ok(None) }
    }

    fn of(log: Log, finish: Finish, summary: Summary) -> Result<Self, Error> {
        let measures: Vec<_> = Measure::all().collect();
        // Each takes about half of the time.
        let (coverage, seen) = rayon::join(
            || Coverage::of(&log.test_set()?, &measures, None, Limit::USUAL),
            || {
                let map = Self::axes_of(&log)?.map(|[x, y]| FailureMap::over(&log, [&x, &y])).transpose()?;
                Ok::<_, Error>((map, Explanation::of(&log)?))
            },
        );
        let (coverage, (map, explanation)) = (coverage?, seen?);
        let has_levels = !log.study().space().levels().is_empty();
        Ok(Self {
            coverage,
            plausible: Plausible::of(&log),
            impacts: Impacts::of(&log),
            points: Points::of(&log),
            map,
            suspects: if has_levels { SuspectReport::of(&log)? } else { None },
            located: None,
            modes: Modes::of(&log),
            perceived: Perceived::of(&log),
            explanation,
            inconclusive: Inconclusive::of(&log)?,
            effects: None,
            doubts: Vec::new(),
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
    /// Makes a runner that runs a study on all cores, into a new folder.
    pub fn new(study: &'a Study) -> Self {
        Self {
            study,
            extension: None,
            jobs: None,
            resume: false,
            locate: None,
            junit: false,
            program: "paracosm-fuzz".to_owned(),
            supervision: Supervision::default(),
            crew: None,
        }
    }

    /// Makes the runner count the existing tests of an extension as done, and run only new tests that add to them.
    pub fn extending(mut self, extension: &'a Extension) -> Self {
        self.extension = Some(extension);
        self
    }

    /// Sets the number of tests that run at the same time. Results do not depend on this number.
    pub fn jobs(mut self, tests: NonZeroUsize) -> Self {
        self.jobs = Some(tests);
        self
    }

    /// Lets a crew run the tests, in other processes or on other machines. Results do not depend on the crew.
    pub fn with_crew(mut self, crew: Arc<dyn Crew>) -> Self {
        self.crew = Some(crew);
        self
    }

    /// Makes the runner continue the campaign in the folder, or begin a campaign if the folder has no campaign.
    pub fn resuming(mut self) -> Self {
        self.resume = true;
        self
    }

    /// Makes the runner search for the combinations of discrete values behind the failures, by at most `tests` further
    /// tests.
    pub fn locating(mut self, tests: usize) -> Self {
        self.locate = Some(tests);
        self
    }

    /// Makes the runner also write a JUnit report, which CI systems read.
    pub fn with_junit(mut self) -> Self {
        self.junit = true;
        self
    }

    /// Sets the name of the program in commands that repeat a test. The usual name is `paracosm-fuzz`.
    pub fn program(mut self, name: &str) -> Self {
        name.clone_into(&mut self.program);
        self
    }

    /// Makes the runner end with [`Error::Interrupted`] once the flag of `supervision` is set. The output of programs goes to the place of
    /// `supervision`, which keeps it in the folder of the campaign.
    pub fn until(mut self, supervision: impl Into<Supervision>) -> Self {
        self.supervision = supervision.into();
        self
    }

    /// Runs the study into a folder, like [`run_into`].
    ///
    /// # Errors
    /// The errors of [`run_into`]; or combinations should be located, and no discrete parameter is open.
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
        self.run_in(campaign, kept, known, observers)
    }

    /// Completes the campaign of a folder that is open, with the trials in its log, like [`run_into`].
    ///
    /// # Errors
    /// The errors of [`run_into`].
    pub fn complete(&self, folder: Folder, known: Vec<Trial>) -> Result<Report, Error> {
        self.run_in(self.campaign()?, folder, known, &mut [])
    }

    fn run_in(
        &self,
        campaign: Campaign<'_>,
        kept: Folder,
        known: Vec<Trial>,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Report, Error> {
        let folder = &kept.path().to_owned();
        self.supervision.output.keep_in(folder);
        let mut record = Record::new(self, kept);
        let mut all: Vec<&mut dyn Observer> = vec![&mut record];
        all.extend(observers.iter_mut().map(|observer| &mut **observer as &mut dyn Observer));
        let ran = campaign.resume(known).run(&mut all);
        // An interrupted campaign has doubts, too, and the next run knows nothing of them.
        let doubted = self.supervision.doubts.keep_in(folder);
        let finish = ran?;
        doubted?;
        let Record { folder: kept, trials, learned, summary, .. } = record;
        let log = Log::new(self.study.clone(), learned, self.extension.cloned(), trials).written_to(&kept);
        if !log.scales().learned().is_empty() {
            kept.write_study(self.study, log.scales().learned(), self.extension)?;
        }
        let mut report = Report::of(log, finish, summary)?;
        report.junit = self.junit.then(|| Junit::of_campaign(&report.log, folder, &self.program));
        report.artefacts(|artefact| kept.put(artefact))?;
        // Further tests may fail, so the results of the campaign are written before.
        report.effects = Some(self.effects(&report.log)?);
        report.effects.iter().try_for_each(|effects| kept.put(effects))?;
        if report.explain()? {
            report.explanation.iter().try_for_each(|explanation| kept.put(explanation))?;
        }
        // A map over a parameter without effect would mislead.
        if let (Some(map), Some(effects)) = (&report.map, &report.effects)
            && effects.without_effect().next().is_some()
        {
            let map = map.clone().noting(effects);
            kept.put(&MapFiles::Failures(&map))?;
            report.map = Some(map);
        }
        if let Some(limit) = self.locate {
            report.located = self.located(&report.log, limit)?;
            report.located.iter().try_for_each(|located| kept.put(located))?;
        }
        self.supervision.doubts.keep_in(folder)?;
        report.doubts = Doubts::read(folder)?;
        Ok(report)
    }

    /// Runs a shard of the study into a folder. [`campaign::merge`](crate::campaign::merge) puts the shards together. Returns the counts of verdicts of
    /// the shard.
    ///
    /// # Errors
    /// The tests of the study depend on outcomes; or the errors of [`run_into`].
    pub fn run_shard_into(
        &self,
        shard: Shard,
        folder: &Path,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Summary, Error> {
        Shard::check(self.study)?;
        let campaign = self.campaign()?;
        let (kept, known) = if self.resume {
            Folder::resume_shard(folder, self.study, self.extension, shard)?
        } else {
            (Folder::create_shard(folder, self.study, self.extension, shard)?, Vec::new())
        };
        self.supervision.output.keep_in(folder);
        let mut record = Record::new(self, kept);
        let mut all: Vec<&mut dyn Observer> = vec![&mut record];
        all.extend(observers.iter_mut().map(|observer| &mut **observer as &mut dyn Observer));
        let ran = campaign.resume(known).run_shard(shard, &mut all);
        let doubted = self.supervision.doubts.keep_in(folder);
        let tests = ran?;
        doubted?;
        record.folder.end_shard(shard, tests)?;
        Ok(record.summary)
    }

    fn campaign(&self) -> Result<Campaign<'a>, Error> {
        let mut campaign = Campaign::until(self.study, self.supervision.clone())?;
        if let Some(extension) = self.extension {
            campaign = campaign.extending(extension)?;
        }
        campaign.check()?;
        let campaign = self.jobs.into_iter().fold(campaign, Campaign::jobs);
        Ok(self.crew.iter().cloned().fold(campaign, Campaign::with_crew))
    }

    fn effects(&self, log: &Log) -> Result<Effects, Error> {
        // A system or a driver in a process of its own is only started again if a pair has to be run.
        let mut campaign = None;
        Effects::of(log, |test, index| {
            let campaign = match &mut campaign {
                Some(campaign) => campaign,
                none => none.insert(self.campaign()?),
            };
            campaign.run_test(test, index)
        })
    }

    fn located(&self, log: &Log, limit: usize) -> Result<Option<LocatedReport>, Error> {
        let campaign = self.campaign()?.resume(log.trials().to_vec());
        let mut next = log.trials().len();
        LocatedReport::of(log, limit, |test| {
            next += 1;
            Ok(campaign.run_test(test, next - 1)?.verdict)
        })
    }
}

/// The observer that keeps the trials of a campaign, in its folder and in memory.
struct Record<'r, 'a> {
    runner: &'r Runner<'a>,
    folder: Folder,
    trials: Vec<Trial>,
    learned: Learned,
    summary: Summary,
}

impl<'r, 'a> Record<'r, 'a> {
    fn new(runner: &'r Runner<'a>, folder: Folder) -> Self {
        let (learned, summary) = (Learned::new(), Summary::default());
        Self { runner, folder, trials: Vec::new(), learned, summary }
    }

    fn keep(&mut self, trial: &Trial) {
        self.summary.add(trial);
        trial.clone().append_to(&mut self.trials);
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
