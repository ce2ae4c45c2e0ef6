//! The screen of defects: which of them can matter in a scenario at all.
//!
//! Many defects change no verdict of a given driver: a driver that never looks at bicycles does not miss them. Mutants with such a
//! defect say nothing about a suite. So a defect is first put on trial always on, in random tests of the whole space. Only defects that
//! some of these tests notice make mutants. No suite takes part, so no suite is favoured.

use super::Suite;
use super::bout::Known;
use super::runs::{Runs, Seats, check, mutated};
use paracosm_campaign::{Error, Sampling, Study};
use paracosm_generators::Strategy;
use paracosm_mutants::{ALL, Defect, Mutant, mutants_where};
use serde::Serialize;

/// The number of random tests of a screen.
const TESTS: usize = 128;
/// The seed of these tests, which no strategy has by default.
const SEED: u64 = 0x5c7e_e201;

/// A set of mutants whose defects can matter in a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Screen {
    /// The number of random tests in which each defect was on.
    pub tests: usize,
    /// The number of defects, counted for each kind and size.
    pub defects: usize,
    /// The number of defects that some test notices.
    pub kept: usize,
    /// The mutants, which have only these defects.
    #[serde(skip)]
    pub mutants: Vec<Mutant>,
}

impl Screen {
    /// Makes a fixed set of `count` mutants for a study. The same study and count give the same set, and the set for a smaller count
    /// is its beginning.
    ///
    /// # Errors
    /// The study cannot be audited, or the work was stopped.
    pub fn of(study: &Study, count: usize, runs: &Runs) -> Result<Self, Error> {
        check(study)?;
        if count == 0 {
            return Ok(Self { tests: 0, defects: 0, kept: 0, mutants: Vec::new() });
        }
        let sampling = Sampling { strategy: Strategy::RANDOM, seed: Some(SEED), budget: TESTS, ..Sampling::default() };
        let points = study.sampled(sampling)?.generator(&[])?.ask(TESTS);
        let suite = Suite::new("the screen".to_owned(), points, study)?;
        let known = Known::of(&suite, study, runs)?;
        let seats = Seats::of(study)?;
        let defects: Vec<Defect> = ALL.iter().copied().flat_map(Defect::all_of).collect();
        let matters = |(): &mut (), index: usize| {
            let mutant = Mutant { defect: defects[index], when: Vec::new() };
            let noticed = mutated(study, mutant.defect).map(|study| {
                let mut worker = seats.worker(&study);
                known.kill(&mutant, &mut worker).is_some()
            });
            Some(noticed)
        };
        let noticed = runs.each(defects.len(), || (), matters)?.into_iter().collect::<Result<Vec<bool>, Error>>()?;
        let kept: Vec<&Defect> = defects.iter().zip(&noticed).filter(|(_, noticed)| **noticed).map(|(defect, _)| defect).collect();
        let mutants = mutants_where(study.space(), count, 0, |defect| kept.contains(&&defect));
        Ok(Self { tests: suite.points.len(), defects: defects.len(), kept: kept.len(), mutants })
    }
}
