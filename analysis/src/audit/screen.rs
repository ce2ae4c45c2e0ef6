//! The screen of defects: which mutants can be told from the driver at all.
//!
//! Many defects change no verdict of a given driver: a driver that never looks at bicycles does not miss them. Such mutants are
//! equivalent to the driver as far as known, and say nothing about a suite. So each defect is first on trial always on, in random tests
//! of the whole space. A mutant belongs to the set only if one of these tests notices it: its defect is noticed in the test, and the
//! test fulfils its conditions. No suite takes part, so no suite is favoured. The screen leaves out defects that fail only in places
//! that no random test met, so mutation scores are a little too high.

use super::bout::{Bout, Found, Kill, Known, Noticed};
use super::kept::Key;
use super::runs::{Runs, Seats, check, mutated};
use super::{Score, Suite};
use paracosm_campaign::{Error, Study};
use paracosm_generators::Strategy;
use paracosm_mutants::{ALL, Defect, Mutant, mutants_where};
use paracosm_space::Values;
use serde::Serialize;

/// The first seed of these tests, which no strategy has by default.
const SEED: u64 = 0x5c7e_e201;

/// A set of mutants, each of which some random test notices.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Screen {
    /// The number of random tests in which each defect was on.
    pub tests: usize,
    /// The number of defects, counted for each kind and size.
    pub defects: usize,
    /// The number of defects that some test notices.
    pub noticed: usize,
    /// The number of mutants with these defects that no test notices. They are equivalent as far as known, and are left out.
    pub equivalent_so_far: usize,
    /// The mutants, in the order of their defects.
    #[serde(skip)]
    pub mutants: Vec<Noticed>,
    /// The values of the tests.
    #[serde(skip)]
    pub values: Vec<Values>,
    /// The seed of the tests and the mutants.
    #[serde(skip)]
    pub seed: u64,
}

impl Screen {
    /// The usual number of random tests.
    pub const TESTS: usize = 128;

    /// Makes a fixed set of `count` mutants for a study, or fewer if there are not so many, from `tests` random tests. The same study
    /// and numbers give the same set, and the set for a smaller count is a part of it. `seed` draws the tests and the conditions of
    /// mutants: sets with different seeds are independent.
    ///
    /// # Errors
    /// The study cannot be audited, or the work was stopped.
    pub fn of(study: &Study, count: usize, tests: usize, seed: u64, runs: &Runs) -> Result<Self, Error> {
        check(study)?;
        let suite = Suite::of_strategy(study, Strategy::RANDOM, tests, Some(SEED.wrapping_add(seed)))?;
        let known = Known::of(&suite, study, runs)?;
        let seats = Seats::of(study)?;
        let defects: Vec<Defect> = ALL.iter().copied().flat_map(Defect::all_of).collect();
        let key = Key::new("screen", study);
        let noticing = |defect: Defect| -> Result<Vec<Kill>, Error> {
            let study = mutated(study, defect)?;
            Ok(known.noticing(&mut seats.worker(&study)).collect())
        };
        let notice = |(): &mut (), index: usize| match &runs.kept {
            Some(kept) => kept.or(&key, &(tests, seed, defects[index]), |_| true, || noticing(defects[index])),
            None => noticing(defects[index]),
        };
        let kills = runs.each(defects.len(), || (), notice)?.into_iter().collect::<Result<Vec<_>, Error>>()?;
        let place = |defect: Defect| defects.iter().position(|one| *one == defect).expect("it is one of the list");
        let of = |defect: Defect| &kills[place(defect)];
        let noticed_in = |mutant: &Mutant| {
            let kills = of(mutant.defect).iter().filter(|kill| mutant.is_active(known.test(kill.test)));
            let kills: Vec<&Kill> = kills.collect();
            let first = kills.first()?;
            let test = Found { test: known.test(first.test).clone(), requirement: first.requirement.clone() };
            Some(Noticed { mutant: mutant.clone(), test, tests: kills.iter().map(|kill| kill.test).collect() })
        };
        let mut screen = Self {
            tests: suite.points.len(),
            defects: defects.len(),
            noticed: kills.iter().filter(|kills| !kills.is_empty()).count(),
            equivalent_so_far: 0,
            mutants: Vec::new(),
            values: suite.values(study),
            seed,
        };
        // A longer set begins with the shorter one.
        let (mut asked, mut seen) = (count, 0);
        while screen.mutants.len() < count {
            let set = mutants_where(study.space(), asked, seed, |defect| !of(defect).is_empty());
            for mutant in set.iter().skip(seen) {
                if screen.mutants.len() == count {
                    break;
                }
                match noticed_in(mutant) {
                    Some(noticed) => screen.mutants.push(noticed),
                    None => screen.equivalent_so_far += 1,
                }
            }
            if set.len() < asked {
                break;
            }
            (asked, seen) = (2 * asked, set.len());
        }
        screen.mutants.sort_by_key(|noticed| place(noticed.mutant.defect));
        Ok(screen)
    }

    /// Returns the mutation score of each suite.
    ///
    /// # Errors
    /// The study cannot be audited, or the work was stopped.
    pub fn scores(&self, study: &Study, suites: &[Suite], runs: &Runs) -> Result<Vec<Score>, Error> {
        check(study)?;
        let mut tried = Vec::new();
        let bout = Bout { study, suites, mutants: &self.mutants, runs };
        bout.run(0, |one| {
            tried.push(one);
            Ok(())
        })?;
        Ok((0..suites.len()).map(|suite| Score::of(self.equivalent_so_far, &tried, suite)).collect())
    }
}
