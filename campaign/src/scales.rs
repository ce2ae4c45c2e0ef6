//! Scales of requirements, which tell a search the size of a large robustness.
//!
//! A requirement of a scenario states its scale. A formula on the command line, or a requirement that a system judges
//! itself by, states no scale: its robustness may be in thousands of revolutions or in fractions of a metre. Its scale
//! is the largest robustness among the first tests that decide it, and never changes. A search therefore sees
//! differences wherever the values of those tests differ, and far beyond.
//!
//! The scales that a campaign has learned are stored with its study. All later comparisons of robustness (the worst
//! test, the distance of a test from failure in a failure map) then use the same scales.

use crate::{Study, Trial};
use std::collections::BTreeMap;

/// The scales that a campaign has learned, by the ids of the requirements and in the units of the requirements.
pub type Learned = BTreeMap<String, f64>;

/// The scales of a study's requirements, by which values of robustness are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Scales {
    stated: BTreeMap<String, f64>,
    learned: Learned,
}

impl Scales {
    /// The greatest robustness that a search distinguishes, in multiples of its scale.
    pub const MOST: f64 = 10.0;

    /// Combines the scales that a study states with the scales that the study's campaign has learned.
    pub fn of(study: &Study, learned: Learned) -> Self {
        let stated = study.requirements().iter().filter_map(|stated| Some((stated.id.clone(), stated.scale?)));
        Self { stated: stated.collect(), learned }
    }

    /// Returns the scales that the campaign has learned.
    pub fn learned(&self) -> &Learned {
        &self.learned
    }

    /// Learns the unknown scales of requirements from the robustness in the given trials.
    pub fn learn(&mut self, trials: &[Trial]) {
        let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
        for trial in trials.iter().filter(|trial| trial.covers()) {
            for id in trial.requirements().filter(|id| self.known(id).is_none()) {
                let size = trial.robustness(id).map_or(0.0, f64::abs);
                let found = largest.entry(id).or_default();
                *found = found.max(if size.is_finite() { size } else { 0.0 });
            }
        }
        let learned = largest.into_iter().filter(|(_, size)| *size > 0.0);
        self.learned.extend(learned.map(|(id, size)| (id.to_owned(), size)));
    }

    fn known(&self, id: &str) -> Option<f64> {
        self.stated.get(id).or_else(|| self.learned.get(id)).copied()
    }

    /// Returns the given robustness divided by the scale of the requirement. The scale is 1 if it is not known because
    /// every robustness so far was 0 or infinite.
    pub fn normalised(&self, id: &str, robustness: f64) -> f64 {
        robustness / self.known(id).unwrap_or(1.0)
    }

    /// Returns the robustness of a requirement in a trial, divided by the requirement's scale and clipped to [-10, 10].
    /// `None` if the trial has no result or did not decide the requirement.
    pub fn clipped(&self, trial: &Trial, id: &str) -> Option<f64> {
        trial.robustness(id).filter(|_| trial.covers()).map(|robustness| self.clip(id, robustness))
    }

    fn clip(&self, id: &str, robustness: f64) -> f64 {
        self.normalised(id, robustness).clamp(-Self::MOST, Self::MOST)
    }

    /// Returns the smallest scaled robustness of all requirements in a trial, clipped to [-10, 10]. A single search
    /// minimises this number. `None` if the trial has no result or decided no requirement.
    pub fn objective(&self, trial: &Trial) -> Option<f64> {
        let clip = |(id, robustness): (&str, f64)| self.clip(id, robustness);
        trial.decided().filter(|_| trial.covers()).map(clip).min_by(f64::total_cmp)
    }

    /// Returns the requirement with the smallest scaled robustness in a trial, together with this robustness. The trial
    /// comes nearest to violating this requirement, or violates it most. `None` if the trial has no result or decided
    /// no requirement.
    pub fn worst<'t>(&self, trial: &'t Trial) -> Option<(&'t str, f64)> {
        let worth = |(id, robustness): (&'t str, f64)| (id, self.normalised(id, robustness));
        trial.decided().filter(|_| trial.covers()).map(worth).min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlackBox, Catalogue, Study};
    use paracosm_engine::Judgement;
    use paracosm_oracles::Verdict;
    use paracosm_space::{Space, Values};

    fn trial(robustness: &[(&str, f64)]) -> Trial {
        let judgement = |(id, worth): &(&str, f64)| Judgement::new(*id, Some(*worth));
        Trial::judged(0, Values::EMPTY, Verdict::Pass, robustness.iter().map(judgement).collect())
    }

    fn system() -> Study {
        Study::of_system(BlackBox::new("none", None).unwrap(), Space::unit_cube(1)).build().unwrap()
    }

    #[test]
    fn a_requirement_without_a_scale_gets_that_of_the_first_tests_that_decide_it() {
        let mut scales = Scales::of(&system(), Learned::new());
        scales.learn(&[trial(&[("rpm", f64::INFINITY), ("gap", 0.0)])]);
        scales.learn(&[trial(&[("rpm", 1000.0), ("gap", 0.25)]), trial(&[("rpm", -4000.0), ("gap", 0.5)])]);
        scales.learn(&[trial(&[("rpm", 90_000.0), ("gap", 7.0)])]);
        let told = |rpm: f64, gap: f64| scales.objective(&trial(&[("rpm", rpm), ("gap", gap)]));
        assert_eq!(told(4000.0, 0.25), Some(0.5));
        assert_eq!(told(1000.0, 0.5), Some(0.25));
        assert_eq!(told(-1e9, 0.5), Some(-10.0));
        assert_eq!(scales.clipped(&trial(&[("rpm", f64::INFINITY)]), "rpm"), Some(10.0));
    }

    #[test]
    fn the_scales_that_a_campaign_has_learned_stay_and_further_ones_are_learned() {
        let trials = [trial(&[("rpm", 4000.0), ("gap", 0.5)]), trial(&[("rpm", -2000.0), ("gap", -0.4)])];
        let mut scales = Scales::of(&system(), Learned::from([("gap".to_owned(), 0.8)]));
        scales.learn(&trials);
        assert_eq!(scales.learned(), &Learned::from([("gap".to_owned(), 0.8), ("rpm".to_owned(), 4000.0)]));
        assert_eq!(scales.worst(&trials[0]), Some(("gap", 0.625)));
        assert_eq!(scales.objective(&trials[1]), Some(-0.5));
        assert_eq!(scales.worst(&trial(&[("rpm", -80_000.0)])), Some(("rpm", -20.0)));
    }

    #[test]
    fn a_stated_scale_stays() {
        let program = Catalogue::of(paracosm_scenarios::ALL).find("pedestrian-crossing").unwrap();
        let study = Study::of(program).build().unwrap();
        let mut scales = Scales::of(&study, Learned::new());
        let stated = study.requirement("no-collision").unwrap().scale.unwrap();
        scales.learn(&[trial(&[("no-collision", 5000.0)])]);
        assert_eq!(scales.clipped(&trial(&[("no-collision", 3.0)]), "no-collision"), Some(3.0 / stated));
    }
}
