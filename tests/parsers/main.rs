//! Tests that parsers withstand damaged files: seeds of every format with random mutations.
//!
//! `cargo fuzz` uses the same parsers and seeds. A parser may refuse an input with an error. A parser must not panic,
//! take more than 20 s, or take more than 2 GiB. `PARACOSM_CASES` sets the number of inputs of each parser; the gate
//! runs a few hundred.

#![cfg(feature = "camera")]

#[path = "../../fuzz/src/parsers.rs"]
mod parsers;

use parsers::{PARSERS, Parser};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::fs;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::time::{Duration, Instant};

/// The number of inputs of each parser in the gate.
const CASES: usize = 300;

/// The time and the memory that a parser may take for an input.
const LONGEST: Duration = Duration::from_secs(20);
const MOST_BYTES: u64 = 2 << 30;

/// Texts that parsers may not expect.
const WORDS: [&str; 24] = [
    "",
    "0",
    "-0",
    "-1",
    "1e308",
    "-1e-320",
    "1e999",
    "NaN",
    "inf",
    "null",
    "true",
    "99999999999999999999",
    "[]",
    "{}",
    "\"",
    "'",
    "\\",
    "\u{0}",
    "\u{feff}",
    "é",
    "[[",
    "((((((((",
    "\r\n",
    "\u{1b}[2J",
];

fn mutate(input: &mut Vec<u8>, seeds: &[Vec<u8>], rng: &mut Pcg64) {
    let at = rng.random_range(0..=input.len());
    let end = (at + rng.random_range(0..16)).min(input.len());
    match rng.random_range(0..8) {
        0 => drop(input.drain(at..end)),
        1 => drop(input.splice(at..end, (0..rng.random_range(1..5)).map(|_| rng.random::<u8>()))),
        2 => drop(input.splice(at..end, WORDS[rng.random_range(0..WORDS.len())].bytes())),
        3 if at < input.len() => input[at] ^= 1 << rng.random_range(0..8),
        4 => {
            let part = input[at..end].to_vec();
            drop(input.splice(at..at, part.repeat(rng.random_range(1..40))));
        }
        5 => {
            let other = &seeds[rng.random_range(0..seeds.len())];
            let from = rng.random_range(0..=other.len());
            let to = (from + rng.random_range(0..64)).min(other.len());
            drop(input.splice(at..end, other[from..to].iter().copied()));
        }
        6 => input.truncate(at),
        _ => {
            let digit = (at..input.len()).find(|i| input[*i].is_ascii_digit());
            let Some(from) = digit else { return };
            let to = (from..input.len()).find(|i| !input[*i].is_ascii_digit()).unwrap_or(input.len());
            drop(input.splice(from..to, WORDS[rng.random_range(1..14)].bytes()));
        }
    }
}

fn seeds(parser: &Parser) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(parser.name);
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "{} has no seeds", parser.name);
    files.iter().map(|file| fs::read(file).unwrap()).collect()
}

/// Reads an input and returns the reason why this went wrong.
fn wrong(parser: &Parser, input: &[u8]) -> Option<String> {
    let started = Instant::now();
    let mut ended = Ok(());
    let memory = allocation_counter::measure(|| {
        ended = panic::catch_unwind(AssertUnwindSafe(|| (parser.read)(input)));
    });
    let took = started.elapsed();
    if ended.is_err() {
        return Some("panics".to_owned());
    }
    if took > LONGEST {
        return Some(format!("takes {} s", took.as_secs()));
    }
    (memory.bytes_max > MOST_BYTES).then(|| format!("takes {} bytes", memory.bytes_max))
}

fn withstands(parser: &Parser) {
    let cases = std::env::var("PARACOSM_CASES").map_or(CASES, |cases| cases.parse().expect("a number of cases"));
    let seeds = seeds(parser);
    let mut rng = Pcg64::seed_from_u64(20);
    for case in 0..cases {
        let mut input = seeds[case % seeds.len()].clone();
        // The first inputs are the seeds themselves.
        for _ in 0..if case < seeds.len() { 0 } else { rng.random_range(1..6) } {
            mutate(&mut input, &seeds, &mut rng);
        }
        if let Some(wrong) = wrong(parser, &input) {
            panic!("{} {wrong}, case {case}:\n{}", parser.name, String::from_utf8_lossy(&input));
        }
    }
}

macro_rules! each {
    ($($parser:ident),+ $(,)?) => {
        $(
            #[test]
            fn $parser() {
                withstands(PARSERS.iter().find(|parser| parser.name == stringify!($parser)).unwrap());
            }
        )+

        #[test]
        fn every_parser_has_a_test_a_target_and_seeds() {
            let names: Vec<_> = PARSERS.iter().map(|parser| parser.name).collect();
            assert_eq!(names, [$(stringify!($parser)),+]);
            for name in names {
                let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
                let target = fs::read_to_string(folder.join(format!("fuzz_targets/{name}.rs"))).unwrap();
                assert!(target.contains(&format!("read(\"{name}\", data)")), "{target}");
                assert!(fs::read_to_string(folder.join("Cargo.toml")).unwrap().contains(&format!("name = \"{name}\"")));
            }
        }
    };
}

each!(
    space,
    pict,
    formula,
    points,
    tests,
    trace,
    trials,
    study,
    cameras,
    requirements,
    regression,
    gltf,
    glb,
    answer,
    percepts,
);
