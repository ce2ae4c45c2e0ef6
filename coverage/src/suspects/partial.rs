//! A test that is chosen level by level and can always be completed.

use paracosm_space::rules::Rules;

/// A partial test, which has levels of some parameters and can be completed to a valid test.
#[derive(Debug, Clone)]
pub(super) struct Partial<'r> {
    rules: &'r Rules,
    levels: Vec<Option<usize>>,
}

impl<'r> Partial<'r> {
    /// Makes a partial test that has no level yet.
    pub fn new(rules: &'r Rules) -> Self {
        Self { rules, levels: vec![None; rules.levels().len()] }
    }

    /// Chooses a level of a parameter, if a valid test has this level together with the levels chosen before. Returns
    /// `true` if the level was chosen.
    pub fn choose(&mut self, parameter: usize, level: usize) -> bool {
        self.levels[parameter] = Some(level);
        let group = self.rules.group_of(parameter);
        let fits = group.is_none_or(|group| self.rules.holds(group, |other| self.levels[other]));
        if !fits {
            self.levels[parameter] = None;
        }
        fits
    }

    /// Chooses the first possible level in `levels` that differs from the level `than`. Returns `true` if a level was
    /// chosen.
    pub fn choose_other(&mut self, parameter: usize, than: usize, levels: &[usize]) -> bool {
        levels.iter().any(|&level| level != than && self.choose(parameter, level))
    }

    /// Completes the partial test to a valid test. A parameter without a level gets the preferred level or, if that is
    /// impossible, the first possible level.
    pub fn complete(mut self, preferred: &[usize]) -> Vec<usize> {
        for (parameter, &level) in preferred.iter().enumerate() {
            if self.levels[parameter].is_none() && !self.choose(parameter, level) {
                (0..self.rules.levels()[parameter]).any(|level| self.choose(parameter, level));
            }
        }
        self.levels.into_iter().map(|level| level.expect("what is chosen can be completed")).collect()
    }
}
