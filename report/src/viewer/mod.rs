//! Shows a campaign from a server on this machine: the page of a report, on which any test can be played and further tests can be run.
//!
//! A [`Viewer`] answers questions of the page: for the page itself, for the run of a test of the campaign or of a new test whose values somebody
//! has clicked or dragged (`wanted.rs`), and for what takes many runs (`errand.rs`). `server.rs` takes the questions from a browser on this
//! machine. Nothing is written: a new test is no test of the campaign.

mod errand;
mod question;
mod server;
mod wanted;

pub use server::{Doorway, NoServer};

use crate::html::{Grid, Record, Recorder};
use errand::Errand;
use paracosm_campaign::cameras::VariedCameras;
use paracosm_campaign::{Error, Folder, Log, Number, Study, Supervision, Trial, Worker};
use paracosm_space::{Record as Named, Values};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::SystemTime;
use tokio::sync::oneshot;
use wanted::Wanted;

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
    /// The cameras that film tests; `None` for the cameras of the driver, or a camera for people if the driver has none.
    pub cameras: Option<&'a VariedCameras>,
    /// Ends the viewer, and gets the output of programs.
    pub supervision: Supervision,
}

/// A question of the page.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Question {
    /// The page.
    #[serde(skip)]
    Page,
    /// The number of tests that the campaign has by now, and whether more may come.
    Progress,
    /// The estimated probability of failure over two coordinates, by their positions.
    Map([usize; 2]),
    /// The run of a test.
    Run(Wanted),
    /// A question that takes many runs.
    #[serde(untagged)]
    Errand(Errand),
}

/// An answer to a question.
enum Answer {
    Page(String),
    Json(String),
    /// The contents of an MP4 file.
    Film(Vec<u8>),
    /// The reason in words why there is no answer.
    Refused(String),
}

/// A question, with the way back for the answer and a flag that is set once nobody waits for the answer.
type Asked = (Question, oneshot::Sender<Answer>, Arc<AtomicBool>);

/// The places to which questions go. Nobody waits for a page to see a run, or for many runs to see one.
struct Desks {
    pages: Sender<Asked>,
    runs: Sender<Asked>,
    errands: Sender<Asked>,
}

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
    /// A sentence if a test of the campaign ends otherwise now than in the log.
    differs: Option<String>,
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
        let (pages, page_questions) = channel();
        let (runs, run_questions) = channel();
        let (errands, errand_questions) = channel();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                let mut made = None;
                answer_all(page_questions, |question, _| match question {
                    Question::Page => self.page_by_now(&mut made),
                    question => self.about_campaign(&question),
                });
            });
            scope
                .spawn(|| answer_all(run_questions, |question, _| self.about_test(&question, &mut worker, &mut known)));
            scope.spawn(|| answer_all(errand_questions, |question, gone| self.about_errand(question, gone)));
            doorway.open(Desks { pages, runs, errands }, &self.supervision.stop).map_err(Error::unavailable)
        })
    }

    fn about_campaign(&self, question: &Question) -> Result<Answer, Error> {
        match question {
            Question::Progress => {
                let tests = (self.read)()?.trials().len();
                Ok(json(&Progress { tests, unfinished: Folder::is_unfinished(self.folder, self.study, tests) }))
            }
            Question::Map(axes) => Ok(json(&Grid::over(&(self.read)()?, *axes)?)),
            _ => (self.page)().map(Answer::Page),
        }
    }

    /// Returns the page, which is made again only if the campaign or its folder has changed.
    fn page_by_now(&self, made: &mut Option<(Vec<SystemTime>, String)>) -> Result<Answer, Error> {
        let changed =
            [self.folder.to_owned(), self.folder.join("trials.jsonl")].map(|path| path.metadata()?.modified());
        let times: Option<Vec<SystemTime>> = changed.into_iter().map(std::io::Result::ok).collect();
        if let Some((_, page)) = made.as_ref().filter(|(before, _)| times.as_ref() == Some(before)) {
            return Ok(Answer::Page(page.clone()));
        }
        let page = (self.page)()?;
        *made = times.map(|times| (times, page.clone()));
        Ok(Answer::Page(page))
    }

    fn about_test(&self, question: &Question, worker: &mut Worker, known: &mut Option<Log>) -> Result<Answer, Error> {
        let Question::Run(wanted) = question else { return self.about_campaign(question) };
        let log = match known.take().filter(|log| wanted.is_in(log)) {
            Some(log) => known.insert(log),
            None => known.insert((self.read)()?),
        };
        let mut recorder = Recorder::default();
        let (trial, trace) = wanted.run(worker, log, |run| recorder.see(run))?;
        if self.supervision.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        let run = recorder.record(self.study, trial.index, trial.verdict.to_string(), trace.as_ref());
        let logged = wanted.logged(log).filter(|logged| !trial.repeats(logged));
        let differs = logged.map(|logged| differing(logged, &trial));
        Ok(json(&Played { differs, ..Played::of(trial, run) }))
    }

    fn about_errand(&self, question: Question, gone: Arc<AtomicBool>) -> Result<Answer, Error> {
        match question {
            Question::Errand(errand) => errand.answer(self, gone),
            question => self.about_campaign(&question),
        }
    }
}

impl Played {
    fn of(trial: Trial, run: Option<Record>) -> Self {
        let robustness = trial.requirements().map(|id| (id.to_owned(), Number(trial.robustness(id)))).collect();
        let (problem, differs) = (trial.error().map(str::to_owned), None);
        let Trial { test, verdict, trace_hash, .. } = trial;
        Self { test, verdict: verdict.to_string(), robustness, trace_hash, problem, differs, run }
    }
}

/// Says how a run differs from the log, where the page shows the results of the log beside the run.
fn differing(logged: &Trial, now: &Trial) -> String {
    let (index, before, verdict) = (logged.index, logged.verdict, now.verdict);
    let how = if before == verdict { "has another trace".to_owned() } else { format!("ends as {verdict} now") };
    format!(
        "The log says that test {index} ends as {before}, but the test {how}. The page shows the run as it is now: the driver, the scenario or the \
         software has changed since the campaign."
    )
}

fn answer_all(questions: Receiver<Asked>, mut answer: impl FnMut(Question, Arc<AtomicBool>) -> Result<Answer, Error>) {
    for (question, back, gone) in questions {
        // A page that has gone waits for no answer.
        if !back.is_closed() {
            let answer = answer(question, gone).unwrap_or_else(|error| Answer::Refused(error.to_string()));
            let _ = back.send(answer);
        }
    }
}

fn json(of: &impl Serialize) -> Answer {
    Answer::Json(serde_json::to_string(of).expect("an answer is always JSON"))
}

/// A flag that is set when its owner is dropped.
#[derive(Default)]
struct Leaving(Arc<AtomicBool>);

impl Drop for Leaving {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Desks {
    /// Sends a question to its desk, and waits for the answer. Nobody waits any more once the future is dropped.
    async fn ask(&self, question: Question) -> Answer {
        let desk = match &question {
            Question::Page | Question::Progress | Question::Map(_) => &self.pages,
            Question::Run(_) => &self.runs,
            Question::Errand(_) => &self.errands,
        };
        let leaving = Leaving::default();
        let (back, answer) = oneshot::channel();
        let gone = || Answer::Refused("the viewer ends".to_owned());
        match desk.send((question, back, leaving.0.clone())) {
            Ok(()) => answer.await.unwrap_or_else(|_| gone()),
            Err(_) => gone(),
        }
    }
}
