//! The pedestrian study of Figure 9 from both sides, with a pedestrian who accelerates, and with other noise of the sensor.
//!
//! In the paper, the pedestrian comes from the far side and has the walking speed at once. Whether faster pedestrians lead to more
//! collisions depends on both.

use crate::sampling::write_csv;
use crate::{Done, fig9, logged, print, scenario};
use indicatif::ProgressBar;
use paracosm::generators::Strategy;
use paracosm::space::Value;
use std::path::Path;

/// The number of tests for each side and acceleration.
const TESTS: usize = 4096;
const SIDES: [&str; 2] = ["far", "near"];
/// The accelerations in m/s²: at once, and as adults reach 8 km/h and 5 km/h in the protocols of Euro NCAP.
const ACCELERATIONS: [f64; 3] = [1000.0, 1.65, 0.96];
/// The seeds of the sensor's noise.
const NOISES: u32 = 8;

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let noisy = *fig9::SIZES.last().expect("there is a size");
    bar.set_length((TESTS * SIDES.len() * ACCELERATIONS.len() + noisy * NOISES as usize) as u64);
    let mut rows = vec![["acceleration", "side", "speed", "fails"].map(str::to_owned).to_vec()];
    for acceleration in ACCELERATIONS {
        for side in SIDES {
            let study = scenario("pedestrian-crossing")?.fix("side", side).fix("acceleration", acceleration);
            let log = logged(&study.strategy(Strategy::SOBOL).budget(TESTS).build()?, bar)?;
            for trial in log.trials() {
                let speed = trial.test.get("speed").and_then(Value::number).expect("the study varies the speed");
                let fails = u8::from(trial.is_failure()).to_string();
                rows.push(vec![acceleration.to_string(), side.to_owned(), format!("{speed:.3}"), fails]);
            }
        }
    }
    write_csv(&out.join("fig9-sides.csv"), &rows)?;

    let mut rows = vec![["seed", "tests", "failing"].map(str::to_owned).to_vec()];
    for seed in 1..=NOISES {
        let study = scenario("pedestrian-crossing")?.set_driver("seed", f64::from(seed)).budget(noisy).build()?;
        let failing = logged(&study, bar)?.trials().iter().filter(|trial| trial.is_failure()).count();
        rows.push([seed as usize, noisy, failing].map(|number| number.to_string()).to_vec());
    }
    bar.finish_and_clear();
    write_csv(&out.join("fig9-noise.csv"), &rows)?;
    print(&rows.iter().map(|row| row.join(",") + "\n").collect::<String>())
}
