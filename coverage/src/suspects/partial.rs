//! A test that is chosen level by level, and can always be completed.

use paracosm_space::rules::Rules;

/// Levels of some parameters that some valid test has.
#[derive(Debug, Clone)]
pub(super) struct Partial<'r> {
    rules: &'r Rules,
    levels: Vec<Option<usize>>,
}

impl<'r> Partial<'r> {
    /// Nothing chosen yet.
    pub fn new(rules: &'r Rules) -> Self {
        Self { rules, levels: vec![None; rules.levels().len()] }
    }

    /// Chooses a level of a parameter, if some valid test has it with those chosen before.
    pub fn choose(&mut self, parameter: usize, level: usize) -> bool {
        self.levels[parameter] = Some(level);
        let group = self.rules.group_of(parameter);
        let fits = group.is_none_or(|group| self.rules.holds(group, |other| self.levels[other]));
        if !fits {
            self.levels[parameter] = None;
        }
        fits
    }

    /// Chooses a level other than this one, the first of these that may be.
    pub fn choose_other(&mut self, parameter: usize, than: usize, levels: &[usize]) -> bool {
        levels.iter().any(|&level| level != than && self.choose(parameter, level))
    }

    /// The test, every parameter without a level at the preferred one or, if that may not be, at the first that may.
    pub fn complete(mut self, preferred: &[usize]) -> Vec<usize> {
        for (parameter, &level) in preferred.iter().enumerate() {
            if self.levels[parameter].is_none() && !self.choose(parameter, level) {
                (0..self.rules.levels()[parameter]).any(|level| self.choose(parameter, level));
            }
        }
        self.levels.into_iter().map(|level| level.expect("what is chosen can be completed")).collect()
    }
}
