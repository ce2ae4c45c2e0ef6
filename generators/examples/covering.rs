//! Sizes and times of covering arrays beside what is published: `covering [MODEL[@K] ...]`, all by default.
//! `cargo run --release -p paracosm-generators --example covering`
//!
//! With `OPTIMISE=SECONDS` the arrays are made smaller for so long; `SEED` is the seed of the search, 0 by default.
//!
//! The constrained models are read from `../shared/reference/covering_models.json` beside the repository, or from
//! `$PARACOSM_REFERENCE`, and left out where there is none.

use paracosm_coverage::Deadline;
use paracosm_coverage::kwise::kwise_coverage;
use paracosm_generators::covering::{CoveringRequest, covering_array, optimise};
use paracosm_space::rules::{Clause, Literal, Rules};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The models that run without arguments.
const ALL: &str = "tcas_free@2 tcas_free@3 tcas_free@4 tcas_free@5 spinv@2 gcc@2 apache@2 spins@3 apache@3 gcc@3 spinv@3 \
                   bugzilla@3 spins@4 UNIFORM_ALL_18@3 UNIFORM_ALL_18@4 2^100@3";

fn main() {
    let wanted: Vec<String> = match std::env::args().skip(1).collect::<Vec<_>>() {
        none if none.is_empty() => ALL.split_whitespace().map(str::to_owned).collect(),
        some => some,
    };
    let optimised =
        std::env::var("OPTIMISE").ok().map(|seconds| Duration::from_secs_f64(seconds.parse().expect("seconds")));
    let models = models();
    println!(
        "{:<20} {:>6} {:>8} {:>6} {:>6} {:>9} {:>8}",
        "model", "size", "CPU s", "bound", "best", "coverage", "check s"
    );
    for name in &wanted {
        let (model, k) = name.rsplit_once('@').expect("MODEL@K");
        let Some(model) = models.iter().find_map(|models| models.get(model)) else {
            println!("{name:<20} is not here");
            continue;
        };
        let rules = rules(model);
        let k: usize = k.parse().expect("a strength");
        let seed = std::env::var("SEED").map_or(0, |seed| seed.parse().expect("a number"));
        let request = CoveringRequest { seed, ..CoveringRequest::new(&rules, k) };
        let begun = cpu_seconds();
        let array = covering_array(&request).expect("the models are sound");
        let seconds = cpu_seconds() - begun;
        let array = match optimised {
            None => array,
            Some(limit) => {
                let begun = Instant::now();
                let progress = |size| eprint!("{size} ({:.1} s) ", begun.elapsed().as_secs_f64());
                let array = optimise(&request, array, Deadline::after(limit), &progress);
                eprintln!();
                array
            }
        };
        let begun = cpu_seconds();
        let coverage = kwise_coverage(&rules, k, array.rows.iter().map(Vec::as_slice)).expect("the models are sound");
        let checked = cpu_seconds() - begun;
        let best = &model["strengths"][k.to_string()]["best_known"];
        let complete = coverage.covered == coverage.valid && coverage.invalid.is_empty();
        println!(
            "{name:<20} {:>6} {seconds:>8.3} {:>6} {:>6} {:>9} {checked:>8.3} {}",
            array.rows.len(),
            array.lower_bound,
            best.to_string(),
            if complete { "complete" } else { "BROKEN" },
            coverage.valid,
        );
    }
}

/// The models of the files that are here.
fn models() -> Vec<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let reference =
        std::env::var_os("PARACOSM_REFERENCE").map_or_else(|| root.join("../shared/reference"), PathBuf::from);
    let files = [root.join("tests/data"), reference].map(|folder| folder.join("covering_models.json"));
    let texts = files.iter().filter_map(|file| std::fs::read_to_string(file).ok());
    texts.map(|text| serde_json::from_str::<Value>(&text).expect("JSON")["models"].clone()).collect()
}

/// A model whose constraints are lists of [parameter, level, 1 for is or 0 for is not].
fn rules(model: &Value) -> Rules {
    let number = |value: &Value| value.as_u64().expect("a number") as usize;
    let list = |value: &Value| value.as_array().expect("a list").clone();
    let levels: Vec<usize> = list(&model["levels"]).iter().map(number).collect();
    let literal = |literal: &Value| {
        let (parameter, level) = (number(&literal[0]), number(&literal[1]));
        let is = number(&literal[2]) == 1;
        Literal { parameter, levels: (0..levels[parameter]).filter(|&other| (other == level) == is).collect() }
    };
    let clause = |clause: &Value| vec![Clause { literals: list(clause).iter().map(literal).collect() }];
    let constraints: Vec<Vec<Clause>> = list(&model["constraints"]).iter().map(clause).collect();
    Rules::new(&levels, &constraints).expect("the models are sound")
}

/// The processor time of all threads so far; wall time where the system does not tell.
fn cpu_seconds() -> f64 {
    thread_local!(static BEGUN: Instant = Instant::now());
    let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let of = |task: std::fs::DirEntry| {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    };
    match tasks.filter_map(of).sum::<f64>() {
        0.0 => BEGUN.with(Instant::elapsed).as_secs_f64(),
        nanoseconds => nanoseconds * 1e-9,
    }
}
