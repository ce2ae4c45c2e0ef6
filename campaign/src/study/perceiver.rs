//! The perceiver of a study: the perception network on trial, with the cameras whose images it sees.

use super::StatedRequirement;
use crate::black_box::{TimeoutFlaw, checked_timeout};
use crate::process::{self, CommandFlaw};
#[cfg(feature = "camera")]
use crate::seeing::SeeingProcess;
use crate::{Error, Reason, Supervision};
use paracosm_engine::sensor::{Cameras, Look};
use paracosm_oracles::Semantics;
use paracosm_perception::{Perceiver, Task, TaskFlaw};
use paracosm_space::did_you_mean;
#[cfg(feature = "camera")]
use paracosm_space::nearest;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;
#[cfg(feature = "camera")]
use std::time::Duration;
use thiserror::Error;

/// The perceiver on trial, with its cameras.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a perceiver")]
pub struct PerceiverChoice {
    /// The file of the network, or the name that this program gives to its perceiver.
    name: String,
    /// The meaning of the answers.
    task: Task,
    /// The cameras; settings that the tests vary are at the middle of their ranges.
    cameras: Cameras,
    /// The look of the images, which a file has beside the cameras.
    look: Look,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    network: Option<Box<SeeingNetwork>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    command: Option<SeeingCommand>,
    #[serde(skip)]
    own: Option<Own>,
}

/// A command that starts a perceiver in a process of its own.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SeeingCommand {
    /// The command, with words separated and quoted as in a shell.
    command: String,
    /// The time that the perceiver may take to answer, in seconds.
    timeout: f64,
}

/// A network in an ONNX file, with its description.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SeeingNetwork {
    /// The 128-bit XXH3 of the file.
    hash: String,
    /// The text of the description.
    description: String,
    #[cfg(feature = "neural")]
    #[serde(skip)]
    loaded: std::sync::OnceLock<paracosm_neural::vision::Vision>,
}

/// A function of the program that makes a perceiver.
#[derive(Clone)]
struct Own(Arc<dyn Fn() -> Box<dyn Perceiver> + Send + Sync>);

impl fmt::Debug for Own {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a function")
    }
}

/// The reason why a perceiver cannot be on trial.
#[derive(Debug, Error)]
pub enum PerceiverFlaw {
    /// Reference drivers are given, but no driver is on trial.
    #[error("a perceiver is on trial, and reference drivers judge the violations of drivers only: leave them out")]
    References,
    /// The program was built without neural networks.
    #[error(
        "--perceiver {file} is a network, but this program was built without networks: build it with `cargo build --release \
         --features neural`"
    )]
    NotBuilt {
        /// The file of the network.
        file: String,
    },
    /// The perceiver was a function of another program.
    #[error(
        "the perceiver `{name}` is a function of the program that ran the campaign; only that program can run its tests"
    )]
    NotHere {
        /// The name of the perceiver.
        name: String,
    },
    /// The command of the perceiver is invalid.
    #[error("--perceiver-command '{command}': {flaw}")]
    Command {
        /// The command.
        command: String,
        /// The error in the command.
        flaw: CommandFlaw,
    },
    /// The time-out of the perceiver is out of range.
    #[error(transparent)]
    Timeout(TimeoutFlaw),
    /// This program was built without cameras, so it has no images for a perceiver.
    #[error("perceivers need images, but this program was built without cameras")]
    WithoutImages,
    /// A segmentation network names a semantic class that images do not have.
    #[error("the mask of the perceiver `{perceiver}` means `{name}`, expected some of {}{}", all.join(", "), did_you_mean(.nearest))]
    Segment {
        /// The name of the perceiver.
        perceiver: String,
        /// The name that no semantic class has.
        name: String,
        /// The semantic classes.
        all: Vec<&'static str>,
        /// The most similar semantic class.
        nearest: Option<&'static str>,
    },
    /// The file has another number of cameras than one.
    #[error("a perceiver sees through one camera, found {}: {}", found.len(), found.join(", "))]
    Cameras {
        /// The names of the cameras.
        found: Vec<String>,
    },
    /// The meaning of the answers differs from the meaning that the perceiver states.
    #[error(
        "`perceiver` has another `task` than the perceiver `{name}` itself: the file was changed after the campaign"
    )]
    Task {
        /// The name of the perceiver.
        name: String,
    },
    /// The meaning of the answers is not valid.
    #[error("`task` of `perceiver`: {0}")]
    Meaning(TaskFlaw),
    /// The network has changed since the campaign was run.
    #[error("the network {file} has the hash {found}, expected {expected}: the campaign was run with another network")]
    Changed {
        /// The file of the network.
        file: String,
        /// The present hash of the file.
        found: String,
        /// The hash of the file when the campaign was run.
        expected: String,
    },
    /// A segmentation network has no usual requirement.
    #[error("a segmentation network needs a requirement: add a --spec about {}", signals.join(", "))]
    NoRequirement {
        /// The signals of the network.
        signals: Vec<&'static str>,
    },
}

impl Reason for PerceiverFlaw {}

/// The seconds within which a vehicle has to be detected.
const WITHIN: f64 = 0.5;

impl PerceiverChoice {
    /// Makes the choice of a perceiver that a function of this program makes.
    #[cfg(feature = "camera")]
    pub(super) fn own(
        name: &str,
        cameras: Cameras,
        make: impl Fn() -> Box<dyn Perceiver> + Send + Sync + 'static,
    ) -> Result<Self, PerceiverFlaw> {
        let task = make().task().clone();
        let choice = Self {
            name: name.to_owned(),
            task,
            look: cameras.look,
            cameras,
            network: None,
            command: None,
            own: Some(Own(Arc::new(make))),
        };
        choice.check().map(|()| choice)
    }

    /// Makes the choice of a perceiver that a command starts, and asks the perceiver what its answers mean. The time-out
    /// is in seconds; `None` is the default time-out.
    #[cfg(feature = "camera")]
    pub(super) fn process(command: &str, timeout: Option<f64>, cameras: Cameras) -> Result<Self, Error> {
        one_of(&cameras)?;
        let timeout = checked_timeout(timeout)?;
        let command = SeeingCommand { command: command.to_owned(), timeout };
        let task = command.meaning()?;
        let name = command.command.clone();
        let choice = Self { name, task, look: cameras.look, cameras, network: None, command: Some(command), own: None };
        choice.check()?;
        Ok(choice)
    }

    /// Returns the command that starts the perceiver; `None` if the perceiver runs in this process.
    pub fn command(&self) -> Option<&str> {
        self.command.as_ref().map(|command| command.command.as_str())
    }

    /// Sets another command in place of the command that starts the perceiver.
    pub(super) fn set_command(&mut self, command: &str) -> Result<(), PerceiverFlaw> {
        if let Some(seeing) = &mut self.command {
            command.clone_into(&mut seeing.command);
            command.clone_into(&mut self.name);
        }
        self.check()
    }

    /// Returns the name of the perceiver.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the meaning of the answers.
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// Returns the camera, as a set of one camera. Settings that the tests vary are at the middle of their ranges.
    pub fn cameras(&self) -> Cameras {
        Cameras { look: self.look, ..self.cameras.clone() }
    }

    /// Returns the requirement of a detector without other requirements, with the id `detection`.
    pub(super) fn usual_requirement(&self) -> Result<StatedRequirement, PerceiverFlaw> {
        if matches!(self.task, Task::Segmentation(_)) {
            return Err(PerceiverFlaw::NoRequirement { signals: self.task.signals().to_vec() });
        }
        Ok(StatedRequirement {
            id: "detection".to_owned(),
            text: format!("Every road user that is visible to 75 % and within 40 m is matched within {WITHIN} s."),
            formula: format!("always ({} <= {WITHIN})", Task::UNMATCHED).parse().ok(),
            unit: "s".to_owned(),
            scale: Some(WITHIN),
            source: None,
            severity: None,
            time: Semantics::Sampled,
            given: true,
        })
    }

    /// Makes a new instance of the perceiver. A perceiver in a process of its own is waited for until the campaign is stopped.
    ///
    /// # Errors
    /// The study was read from a file, and the network does not exist or has changed, or the perceiver was a function of
    /// another program; or this program was built without networks.
    pub fn build(&self, supervision: Supervision) -> Result<Box<dyn Perceiver>, Error> {
        if let Some(command) = &self.command {
            return command.build(supervision, self.task.clone());
        }
        let perceiver = match (&self.own, &self.network) {
            (Some(Own(make)), _) => make(),
            (None, Some(network)) => network.build(&self.name)?,
            (None, None) => return Err(PerceiverFlaw::NotHere { name: self.name.clone() }.into()),
        };
        if *perceiver.task() != self.task {
            return Err(PerceiverFlaw::Task { name: self.name.clone() }.into());
        }
        Ok(perceiver)
    }

    /// Checks a choice that was read from a file.
    pub(crate) fn check(&self) -> Result<(), PerceiverFlaw> {
        one_of(&self.cameras)?;
        match &self.task {
            Task::Detection(detector) => detector.check().map_err(PerceiverFlaw::Meaning),
            Task::Segmentation(segmenter) => self.check_segments(&segmenter.is),
        }?;
        self.command.as_ref().map_or(Ok(()), |command| {
            checked_timeout(Some(command.timeout)).map_err(PerceiverFlaw::Timeout)?;
            command.words().map(|_| ())
        })
    }
}

impl PerceiverChoice {
    #[cfg(feature = "camera")]
    fn check_segments(&self, names: &[String]) -> Result<(), PerceiverFlaw> {
        let all = paracosm_render::Semantic::names();
        let Some(name) = names.iter().find(|name| !all.contains(&name.as_str())) else { return Ok(()) };
        let nearest = nearest(name, all.iter().copied());
        Err(PerceiverFlaw::Segment { perceiver: self.name.clone(), name: name.clone(), all: all.to_vec(), nearest })
    }

    /// Without images no mask can be compared.
    #[cfg(not(feature = "camera"))]
    fn check_segments(&self, _: &[String]) -> Result<(), PerceiverFlaw> {
        Ok(())
    }
}

impl SeeingCommand {
    fn words(&self) -> Result<Vec<String>, PerceiverFlaw> {
        process::words(&self.command).map_err(|flaw| PerceiverFlaw::Command { command: self.command.clone(), flaw })
    }

    #[cfg(feature = "camera")]
    fn meaning(&self) -> Result<Task, Error> {
        SeeingProcess::meaning(&self.words()?, Duration::from_secs_f64(self.timeout), &Supervision::default())
    }

    #[cfg(feature = "camera")]
    fn build(&self, supervision: Supervision, task: Task) -> Result<Box<dyn Perceiver>, Error> {
        let timeout = Duration::from_secs_f64(self.timeout);
        Ok(Box::new(SeeingProcess::new(self.words()?, timeout, supervision, task)))
    }

    #[cfg(not(feature = "camera"))]
    fn build(&self, _: Supervision, _: Task) -> Result<Box<dyn Perceiver>, Error> {
        Err(Error::unavailable(PerceiverFlaw::WithoutImages))
    }
}

/// Checks that a set has one camera.
fn one_of(cameras: &Cameras) -> Result<(), PerceiverFlaw> {
    if cameras.all.len() == 1 {
        return Ok(());
    }
    Err(PerceiverFlaw::Cameras { found: cameras.all.keys().cloned().collect() })
}

#[cfg(all(not(feature = "neural"), feature = "camera"))]
impl PerceiverChoice {
    /// Returns the error that the program was built without neural networks.
    pub(super) fn network(file: &str, _: &str, _: Cameras) -> Result<Self, Error> {
        Err(Error::unavailable(PerceiverFlaw::NotBuilt { file: file.to_owned() }))
    }
}

#[cfg(not(feature = "neural"))]
impl SeeingNetwork {
    fn build(&self, file: &str) -> Result<Box<dyn Perceiver>, Error> {
        Err(Error::unavailable(PerceiverFlaw::NotBuilt { file: file.to_owned() }))
    }
}

#[cfg(feature = "neural")]
impl PerceiverChoice {
    /// Reads a network from an ONNX file, and its description from another file.
    pub(super) fn network(file: &str, described: &str, cameras: Cameras) -> Result<Self, Error> {
        use paracosm_neural::vision::Description;
        one_of(&cameras)?;
        let path = std::path::Path::new(described);
        let description = crate::files::read_text(path)?;
        let read =
            Description::parse(&description).map_err(|flaw| Error::in_file(path, flaw.line(&description), flaw))?;
        let contents = super::network::contents(file)?;
        let (hash, loaded) = (super::network::hash(&contents), std::sync::OnceLock::new());
        let network = SeeingNetwork { hash, description, loaded };
        let _ = network.loaded.set(vision(file, &contents, read.clone())?);
        let network = Some(Box::new(network));
        let (name, task, look) = (file.to_owned(), read.task, cameras.look);
        let choice = Self { name, task, look, cameras, network, command: None, own: None };
        choice.check()?;
        Ok(choice)
    }
}

#[cfg(feature = "neural")]
impl SeeingNetwork {
    fn build(&self, file: &str) -> Result<Box<dyn Perceiver>, Error> {
        use paracosm_neural::vision::Description;
        if self.loaded.get().is_none() {
            let contents = super::network::contents(file)?;
            let found = super::network::hash(&contents);
            if found != self.hash {
                let (file, expected) = (file.to_owned(), self.hash.clone());
                return Err(PerceiverFlaw::Changed { file, found, expected }.into());
            }
            let described =
                Description::parse(&self.description).map_err(|flaw| Error::in_file(file.as_ref(), None, flaw))?;
            let _ = self.loaded.set(vision(file, &contents, described)?);
        }
        Ok(Box::new(self.loaded.get().expect("it was just read").clone()))
    }
}

/// Reads a network that sees.
#[cfg(feature = "neural")]
fn vision(
    file: &str,
    contents: &[u8],
    described: paracosm_neural::vision::Description,
) -> Result<paracosm_neural::vision::Vision, Error> {
    super::network::in_worker(file, || paracosm_neural::vision::Vision::read(contents, described))
}
