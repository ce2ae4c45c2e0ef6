//! Constraints of scenarios: as constraints of the space, or as a filter of the tests that a strategy proposes.

use super::parameters::ParameterMisuse;
use super::{Study, Subject, owned};
use crate::Error;
use paracosm_engine::Constraint;
use paracosm_generators::{Generator, GeneratorError, Request, Strategy};
use paracosm_space::{Parameter, Point, Space, Values, constraint};

/// The number of proposals in a row that may break a constraint before the strategy counts as exhausted.
const MOST_REFUSED: usize = 10_000;
/// At least one of so many tests has to keep the constraints.
const LEAST_SHARE: usize = 100;
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
        let filter = Filter::of(self, self.program()?.declare()?.constraints);
        if !filter.constraints.is_empty() {
            let (valid, probes) = filter.share()?;
            if valid < probes.div_ceil(LEAST_SHARE) {
                return Err(ParameterMisuse::Rare { valid, probes, why: filter.first_reason() }.into());
            }
        }
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
        let filter = Filter::of(self, constraints);
        if filter.constraints.is_empty() {
            return build(&request);
        }
        let (valid, probes) = filter.share()?;
        // The strategy proposes more tests than the budget, because some of them are left out.
        let most = request.budget.saturating_mul(probes) / valid.max(probes.div_ceil(LEAST_SHARE));
        let inner = build(&Request { budget: most * RESERVE[0] / RESERVE[1] + 1, ..request })?;
        Ok(Box::new(Keeping { inner, filter }))
    }

    /// Returns the open parameters on which a constraint depends.
    fn open_parameters(&self, constraint: &Constraint) -> Vec<&Parameter> {
        let is_named = |parameter: &&Parameter| constraint.names().contains(&parameter.name);
        self.space.parameters().iter().filter(is_named).collect()
    }
}

/// The constraints that are not in the space.
struct Filter {
    constraints: Vec<Constraint>,
    space: Space,
    fixed: Values,
}

impl Filter {
    /// Selects the constraints between open parameters that the space cannot have.
    fn of(study: &Study, constraints: Vec<Constraint>) -> Self {
        let is_beside = |constraint: &Constraint| {
            let open = study.open_parameters(constraint);
            !open.is_empty() && !constraint::can_be_written(&open)
        };
        let constraints = constraints.into_iter().filter(is_beside).collect();
        Self { constraints, space: study.space.clone(), fixed: study.fixed().clone() }
    }

    /// Returns the reason why a test breaks a constraint; `None` if it keeps all.
    fn broken(&self, point: &Point) -> Option<String> {
        let mut test = self.space.decode(point);
        for (name, value) in self.fixed.iter().map(owned) {
            test.set(name, value);
        }
        self.constraints.iter().find_map(|constraint| constraint.broken(&test))
    }

    /// Returns points that fill the space evenly.
    fn probes(&self) -> Result<Vec<Point>, GeneratorError> {
        Ok(Strategy::HALTON.build(&Request::new(&self.space, PROBES))?.ask(PROBES))
    }

    /// Returns the number of probes that keep all constraints, and the number of all probes.
    fn share(&self) -> Result<(usize, usize), GeneratorError> {
        let probes = self.probes()?;
        Ok((probes.iter().filter(|point| self.broken(point).is_none()).count(), probes.len()))
    }

    /// Returns the reason why the first probe that breaks a constraint breaks it.
    fn first_reason(&self) -> String {
        let probes = self.probes().unwrap_or_default();
        probes.iter().find_map(|point| self.broken(point)).unwrap_or_default()
    }
}

/// A generator that leaves out the tests that break a constraint.
struct Keeping {
    inner: Box<dyn Generator>,
    filter: Filter,
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
            let (good, bad): (Vec<_>, Vec<_>) =
                proposed.into_iter().partition(|point| self.filter.broken(point).is_none());
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
