//! Chooses the tests that a page plays, and runs them again.

use super::Page;
use super::pack::{base64, gzip};
use super::roads::Ground;
use super::run::Recorder;
use paracosm_analysis::Summary;
use paracosm_campaign::{Error, Supervision, Trial, Worker};
use serde::Serialize;
use std::collections::{BTreeMap, HashMap};
use std::sync::atomic::Ordering;

/// The greatest number of failing tests and of other tests that are run again for a page.
const FAILING: usize = 300;
const OTHERS: usize = 60;

/// The bytes that an element of a run takes beside its record.
const ELEMENT: usize = 80;

/// The runs that a page can play.
#[derive(Debug, Default)]
pub struct Runs {
    /// The runs in the order of their importance: the index of the test, the number of its roads, and its record in the form of the page.
    all: Vec<(usize, usize, String)>,
    /// The roads of the runs, in the form of the page. Runs in the same place share their roads.
    roads: Vec<String>,
    /// The number of tests that did not end as in the log.
    differing: usize,
    /// The number of failing tests that were not run again, because there are too many.
    beyond: usize,
    /// The reason why there are no runs.
    why: Option<String>,
}

/// The description of the runs in the document.
#[derive(Debug, Clone, Default, Serialize)]
pub(super) struct Described {
    /// For each test with a run, the number of its roads.
    pub roads: BTreeMap<usize, usize>,
    /// The number of runs that are left out.
    left_out: usize,
    /// The reasons in words, or the reason why there are no runs.
    why: Option<String>,
}

/// The runs that fit, in the form of the page: the id of each element with its text.
pub(super) struct Kept {
    pub described: Described,
    pub texts: Vec<(String, String)>,
}

impl Runs {
    /// Returns the number of tests that did not end as in the log, so that the page does not show them.
    pub fn differing(&self) -> usize {
        self.differing
    }

    /// Returns no runs, with the reason in words.
    pub fn none(why: String) -> Self {
        Self { why: Some(why), ..Self::default() }
    }

    /// Runs tests of a campaign again: the worst test, the worst and the typical test of each failure mode, failing tests in their order, and a
    /// sample of the other tests. A test that does not end as in the log is left out. `done` hears of each test.
    ///
    /// # Errors
    /// The study cannot be run, or `supervision` stops the work.
    pub fn of(page: &Page, supervision: &Supervision, mut done: impl FnMut(usize, usize)) -> Result<Self, Error> {
        let log = page.log;
        if log.study().subject().scenario().is_err() {
            return Ok(Self::none("a system has no world to show".to_owned()));
        }
        let wanted = wanted(page);
        let mut worker = Worker::until(log.study(), supervision.clone())?;
        worker.start()?;
        let failing = log.trials().iter().filter(|trial| trial.is_failure()).count();
        let beyond = failing - wanted.iter().filter(|trial| trial.is_failure()).count();
        let mut runs = Self { beyond, ..Self::default() };
        let mut places = HashMap::<Vec<Ground>, usize>::new();
        for (number, trial) in wanted.iter().copied().enumerate() {
            done(number, wanted.len());
            let mut recorder = Recorder::default();
            let (again, trace) = worker.replay(log, trial, |run| recorder.see(run));
            if supervision.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            if !again.repeats(trial) {
                runs.differing += 1;
                continue;
            }
            let Some(mut record) = recorder.record(log.study(), trial.index, trial.verdict.to_string(), trace.as_ref())
            else {
                continue;
            };
            let roads = std::mem::take(&mut record.roads);
            let place = match places.get(&roads) {
                Some(place) => *place,
                None => {
                    runs.roads.push(packed(&roads));
                    places.insert(roads, runs.roads.len() - 1);
                    runs.roads.len() - 1
                }
            };
            runs.all.push((trial.index, place, packed(&record)));
        }
        Ok(runs)
    }

    /// Returns the most important runs that fit into `room` bytes.
    pub(super) fn within(&self, room: usize) -> Kept {
        let (mut used, mut roads) = (0, BTreeMap::new());
        let mut texts = Vec::new();
        let mut shown = vec![false; self.roads.len()];
        for (index, place, record) in &self.all {
            let new = if shown[*place] { 0 } else { self.roads[*place].len() + ELEMENT };
            let size = record.len() + ELEMENT + new;
            if used + size > room {
                continue;
            }
            used += size;
            if !std::mem::replace(&mut shown[*place], true) {
                texts.push((format!("roads-{place}"), self.roads[*place].clone()));
            }
            texts.push((format!("run-{index}"), record.clone()));
            roads.insert(*index, *place);
        }
        let reasons = [
            (self.all.len() - roads.len(), "do not fit into the size of the page"),
            (self.differing, "did not end as in the log"),
            (self.beyond, "were not run again, because many tests fail"),
        ];
        let left_out = reasons.iter().map(|(count, _)| count).sum();
        let words = reasons.iter().filter(|(count, _)| *count > 0).map(|(count, reason)| format!("{count} {reason}"));
        let words = words.collect::<Vec<_>>().join(", ");
        let why = self.why.clone().or_else(|| (!words.is_empty()).then_some(words));
        let described = Described { left_out, roads, why };
        Kept { described, texts }
    }
}

fn packed(of: &impl Serialize) -> String {
    base64(&gzip(&serde_json::to_vec(of).expect("a record is always JSON")))
}

/// Returns the tests that should be played, the most important first, each once.
fn wanted<'p>(page: &Page<'p>) -> Vec<&'p Trial> {
    let trials = page.log.trials();
    let first = named(page).into_iter().map(|index| &trials[index]);
    let failing = trials.iter().filter(|trial| trial.is_failure()).take(FAILING);
    let others: Vec<&Trial> = trials.iter().filter(|trial| !trial.is_failure() && trial.covers()).collect();
    let step = others.len().div_ceil(OTHERS).max(1);
    let sample = others.into_iter().step_by(step);
    let mut seen = vec![false; trials.len()];
    let mut wanted: Vec<&Trial> = first.chain(failing).chain(sample).collect();
    wanted.retain(|trial| !std::mem::replace(&mut seen[trial.index], true));
    wanted
}

/// Returns the tests that a page plays first: the worst tests, and the worst and the typical test of each failure mode.
fn named(page: &Page) -> Vec<usize> {
    let worst = |summary: &Summary| summary.worst(page.log.scales()).map(|worst| worst.index);
    let plausible = page.plausible.and_then(|plausible| worst(&plausible.summary));
    let mut named: Vec<usize> = worst(page.summary).into_iter().chain(plausible).collect();
    named.extend(page.modes.modes.iter().flat_map(|mode| [mode.worst, mode.representative]));
    named.retain(|index| page.log.trials().get(*index).is_some_and(Trial::covers));
    named
}
