//! Models of users' own that stand for actors, and which they are, so that nobody sees a test again with others.

#[cfg(feature = "camera")]
mod model;

#[cfg(feature = "camera")]
use model::Loaded;

use super::{Simulation, Study};
use crate::Error;
use paracosm_coverage::{Domain, Value, Values, did_you_mean, nearest};
use paracosm_engine::object::Class;
use paracosm_engine::{Run, Setup, Test};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What actors look like to cameras, by their names, where it is not the usual.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Appearances(BTreeMap<String, Appearance>);

/// The model of a glTF file.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Appearance {
    file: String,
    /// The hash of what is read of it: XXH3, 128 bits.
    hash: String,
    #[cfg(feature = "camera")]
    #[serde(skip)]
    loaded: Loaded,
}

impl Appearances {
    /// Whether all look as usual.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl Study {
    /// Shows an actor to cameras as the model in a glTF file, stretched to the actor's size: the car under test is `car`, all
    /// others are called as in traces and messages. Those of one name, `tree`, `tree-2` and so on, look like the first unless
    /// they have a model of their own. To be called when all parameters are opened and fixed.
    ///
    /// # Errors
    /// There is no such actor, it has a model already, the file cannot be read or is none that can be used, the study is of no
    /// scenario, or the program was built without the feature `camera`.
    pub fn show(mut self, actor: &str, file: &str) -> Result<Self, Error> {
        let actors = self.actors()?;
        let Some((_, class)) = actors.iter().find(|(name, _)| name == actor) else {
            let scenario = &self.subject.scenario()?.scenario;
            let names = actors.iter().map(|(name, _)| name.as_str());
            let hint = did_you_mean(&nearest(actor, names.clone()));
            let all = names.filter(|name| first_of(name) == *name).collect::<Vec<_>>().join(", ");
            let message = format!("--model {actor}={file}: `{scenario}` has no actor `{actor}`{hint}; it has {all}");
            return Err(Error::Usage(message));
        };
        let appearance = Appearance::read(file, *class)
            .map_err(|message| Error::Usage(format!("--model {actor}={file}: {message}")))?;
        let Simulation { appearances, .. } = self.subject.scenario_mut()?;
        match appearances.0.insert(actor.to_owned(), appearance) {
            None => Ok(self),
            Some(Appearance { file: other, .. }) => {
                let message = format!("--model {actor}={file}: it has another model already, {other}");
                Err(Error::Usage(message))
            }
        }
    }

    /// The bodies that tests have, by name: those of the nominal one, and those that open parameters add at their greatest.
    fn actors(&self) -> Result<Vec<(String, Class)>, Error> {
        let (simulation, nominal) = (self.subject.scenario()?, self.nominal()?);
        let mut greatest = nominal.clone();
        for parameter in self.space.parameters().iter().filter(|parameter| parameter.signal.is_none()) {
            let most = match &parameter.domain {
                Domain::Interval { hi, .. } => Some(Value::Number(*hi)),
                Domain::Choice(levels) => levels.last().cloned(),
            };
            most.into_iter().for_each(|value| greatest.set(&parameter.name, value));
        }
        let program = simulation.program()?;
        let run =
            |test: &Values| Run::new(&program, Test::new(test, &self.space), Setup::asking_every(simulation.dt()));
        let mut actors: Vec<(String, Class)> = Vec::new();
        for run in [run(&nominal)?].into_iter().chain(run(&greatest)) {
            for (body, state) in run.bodies().iter().enumerate() {
                let name = run.name_of(body);
                if !actors.iter().any(|(known, _)| known == name) {
                    actors.push((name.to_owned(), state.body.class));
                }
            }
        }
        Ok(actors)
    }
}

/// The name of the first of those that are numbered under a name: of `tree` for `tree-2`.
fn first_of(name: &str) -> &str {
    match name.rsplit_once('-') {
        Some((first, number)) if number.bytes().all(|byte| byte.is_ascii_digit()) => first,
        _ => name,
    }
}

#[cfg(not(feature = "camera"))]
impl Appearance {
    fn read(_: &str, _: Class) -> Result<Self, String> {
        Err("this program draws nothing: it was built without the feature `camera`".to_owned())
    }
}
