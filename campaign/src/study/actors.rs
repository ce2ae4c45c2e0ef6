//! The actors of a study, each of which a model of the user may replace in images.

use super::appearance::first_of;
use super::{ModelFlaw, Study};
use crate::{Error, Reason};
use paracosm_engine::object::Class;
use paracosm_engine::{Run, Setup, Test};
use paracosm_space::{Domain, Value, Values, did_you_mean, nearest};
use thiserror::Error;

/// The reason why an actor cannot be shown as a model.
#[derive(Debug, Error)]
pub enum AppearanceFlaw {
    /// The scenario has no such actor.
    #[error(
        "--model {actor}={file}: `{scenario}` has no actor `{actor}`{}; it has {}", did_you_mean(.nearest), all.join(", ")
    )]
    NoActor {
        /// The name of the actor.
        actor: String,
        /// The file of the model.
        file: String,
        /// The name of the scenario.
        scenario: String,
        /// The name of an actor that was perhaps meant.
        nearest: Option<String>,
        /// The names of all actors; of several actors with one name, only the first.
        all: Vec<String>,
    },
    /// The actor already has a model.
    #[error("--model {actor}={file}: the actor already has another model, {other}")]
    Twice {
        /// The name of the actor.
        actor: String,
        /// The file of the new model.
        file: String,
        /// The file of the model that the actor has.
        other: String,
    },
    /// The model cannot be used.
    #[error("--model {actor}={file}: {flaw}")]
    Model {
        /// The name of the actor.
        actor: String,
        /// The file of the model.
        file: String,
        /// The flaw of the model.
        flaw: ModelFlaw,
    },
}

impl Reason for AppearanceFlaw {}

impl Study {
    /// Shows an actor to cameras as the model in a glTF file.
    pub(super) fn show(&mut self, actor: &str, file: &str) -> Result<(), Error> {
        let actors = self.actors()?;
        let (actor, file) = (actor.to_owned(), file.to_owned());
        let Some((_, class)) = actors.iter().find(|(name, _)| *name == actor) else {
            let scenario = self.subject.scenario()?.scenario().to_owned();
            let names = actors.iter().map(|(name, _)| name.as_str());
            let nearest = nearest(&actor, names.clone()).map(str::to_owned);
            let all = names.filter(|name| first_of(name) == *name).map(str::to_owned).collect();
            return Err(AppearanceFlaw::NoActor { actor, file, scenario, nearest, all }.into());
        };
        let simulation = self.subject.scenario_mut()?;
        match simulation.appearances.show(&actor, *class, &file) {
            Ok(None) => Ok(()),
            Ok(Some(other)) => Err(AppearanceFlaw::Twice { actor, file, other }.into()),
            Err(flaw) => Err(AppearanceFlaw::Model { actor, file, flaw }.into()),
        }
    }

    /// Returns the bodies of tests, by name. They are those of the nominal test, and those that exist with the greatest
    /// values of open parameters.
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
        let run = |test: &Values| Run::new(program, Test::new(test, &self.space), Setup::asking_every(simulation.dt()));
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
