//! The actors of a study, each of which a model of the user may replace in images.

use super::appearance::first_of;
use super::{ModelFlaw, Study};
use crate::{Error, Reason};
use paracosm_engine::object::Class;
use paracosm_engine::{Run, Setup, Test};
use paracosm_space::{Domain, Value, Values, did_you_mean, nearest};
use thiserror::Error;

/// The reason why a 3D model cannot replace an actor in images.
#[derive(Debug, Error)]
pub enum AppearanceFlaw {
    /// The scenario has no actor with the given name.
    #[error(
        "--model {actor}={file}: `{scenario}` has no actor `{actor}`{}; it has {}", did_you_mean(.nearest), all.join(", ")
    )]
    NoActor {
        /// The name that no actor has.
        actor: String,
        /// The path of the file with the 3D model.
        file: String,
        /// The name of the scenario.
        scenario: String,
        /// The most similar name of an actor; `None` if no name is similar.
        nearest: Option<String>,
        /// The names of all actors, with only the first actor of each numbered series.
        all: Vec<String>,
    },
    /// The actor already has a 3D model.
    #[error("--model {actor}={file}: the actor already has another model, {other}")]
    Twice {
        /// The name of the actor.
        actor: String,
        /// The path of the file with the new 3D model.
        file: String,
        /// The path of the file with the 3D model that the actor already has.
        other: String,
    },
    /// The 3D model cannot be used.
    #[error("--model {actor}={file}: {flaw}")]
    Model {
        /// The name of the actor.
        actor: String,
        /// The path of the file with the 3D model.
        file: String,
        /// The reason why the 3D model cannot be used.
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
            most.into_iter().for_each(|value| greatest.set(parameter.name.as_str(), value));
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
