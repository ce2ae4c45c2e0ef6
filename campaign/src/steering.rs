//! Chooses a campaign's tests: it runs one search, driven by the worst of all requirements. If the strategy seeks a
//! failure and there are several requirements, it runs one search for each requirement and lets a bandit choose between
//! the searches.
//!
//! The requirements are the requirements of the study or, if a system answers with robustness, the requirements in its
//! first answer. All choices therefore depend only on the study and on the trials in their order, and a resumed
//! campaign continues as it would have without the interruption.

use crate::scales::{Learned, Scales};
use crate::{Study, Trial};
use paracosm_generators::{Bandit, Generator, GeneratorError};
use paracosm_space::Point;

/// The source of a campaign's tests, which uses the results of earlier tests.
pub struct Steering<'a> {
    study: &'a Study,
    /// The existing tests, which the campaign counts as done.
    existing: Vec<Point>,
    search: Steered,
    scales: Scales,
    /// The tests that were reported before any requirement was known; none of these tests has a result.
    before: Vec<Point>,
}

enum Steered {
    One(Box<dyn Generator>),
    Several { ids: Vec<String>, bandit: Bandit },
}

impl<'a> Steering<'a> {
    /// Makes the source of the tests of a study, which uses the study's own generator. The tests complete the
    /// `existing` tests.
    ///
    /// # Errors
    /// The same errors as [`Study::generator`].
    pub fn new(study: &'a Study, existing: Vec<Point>) -> Result<Self, GeneratorError> {
        let generator = study.generator(&existing)?;
        Self::with(study, generator, existing)
    }

    /// Makes the source of the tests of a study from a given generator of the study's strategy. Searches for single
    /// requirements still use the study's own generator.
    ///
    /// # Errors
    /// The same errors as [`Study::generator`].
    pub fn with(study: &'a Study, generator: Box<dyn Generator>, existing: Vec<Point>) -> Result<Self, GeneratorError> {
        let (search, scales) = (Steered::One(generator), Scales::of(study, Learned::new()));
        let mut steering = Self { study, existing, search, scales, before: Vec::new() };
        let judged = study.requirements().iter().filter(|requirement| requirement.formula.is_some());
        steering.know(judged.map(|requirement| requirement.id.as_str()))?;
        Ok(steering)
    }

    /// Returns at most `n` new tests; no tests if the strategy is exhausted.
    ///
    /// # Errors
    /// The strategy of a program broke.
    pub fn ask(&mut self, n: usize) -> Result<Vec<Point>, GeneratorError> {
        let tests = match &mut self.search {
            Steered::One(search) => search.ask(n),
            Steered::Several { bandit, .. } => bandit.ask(n),
        };
        self.check()?;
        Ok(tests)
    }

    /// Checks that the strategy can go on.
    fn check(&self) -> Result<(), GeneratorError> {
        // Only the strategy of a program can break, and it is one search.
        let Steered::One(search) = &self.search else { return Ok(()) };
        let name = || self.study.sampling().strategy_name().to_owned();
        search.failure().map_or(Ok(()), |why| Err(GeneratorError::OwnFailed { name: name(), why }))
    }

    /// Reports the trials of tests that [`ask`](Self::ask) returned.
    ///
    /// # Errors
    /// The same errors as [`Study::generator`]; or the strategy of a program broke.
    pub fn tell(&mut self, tests: &[Point], trials: &[Trial]) -> Result<(), GeneratorError> {
        self.scales.learn(trials);
        if let (Steered::One(_), Some(first)) = (&self.search, trials.iter().find(|trial| trial.covers())) {
            self.know(first.requirements())?;
        }
        let scales = &self.scales;
        match &mut self.search {
            Steered::One(search) => {
                let worst: Vec<_> = trials.iter().map(|trial| scales.objective(trial)).collect();
                search.tell(tests, &worst);
                if worst.iter().all(Option::is_none) {
                    self.before.extend_from_slice(tests);
                }
            }
            Steered::Several { ids, bandit } => {
                let of = |trial: &Trial| ids.iter().map(|id| scales.clipped(trial, id)).collect();
                bandit.tell(tests, &trials.iter().map(of).collect::<Vec<_>>());
            }
        }
        self.check()
    }

    /// Returns the scales of the requirements, by which the searches compare values of robustness.
    pub fn scales(&self) -> &Scales {
        &self.scales
    }

    /// Begins a search for each of these requirements, if there are several and the strategy seeks a failure.
    fn know<'i>(&mut self, ids: impl Iterator<Item = &'i str>) -> Result<(), GeneratorError> {
        let ids: Vec<String> = ids.map(str::to_owned).collect();
        if ids.len() < 2 || !self.study.sampling().strategy.seeks_a_failure() {
            return Ok(());
        }
        let searches = ids.iter().map(|_| self.study.generator(&self.existing)).collect::<Result<_, _>>()?;
        let mut bandit = Bandit::new(searches);
        bandit.tell(&self.before, &vec![Vec::new(); self.before.len()]);
        self.search = Steered::Several { ids, bandit };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlackBox, Problem, ProblemKind};
    use paracosm_engine::Judgement;
    use paracosm_generators::Strategy;
    use paracosm_oracles::Verdict;
    use paracosm_space::Space;

    fn study(seed: u64) -> Study {
        let system = BlackBox::new("none", None).unwrap();
        let study = Study::of_system(system, Space::unit_cube(5)).strategy(Strategy::CMAES);
        study.budget(400).seed(seed).build().unwrap()
    }

    /// Returns the result of a test with two requirements. The second is violated within a small ball. The first is
    /// never violated, although its robustness is lower nearly everywhere.
    fn judgements(test: &Point, is_one: bool) -> (Verdict, Vec<Judgement>) {
        let away = test.continuous.iter().map(|u| (u - 0.7) * (u - 0.7)).sum::<f64>().sqrt();
        let both = [0.05 + 0.02 * test.continuous[0], away - 0.18];
        let judgements = match is_one {
            true => vec![Judgement::new("worst", Some(both[0].min(both[1])))],
            false => vec![Judgement::new("near", Some(both[0])), Judgement::new("ball", Some(both[1]))],
        };
        (if both[1] < 0.0 { Verdict::Fail } else { Verdict::Pass }, judgements)
    }

    /// Returns all tests up to the first failure, asked for in portions of 16. The first test has no result.
    fn tests(study: &Study, is_one: bool) -> Vec<Point> {
        let mut steering = Steering::new(study, Vec::new()).unwrap();
        let mut all: Vec<Point> = Vec::new();
        while all.len() < 400 {
            let tests = steering.ask(16).unwrap();
            let trial = |(i, test): (usize, &Point)| {
                let (index, values) = (all.len() + i, study.space().decode(test));
                if all.is_empty() {
                    return Trial::broken(index, values, Problem::new(ProblemKind::System, ""));
                }
                let (verdict, judgements) = judgements(test, is_one);
                Trial::judged(index, values, verdict, judgements)
            };
            let trials: Vec<Trial> = tests.iter().enumerate().map(trial).collect();
            steering.tell(&tests, &trials).unwrap();
            all.extend(tests);
            if trials.iter().any(Trial::is_failure) {
                break;
            }
        }
        all
    }

    #[test]
    fn a_requirement_that_another_one_hides_is_violated() {
        let sum = |is_one: bool| -> usize { (0..5).map(|seed| tests(&study(seed), is_one).len()).sum() };
        let (bandit, worst) = (sum(false), sum(true));
        assert!(2 * bandit < worst, "{bandit} tests with a bandit, {worst} by the worst");
    }

    #[test]
    fn no_test_is_proposed_twice_and_the_same_trials_give_the_same_tests() {
        let once = tests(&study(1), false);
        assert_eq!(once, tests(&study(1), false));
        assert!((1..once.len()).all(|i| !once[..i].contains(&once[i])));
    }
}
