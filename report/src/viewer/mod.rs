//! Shows a campaign from a server on this machine: the page of a report, on which any test can be played and further tests can be run.
//!
//! A [`Viewer`] answers questions of the page: for the page itself, for the run of a logged test, and for a new test with values that somebody
//! has clicked or dragged. `server.rs` takes the questions from a browser on this machine. Nothing is written: a new test is no test of the campaign.

mod server;

pub use server::{Doorway, NoServer};

use crate::html::{Record, Recorder};
use paracosm_campaign::{Error, Folder, Log, Number, Reason, Study, Supervision, Trial, Worker};
use paracosm_space::{Domain, Record as Named, Space, SpaceError, Value, Values, plural};
use serde::Serialize;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, Sender, channel};
use thiserror::Error;
use tokio::sync::oneshot;

/// A function that reads the log of the campaign as it is now.
type ReadLog<'a> = dyn Fn() -> Result<Log, Error> + Sync + 'a;

/// A function that makes the page of the campaign as it is now.
type MakePage<'a> = dyn Fn() -> Result<String, Error> + Sync + 'a;

/// A viewer of a campaign, which answers the questions of a page.
pub struct Viewer<'a> {
    /// The study of the campaign, whose tests run.
    pub study: &'a Study,
    /// The folder of the campaign.
    pub folder: &'a Path,
    /// Reads the log of the campaign as it is now: the campaign may still run.
    pub read: &'a ReadLog<'a>,
    /// Makes the page of the campaign as it is now, with [`Page::served`](crate::html::Page::served).
    pub page: &'a MakePage<'a>,
    /// Ends the viewer, and gets the output of programs.
    pub supervision: Supervision,
}

/// A question of the page.
#[derive(Debug, Clone, PartialEq)]
enum Question {
    /// The page.
    Page,
    /// The number of tests that the campaign has by now, and whether more may come.
    Progress,
    /// The run of the test with an index.
    Run { index: usize },
    /// The run of a new test, with a number for each coordinate: the value, or the position of the level.
    Try { numbers: Vec<f64> },
}

/// An answer to a question.
enum Answer {
    /// The page or JSON.
    Found(String),
    /// The reason in words why there is no answer.
    Refused(String),
}

/// A question, with the way back for the answer.
type Asked = (Question, oneshot::Sender<Answer>);

/// The error that the page asks for a test that does not exist.
#[derive(Debug, Clone, PartialEq, Error)]
enum NoTest {
    #[error("the campaign has {}, and no test {index}", plural(*tests, "test"))]
    Index { index: usize, tests: usize },
    #[error("found {}, expected {expected}: one for each coordinate", plural(*found, "number"))]
    Count { found: usize, expected: usize },
    #[error("`{name}`: no level has the position {position}")]
    Level { name: String, position: f64 },
    #[error("the test breaks the constraint `{constraint}`")]
    Broken { constraint: String },
    #[error(transparent)]
    Space(#[from] SpaceError),
}

impl Reason for NoTest {}

/// The number of tests of a campaign by now, and whether more may come.
#[derive(Debug, Serialize)]
struct Progress {
    tests: usize,
    unfinished: bool,
}

/// A test that was run for the page.
#[derive(Debug, Serialize)]
struct Played {
    /// The values of the open parameters.
    test: Values,
    verdict: String,
    /// The robustness of each requirement; null if it is undecided.
    robustness: Named<Number>,
    trace_hash: Option<String>,
    /// The reason why the test has no result.
    problem: Option<String>,
    /// The run; `None` if there is no world to show.
    run: Option<Record>,
}

impl Viewer<'_> {
    /// Answers questions at a doorway until the flag of the supervision is set.
    ///
    /// # Errors
    /// The driver of the study cannot be made, or the machine has no threads left.
    pub fn serve(&self, doorway: Doorway) -> Result<(), Error> {
        let mut worker = Worker::until(self.study, self.supervision.clone())?;
        // A long log is read again only for tests that it did not have.
        let mut known = None;
        // Pages take seconds, and nobody waits for them to see a run.
        let ((pages, page_questions), (runs, run_questions)) = (channel::<Asked>(), channel::<Asked>());
        std::thread::scope(|scope| {
            scope.spawn(|| answer_all(page_questions, |question| self.about_campaign(&question)));
            scope.spawn(|| answer_all(run_questions, |question| self.about_test(&question, &mut worker, &mut known)));
            doorway.open(pages, runs, &self.supervision.stop).map_err(Error::unavailable)
        })
    }

    fn about_campaign(&self, question: &Question) -> Result<String, Error> {
        match question {
            Question::Progress => {
                let tests = (self.read)()?.trials().len();
                Ok(json(&Progress { tests, unfinished: Folder::is_unfinished(self.folder, self.study, tests) }))
            }
            _ => (self.page)(),
        }
    }

    fn about_test(&self, question: &Question, worker: &mut Worker, known: &mut Option<Log>) -> Result<String, Error> {
        let mut recorder = Recorder::default();
        let (trial, trace) = match question {
            Question::Try { numbers } => {
                let test = test_of(self.study.space(), numbers)?;
                worker.watch(0, &test, |run| recorder.see(run))
            }
            Question::Run { index } => {
                let log = match known.take().filter(|log| *index < log.trials().len()) {
                    Some(log) => known.insert(log),
                    None => known.insert((self.read)()?),
                };
                let logged = log.trials().get(*index);
                let logged = logged.ok_or(NoTest::Index { index: *index, tests: log.trials().len() })?;
                worker.replay(log, logged, |run| recorder.see(run))
            }
            Question::Page | Question::Progress => return self.about_campaign(question),
        };
        if self.supervision.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        let run = recorder.record(self.study, trial.index, trial.verdict.to_string(), trace.as_ref());
        Ok(json(&Played::of(trial, run)))
    }
}

impl Played {
    fn of(trial: Trial, run: Option<Record>) -> Self {
        let robustness = trial.requirements().map(|id| (id.to_owned(), Number(trial.robustness(id)))).collect();
        let problem = trial.error().map(str::to_owned);
        let Trial { test, verdict, trace_hash, .. } = trial;
        Self { test, verdict: verdict.to_string(), robustness, trace_hash, problem, run }
    }
}

fn answer_all(questions: Receiver<Asked>, mut answer: impl FnMut(Question) -> Result<String, Error>) {
    for (question, back) in questions {
        // A page that has gone waits for no answer.
        if !back.is_closed() {
            let answer = answer(question).map_or_else(|error| Answer::Refused(error.to_string()), Answer::Found);
            let _ = back.send(answer);
        }
    }
}

fn json(of: &impl Serialize) -> String {
    serde_json::to_string(of).expect("an answer is always JSON")
}

/// Returns the test with these numbers for the coordinates of a space.
fn test_of(space: &Space, numbers: &[f64]) -> Result<Values, Error> {
    let expected = space.coordinates().count();
    if numbers.len() != expected {
        return Err(NoTest::Count { found: numbers.len(), expected }.into());
    }
    let mut left = numbers.iter();
    let mut scalar = |name: &str, domain: &Domain| {
        let number = *left.next().expect("they were counted");
        match domain {
            Domain::Interval { .. } => Ok(Value::Number(number)),
            Domain::Choice(levels) => {
                let is_position = number >= 0.0 && number.fract() == 0.0;
                let level = is_position.then(|| levels.get(number as usize)).flatten();
                level.cloned().ok_or_else(|| NoTest::Level { name: name.to_owned(), position: number })
            }
        }
    };
    let mut values = Vec::new();
    for parameter in space.parameters() {
        let (name, domain) = (&parameter.name, &parameter.domain);
        let value = match parameter.signal {
            None => scalar(name, domain)?,
            Some(shape) => {
                Value::List((0..shape.coordinates()).map(|_| scalar(name, domain)).collect::<Result<_, _>>()?)
            }
        };
        values.push((name.clone(), value));
    }
    let test: Values = values.into_iter().collect();
    let point = space.encode(&test).map_err(NoTest::from)?;
    match space.broken(&point) {
        Some(constraint) => Err(NoTest::Broken { constraint: constraint.text().to_owned() }.into()),
        None => Ok(test),
    }
}

/// Sends a question, and waits for the answer.
async fn ask(desk: &Sender<Asked>, question: Question) -> Answer {
    let (back, answer) = oneshot::channel();
    let gone = || Answer::Refused("the viewer ends".to_owned());
    match desk.send((question, back)) {
        Ok(()) => answer.await.unwrap_or_else(|_| gone()),
        Err(_) => gone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_space::Parameter;

    #[test]
    fn numbers_are_a_test_if_they_lie_in_the_space_and_keep_its_constraints() {
        let speed = Parameter::new("speed", Domain::Interval { lo: 0.0, hi: 10.0 });
        let levels = [2.0, 4.0].map(Value::Number).to_vec();
        let lanes = Parameter::new("lanes", Domain::Choice(levels));
        let space = Space::new(vec![speed, lanes]).unwrap().with_constraints(["lanes == 4 or speed < 5"]).unwrap();
        let test = test_of(&space, &[0.1 + 0.2, 0.0]).unwrap();
        assert_eq!(
            (test.get("speed"), test.get("lanes")),
            (Some(&Value::Number(0.1 + 0.2)), Some(&Value::Number(2.0)))
        );
        for (numbers, says) in [
            (vec![1.0], "found 1 number, expected 2: one for each coordinate"),
            (vec![1.0, 2.0], "`lanes`: no level has the position 2"),
            (vec![1.0, -1.0], "`lanes`: no level has the position -1"),
            (vec![1.0, f64::NAN], "`lanes`: no level has the position NaN"),
            (vec![11.0, 0.0], "parameter `speed`: found 11, expected a number in [0, 10]"),
            (vec![f64::NAN, 0.0], "parameter `speed`: found NaN, expected a number in [0, 10]"),
            (vec![6.0, 0.0], "the test breaks the constraint `lanes == 4 or speed < 5`"),
        ] {
            assert_eq!(test_of(&space, &numbers).unwrap_err().to_string(), says);
        }
    }
}
