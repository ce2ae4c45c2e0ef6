//! Behavioural cloning: makes the networks that come with the software.
//!
//! A course has tests in which an expert drives. A network learns from the images and the expert's controls. Then the
//! network drives, and learns from the controls that the expert would have given. Everything follows from seeds: the
//! tests, the disturbances, the first weights and the order of the lessons.

mod courses;
pub mod exam;
mod teacher;

use courses::SEEDS;
pub use courses::{Course, FOLLOW, LOOP, STOP, driven};

use crate::{Done, logged, print, write};
use indicatif::ProgressBar;
use paracosm::engine::driver;
use paracosm::{Error, Study, Trial};
use paracosm_neural::learn::{Learner, Lesson};
use paracosm_neural::{Model, Pilot};
use std::fs;
use std::path::Path;
use std::time::Instant;
use teacher::{Notes, Teacher};

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// The columns of the table of a network's progress.
const PROGRESS: &str = "seed,round,epoch,lessons,loss,held_out_steering,held_out_throttle";

/// Teaches the networks of a course and writes them to a folder, each with a table of its progress. A network that is in
/// the folder is not taught again, so that a study that was stopped goes on with the next network.
pub fn run(course: &Course, out: &Path, bar: &ProgressBar) -> Done {
    for seed in SEEDS {
        let network = out.join(format!("{}-{seed}.onnx", course.name));
        if network.exists() {
            print(&format!("{} is there, and is not taught again\n", network.display()))?;
        } else {
            teach(course, seed, &network, bar)?;
        }
    }
    let mut progress = PROGRESS.to_owned() + "\n";
    for seed in SEEDS {
        let path = out.join(format!("{}-{seed}.csv", course.name));
        let table = fs::read_to_string(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        progress.extend(table.split_inclusive('\n').skip(1));
    }
    write(&out.join(format!("learning-{}.csv", course.name)), progress)
}

/// Teaches a network and writes it to a file, with a table of its progress beside it.
fn teach(course: &Course, network: u64, path: &Path, bar: &ProgressBar) -> Done {
    let began = Instant::now();
    let mut lessons: Vec<Lesson> = Vec::new();
    let mut learner = Learner::new(course.recipe(network));
    let mut contents = Vec::new();
    let mut pupil = None;
    let mut table = vec![PROGRESS.to_owned()];
    for (round, plan) in course.rounds.iter().enumerate() {
        let said = |text: String| bar.suspend(|| eprintln!("[{:>4.0} s] {text}", began.elapsed().as_secs_f64()));
        let driving = if pupil.is_some() { "the network drives" } else { "the expert drives" };
        said(format!("network {network}, round {}: {driving} in {} tests", round + 1, plan.tests));
        lessons.extend(taught(
            course,
            (network, round),
            pupil.take(),
            lessons.last().map_or(0, |last| last.run + 1),
            bar,
        )?);
        said(format!("round {}: {} lessons, {} epochs", round + 1, lessons.len(), plan.epochs));
        learner.learn(&lessons, plan.epochs, |progress| {
            let (epoch, loss) = (progress.epoch, progress.loss);
            let error = progress.held_out.map_or(String::new(), |[steering, throttle]| {
                format!("; held out: steering {steering:.4}, throttle {throttle:.4}")
            });
            said(format!("  epoch {epoch:>2}: loss {loss:.5}{error}"));
            let [steering, throttle] =
                [0, 1].map(|i| progress.held_out.map_or(String::new(), |error| error[i].to_string()));
            table.push(format!("{network},{},{epoch},{},{loss},{steering},{throttle}", round + 1, lessons.len()));
        });
        contents = learner.onnx(&course.story());
        pupil = Some(Pilot::new(Model::read(&contents)?));
    }
    write(&path.with_extension("csv"), table.join("\n") + "\n")?;
    // A network that is there is complete, wherever the study is stopped.
    let part = path.with_extension("part");
    write(&part, contents)?;
    fs::rename(&part, path)?;
    print(&format!("{}-{network}: {:.1} min\n", course.name, began.elapsed().as_secs_f64() / 60.0))
}

/// Returns the lessons noted in a round of a network's course. The runs are numbered from `first` on.
fn taught(
    course: &Course,
    (network, round): (u64, usize),
    pupil: Option<Pilot>,
    first: usize,
    bar: &ProgressBar,
) -> Result<Vec<Lesson>, Failure> {
    let notes = Notes::default();
    // No two networks and no two rounds have the same tests.
    let seed = 10 * (network - 1) + round as u64 + 1;
    let (taken, resolution) = (notes.clone(), course.resolution);
    // The network's own mistakes disturb the car enough.
    let disturbance = if pupil.is_some() { [0.0; 2] } else { course.disturbance };
    let expert = || driver::find("expert").and_then(|kind| kind.build(&[])).expect("there is an expert");
    let study = course.study(seed, course.rounds[round].tests)?.own_driver("teacher", move || {
        Box::new(Teacher::new(expert(), pupil.clone(), resolution, disturbance, seed, taken.clone()))
    });
    let study = study.build()?;
    trials(&study, bar)?;
    drop(study);
    let mut runs = std::mem::take(&mut *notes.lock().expect("nobody panics while taking notes"));
    // Runs are sorted by their contents, because the order in which tests end is random.
    let key = |run: &Vec<Lesson>| -> Vec<u32> {
        run.iter().flat_map(|lesson| [lesson.speed, lesson.control[0], lesson.control[1]]).map(f32::to_bits).collect()
    };
    runs.sort_by_cached_key(key);
    let numbered = runs.into_iter().zip(first..);
    Ok(numbered.flat_map(|(run, number)| run.into_iter().map(move |lesson| Lesson { run: number, ..lesson })).collect())
}

/// Runs the tests of a study.
pub fn trials(study: &Study, bar: &ProgressBar) -> Result<Vec<Trial>, Error> {
    bar.set_length(study.sampling().budget as u64);
    bar.set_position(0);
    Ok(logged(study, bar)?.trials().to_vec())
}
