//! Constraints of scenarios: as constraints of the space, or as a filter of the tests that a strategy proposes.

use super::parameters::ParameterMisuse;
use super::{Study, Subject, owned};
use crate::Error;
use paracosm_engine::Constraint;
use paracosm_generators::{Generator, GeneratorError, Request, Strategy};
use paracosm_space::{Parameter, Point, Space, Values, constraint};

/// The number of proposals in a row that may break a constraint before the strategy counts as exhausted.
const MOST_REFUSED: usize = 100_000;
/// The number of tests for an estimate of the share of tests that keep the constraints.
const PROBES: usize = 2048;
/// The factor by which a strategy proposes more tests than the estimated share demands, as a fraction.
const RESERVE: [usize; 2] = [11, 10];

impl Study {
    /// Adds the constraints of the scenario between discrete open parameters to the space.
    pub(super) fn keep_constraints(&mut self) -> Result<(), Error> {
        let Subject::Scenario(_) = &self.subject else { return Ok(()) };
        let nominal = self.nominal()?;
        let mut texts = Vec::new();
        for constraint in self.program()?.declare()?.constraints {
            let open = self.open_parameters(&constraint);
            if open.is_empty() {
                match constraint.broken(&nominal) {
                    Some(why) => return Err(ParameterMisuse::Broken { why }.into()),
                    None => continue,
                }
            }
            let mut test = nominal.clone();
            let holds = |values: &[&paracosm_space::Value]| {
                for (parameter, value) in open.iter().zip(values) {
                    test.set(parameter.name.as_str(), (*value).clone());
                }
                constraint.broken(&test).is_none()
            };
            let written = constraint::expressions(&open, holds);
            texts.extend(written.into_iter().flatten().map(|expression| expression.to_string()));
        }
        self.space = self.space.clone().with_constraints(texts)?;
        self.space.rules()?;
        Ok(())
    }

    /// Makes a generator that proposes only tests that keep all constraints of the scenario. The space has the constraints
    /// between discrete parameters already.
    pub(super) fn keeping(
        &self,
        existing: &[Point],
        build: impl Fn(&Request) -> Result<Box<dyn Generator>, GeneratorError>,
    ) -> Result<Box<dyn Generator>, GeneratorError> {
        let request = self.sampling.request(&self.space, existing);
        // A study whose scenario is not known here reports this with its first test.
        let declared = self.program().ok().and_then(|program| program.declare().ok());
        let constraints = declared.map(|declaration| declaration.constraints).unwrap_or_default();
        let is_continuous = |constraint: &Constraint| {
            self.open_parameters(constraint).iter().any(|parameter| parameter.levels().is_none())
        };
        let constraints: Vec<Constraint> = constraints.into_iter().filter(is_continuous).collect();
        if constraints.is_empty() {
            return build(&request);
        }
        let inner = Strategy::HALTON.build(&Request::new(&self.space, PROBES))?;
        let mut keeping = Keeping { inner, constraints, space: self.space.clone(), fixed: self.fixed().clone() };
        let probes = keeping.inner.ask(PROBES);
        let valid = probes.iter().filter(|point| keeping.keeps(point)).count().max(1);
        // The strategy proposes more tests than the budget, because some of them are left out.
        let budget = request.budget.saturating_mul(probes.len()) / valid * RESERVE[0] / RESERVE[1] + 1;
        keeping.inner = build(&Request { budget, ..request })?;
        Ok(Box::new(keeping))
    }

    /// Returns the open parameters on which a constraint depends.
    fn open_parameters(&self, constraint: &Constraint) -> Vec<&Parameter> {
        let is_named = |parameter: &&Parameter| constraint.names().contains(&parameter.name);
        self.space.parameters().iter().filter(is_named).collect()
    }
}

/// A generator that leaves out the tests that break a constraint.
struct Keeping {
    inner: Box<dyn Generator>,
    constraints: Vec<Constraint>,
    space: Space,
    fixed: Values,
}

impl Keeping {
    fn keeps(&self, point: &Point) -> bool {
        let mut test = self.space.decode(point);
        for (name, value) in self.fixed.iter().map(owned) {
            test.set(name, value);
        }
        self.constraints.iter().all(|constraint| constraint.broken(&test).is_none())
    }
}

impl Generator for Keeping {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let mut kept = Vec::new();
        let mut refused = 0;
        while kept.len() < n && refused < MOST_REFUSED {
            let proposed = self.inner.ask(n - kept.len());
            if proposed.is_empty() {
                break;
            }
            let (good, bad): (Vec<_>, Vec<_>) = proposed.into_iter().partition(|point| self.keeps(point));
            self.inner.tell(&bad, &vec![None; bad.len()]);
            refused = if good.is_empty() { refused + bad.len() } else { 0 };
            kept.extend(good);
        }
        kept
    }

    fn tell(&mut self, tests: &[Point], robustness: &[Option<f64>]) {
        self.inner.tell(tests, robustness);
    }
}
