//! Searches by trial for the simplest test near a failing test that still fails.
//!
//! The search assumes nothing about the cause of the failure; it confirms every step by a run. First it sets whole
//! parameters to nominal, many at a time ([`needed`]). Then it makes each of the other parameters simple: signals
//! become constant or get fewer knots, numbers move as near to nominal as bisection finds them failing and are then
//! made round, and choices move to an earlier level. The search repeats this until nothing changes. It always ends,
//! because it takes a step only if the step is [simpler](Dimension::compare).
//!
//! If values fail only together (two values that have to be equal, say), no step with one of them succeeds. So when
//! no single step succeeds, the search tries steps with two parameters at once, each to one of a few simpler forms;
//! after a successful one it continues with single steps. It does not find steps that need three parameters at once.

use super::delta::needed;
use super::form::{Dimension, Form};
use super::number::Decimals;
use paracosm_space::{Domain, Space, Value, Values};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// A running search for the simplest test that still fails.
pub(super) struct Shrinker<'a, F> {
    space: &'a Space,
    dimensions: Vec<Dimension<'a>>,
    fails: F,
    current: Vec<Form>,
    /// The tests that were run, as JSON, each with `true` if the test failed.
    tried: BTreeMap<String, bool>,
    budget: usize,
    exhausted: bool,
}

/// The result of a search for the simplest test that still fails.
#[derive(Debug)]
pub(super) struct Simpler {
    pub test: Values,
    /// The number of tests that the search ran.
    pub runs: usize,
    /// `true` if no simpler test was left untried for lack of runs.
    pub complete: bool,
}

impl<'a, F, E> Shrinker<'a, F>
where
    F: FnMut(&Values) -> Result<bool, E>,
{
    /// Makes a search from a failing test of the space towards the nominal values of its parameters, in at most
    /// `budget` runs.
    pub fn new(space: &'a Space, nominal: &Values, test: &Values, budget: usize, fails: F) -> Self {
        let value = |values: &Values, name: &str| values.get(name).cloned().expect("a value for every parameter");
        let parameters = space.parameters().iter();
        let dimensions: Vec<Dimension> =
            parameters.map(|parameter| Dimension { parameter, nominal: value(nominal, &parameter.name) }).collect();
        let form = |dimension: &Dimension| dimension.form(&value(test, &dimension.parameter.name));
        let current = dimensions.iter().map(form).collect();
        Self { space, dimensions, fails, current, tried: BTreeMap::new(), budget, exhausted: false }
    }

    /// Runs the search for the simplest test that still fails, until the search finds no simpler test.
    pub fn run(mut self) -> Result<Simpler, E> {
        loop {
            let before = self.current.clone();
            self.reset_parameters()?;
            for index in 0..self.dimensions.len() {
                self.simplify(index)?;
            }
            if self.current == before && !self.simplify_two()? {
                return Ok(Simpler {
                    test: self.test(&self.current),
                    runs: self.tried.len(),
                    complete: !self.exhausted,
                });
            }
        }
    }

    fn test(&self, forms: &[Form]) -> Values {
        let value = |(dimension, form): (&Dimension, &Form)| (dimension.parameter.name.clone(), dimension.value(form));
        self.dimensions.iter().zip(forms).map(value).collect()
    }

    /// Moves to these forms if their test fails.
    fn go(&mut self, forms: Vec<Form>) -> Result<bool, E> {
        let test = self.test(&forms);
        if !self.space.encode(&test).is_ok_and(|point| self.space.allows(&point)) {
            return Ok(false);
        }
        let written = serde_json::to_string(&test).expect("a test is always JSON");
        let fails = match self.tried.get(&written) {
            Some(fails) => *fails,
            None if self.tried.len() >= self.budget => {
                self.exhausted = true;
                return Ok(false);
            }
            None => (self.fails)(&test)?,
        };
        self.tried.insert(written, fails);
        if fails {
            self.current = forms;
        }
        Ok(fails)
    }

    /// Moves one parameter to this form if the form is simpler than the current form and the test fails.
    fn go_with(&mut self, index: usize, form: Form) -> Result<bool, E> {
        if self.dimensions[index].compare(&form, &self.current[index]) != Ordering::Less {
            return Ok(false);
        }
        let mut forms = self.current.clone();
        forms[index] = form;
        self.go(forms)
    }

    /// Sets as many parameters as possible to nominal.
    fn reset_parameters(&mut self) -> Result<(), E> {
        let from = self.current.clone();
        let own = (0..from.len()).filter(|index| from[*index] != Form::Nominal).collect();
        needed(own, |kept| {
            let form = |(index, form): (usize, &Form)| if kept.contains(&index) { form.clone() } else { Form::Nominal };
            self.go(from.iter().enumerate().map(form).collect())
        })?;
        Ok(())
    }

    /// Makes one parameter as simple as possible.
    fn simplify(&mut self, index: usize) -> Result<(), E> {
        self.take_fewer_knots(index)?;
        self.reset_knots(index)?;
        let Form::Own(knots) = &self.current[index] else { return Ok(()) };
        for knot in 0..knots.len() {
            match &self.dimensions[index].parameter.domain {
                Domain::Interval { lo, hi } => self.simplify_number(index, knot, Decimals::of(*lo, *hi))?,
                Domain::Choice(levels) => {
                    for level in levels {
                        if self.go_with_knot(index, knot, level.clone())? {
                            break;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Makes a signal constant, or gives it fewer knots.
    fn take_fewer_knots(&mut self, index: usize) -> Result<(), E> {
        let Form::Own(knots) = self.current[index].clone() else { return Ok(()) };
        if knots.len() == 1 {
            return Ok(());
        }
        // A constant signal: the mean, or one of the first few values.
        for value in self.dimensions[index].with_knots(&knots, 1).iter().chain(knots.iter().take(FEW)) {
            if self.go_with(index, Form::Own(vec![value.clone()]))? {
                return Ok(());
            }
        }
        let doubled = std::iter::successors(Some(2 * FEW), |count| count.checked_mul(2));
        for count in (2..=FEW).chain(doubled).take_while(|count| *count < knots.len()) {
            let fewer = self.dimensions[index].with_knots(&knots, count);
            if self.go_with(index, Form::Own(fewer))? {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Sets as many knots of a signal as possible to nominal.
    fn reset_knots(&mut self, index: usize) -> Result<(), E> {
        let Form::Own(knots) = self.current[index].clone() else { return Ok(()) };
        let nominal = self.dimensions[index].nominal_knots(knots.len());
        let own = (0..knots.len()).filter(|knot| knots[*knot] != nominal[*knot]).collect();
        needed(own, |kept| {
            let knots = (0..knots.len()).map(|knot| if kept.contains(&knot) { &knots[knot] } else { &nominal[knot] });
            self.go_with(index, Form::Own(knots.cloned().collect()))
        })?;
        Ok(())
    }

    fn go_with_knot(&mut self, index: usize, knot: usize, value: Value) -> Result<bool, E> {
        let Form::Own(mut knots) = self.current[index].clone() else { return Ok(false) };
        knots[knot] = value;
        self.go_with(index, Form::Own(knots))
    }

    /// Moves a number by bisection as near to nominal as the test fails, and from there away to the next round
    /// number.
    fn simplify_number(&mut self, index: usize, knot: usize, decimals: Decimals) -> Result<(), E> {
        let Some(before) = self.number(index, knot) else { return Ok(()) };
        let knots = match &self.current[index] {
            Form::Own(knots) => knots.len(),
            Form::Nominal => return Ok(()),
        };
        let Some(goal) = self.dimensions[index].nominal_knots(knots)[knot].number() else { return Ok(()) };
        if before == goal {
            return Ok(());
        }
        let start = self.current.clone();
        let (mut passing, mut failing) = (goal, before);
        while (failing - passing).abs() > decimals.resolution() {
            let middle = 0.5 * passing + 0.5 * failing;
            // During bisection numbers may be less simple than at its start.
            let mut forms = self.current.clone();
            if let Form::Own(knots) = &mut forms[index] {
                knots[knot] = Value::Number(middle);
            }
            *(if self.go(forms)? { &mut failing } else { &mut passing }) = middle;
        }
        let nearest = std::mem::replace(&mut self.current, start);
        for round in decimals.beyond(failing, goal) {
            if self.go_with_knot(index, knot, Value::Number(round))? {
                return Ok(());
            }
        }
        if self.dimensions[index].compare(&nearest[index], &self.current[index]) == Ordering::Less {
            self.current = nearest;
        }
        Ok(())
    }

    /// Makes two parameters simpler at once, if possible for any two.
    fn simplify_two(&mut self) -> Result<bool, E> {
        for second in 1..self.dimensions.len() {
            for first in 0..second {
                for (one, other) in self.pairs(first, second) {
                    let mut forms = self.current.clone();
                    (forms[first], forms[second]) = (one, other);
                    if self.go(forms)? {
                        return Ok(true);
                    }
                }
            }
        }
        Ok(false)
    }

    /// Returns pairs of simpler forms of two parameters, the simplest first.
    fn pairs(&self, first: usize, second: usize) -> Vec<(Form, Form)> {
        let [one, other] = [first, second].map(|index| self.simpler_forms(index));
        one.iter().flat_map(|one| other.iter().map(|other| (one.clone(), other.clone()))).collect()
    }

    /// Returns a few forms of a parameter that are simpler than the current form, such as nominal, constant, an early
    /// level, or a round number half as far from nominal.
    fn simpler_forms(&self, index: usize) -> Vec<Form> {
        let dimension = &self.dimensions[index];
        let Form::Own(knots) = &self.current[index] else { return Vec::new() };
        let constant = dimension.with_knots(knots, 1);
        let values: Vec<Value> = match (&dimension.parameter.domain, &constant[0]) {
            _ if knots.len() > 1 => vec![constant[0].clone()],
            (Domain::Choice(levels), _) => levels.iter().take(FEW).cloned().collect(),
            (Domain::Interval { lo, hi }, value) => {
                let goal = dimension.nominal_knots(1)[0].number();
                let ends = value.number().zip(goal);
                let half = ends.and_then(|(here, goal)| {
                    Decimals::of(*lo, *hi).beyond(0.5 * goal + 0.5 * here, goal).find(|half| *half != here)
                });
                half.map(Value::Number).into_iter().collect()
            }
        };
        let own = values.into_iter().map(|value| Form::Own(vec![value]));
        let all = std::iter::once(Form::Nominal).chain(own);
        all.filter(|form| dimension.compare(form, &self.current[index]) == Ordering::Less).collect()
    }

    fn number(&self, index: usize, knot: usize) -> Option<f64> {
        match &self.current[index] {
            Form::Own(knots) => knots[knot].number(),
            Form::Nominal => None,
        }
    }
}

/// The number of knots up to which every smaller number of knots is tried; beyond it, only powers of two are tried.
const FEW: usize = 4;
