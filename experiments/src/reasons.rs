//! Looks for the reasons that `experiments/drivers.md` states: runs drivers again with other settings, and looks at single tests.

use crate::drivers::TESTS;
use crate::sampling::write_csv;
use crate::{Done, logged, print, scenario};
use indicatif::ProgressBar;
use paracosm::Trial;
use paracosm::campaign::Worker;
use paracosm::generators::Strategy;
use paracosm::space::Values;
use std::path::Path;

/// A scenario, a driver, and a setting of the driver that may be the reason.
type Case = (&'static str, &'static str, Option<(&'static str, f64)>);

/// The scenarios and drivers to look at.
const CASES: [Case; 13] = [
    ("pedestrian-crossing", "planner", None),
    ("pedestrian-crossing", "cruise", None),
    ("ncap-cpfa", "aeb", None),
    ("ncap-cpnco", "cc", Some(("reaction", 0.0))),
    ("ncap-cpnco", "rss", Some(("response", 0.0))),
    ("ncap-cpnco", "rss", Some(("own_lateral", 1.0))),
    ("ncap-ccr", "fsm", None),
    ("ncap-ccrb", "aeb", None),
    ("ncap-ccrb", "fsm", None),
    ("highway-traffic", "cruise", None),
    ("highway-traffic", "rss", None),
    ("highway-traffic", "rss", Some(("own_lateral", 1.0))),
    ("highway-traffic", "reg157", None),
];

/// The test of `highway-traffic` whose speeds are written.
const SHOWN: usize = 4;

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    bar.set_length((CASES.len() * TESTS) as u64);
    let header = |columns: &[&str]| vec![columns.iter().map(|column| (*column).to_owned()).collect::<Vec<String>>()];
    let mut tests = header(&["scenario", "driver", "setting", "test", "verdict", "values"]);
    let mut trucks = header(&["driver", "setting", "test", "truck_ahead_m", "truck_left_m"]);
    let mut speeds = header(&["driver", "setting", "time", "speed"]);
    let mut text = String::new();
    for (name, driver, setting) in CASES {
        let mut study = scenario(name)?.driver(driver).strategy(Strategy::HALTON).budget(TESTS);
        if let Some((setting, value)) = setting {
            study = study.set_driver(setting, value);
        }
        let setting = setting.map_or(String::new(), |(setting, value)| format!("{setting}={value}"));
        let study = study.build()?;
        let log = logged(&study, bar)?;
        for trial in log.trials() {
            let case = [name, driver, &setting, &trial.index.to_string(), &trial.verdict.to_string()];
            tests.push(case.map(str::to_owned).into_iter().chain([written(&trial.test)]).collect());
        }
        let failing: Vec<&Trial> = log.trials().iter().filter(|trial| trial.is_failure()).collect();
        text += &format!("{name:<22}{driver:<10}{setting:<16}{:>4} fail\n", failing.len());
        if name == "highway-traffic" {
            let who = [driver, &setting].map(str::to_owned);
            let mut worker = Worker::new(&study)?;
            for trial in failing {
                let [ahead, left] = truck(&mut worker, trial).map(|metres| format!("{metres:.2}"));
                trucks.push(who.iter().cloned().chain([trial.index.to_string(), ahead, left]).collect());
            }
            let (_, trace) = worker.run(SHOWN, &log.trials()[SHOWN].test);
            let trace = trace.ok_or("a test without a trace")?;
            let speed = trace.signal("car.speed").into_iter().flatten().enumerate().step_by(10);
            let row = |(tick, speed): (usize, f64)| [format!("{:.2}", tick as f64 * trace.dt()), format!("{speed:.2}")];
            speeds.extend(speed.map(|at| who.iter().cloned().chain(row(at)).collect()));
        }
    }
    bar.finish_and_clear();
    write_csv(&out.join("drivers-reasons.csv"), &tests)?;
    write_csv(&out.join("drivers-trucks.csv"), &trucks)?;
    write_csv(&out.join("drivers-speeds.csv"), &speeds)?;
    print(&text)
}

/// Writes the values of a test in one cell.
fn written(test: &Values) -> String {
    test.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(" ")
}

/// Runs a test of `highway-traffic` again, and returns where the middle of the crossing truck is at the end, as seen from
/// the middle of the car: ahead, and to the left.
fn truck(worker: &mut Worker<'_>, trial: &Trial) -> [f64; 2] {
    let mut seen = [f64::NAN; 2];
    worker.watch(trial.index, &trial.test, |run| {
        // The truck is the first body that the scenario places after the car.
        let [car, truck, ..] = run.bodies() else { return };
        seen = car.pose.to_local(truck.pose.position).into();
    });
    seen
}
