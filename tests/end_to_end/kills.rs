//! Campaigns that are killed at any moment and continued: all files equal the files of a campaign that was not
//! killed.

use paracosm::generators::Strategy;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// The number of times that a campaign of each strategy is killed.
fn kills() -> usize {
    std::env::var("PARACOSM_KILLS").map_or(1, |kills| kills.parse().expect("a number of kills"))
}

fn start(dir: &Path, out: &str, strategy: Strategy, arguments: &[&str]) -> Child {
    let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let program = program.args(["--strategy", strategy.name(), "--budget", "48", "--out", out, "-q"]).args(arguments);
    program.current_dir(dir).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts")
}

/// Returns the contents of the files in a folder by their names.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap())).collect()
}

#[test]
fn a_killed_and_continued_campaign_of_any_strategy_has_the_files_of_a_whole_campaign() {
    let mut rng = Pcg64::seed_from_u64(7);
    for strategy in Strategy::all() {
        let dir = tempfile::tempdir().unwrap();
        let began = Instant::now();
        assert!(start(dir.path(), "whole", strategy, &[]).wait().unwrap().success(), "{strategy}");
        let took = began.elapsed();
        let whole = files(&dir.path().join("whole"));
        let mut left = kills();
        while left > 0 {
            let _ = fs::remove_dir_all(dir.path().join("cut"));
            // A kill may come before the folder exists.
            for _ in 0..left.min(5) {
                let mut child = start(dir.path(), "cut", strategy, &["--resume"]);
                thread::sleep(took.mul_f64(rng.random_range(0.0..1.1)).min(Duration::from_secs(20)));
                child.kill().unwrap();
                child.wait().unwrap();
                left -= 1;
            }
            assert!(start(dir.path(), "cut", strategy, &["--resume"]).wait().unwrap().success(), "{strategy}");
            let cut = files(&dir.path().join("cut"));
            let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
            assert_eq!(names(&cut), names(&whole), "{strategy}");
            let differ: Vec<_> = cut.iter().filter(|(name, contents)| whole[*name] != **contents).collect();
            assert!(differ.is_empty(), "{strategy}: {:?}", differ.iter().map(|(name, _)| name).collect::<Vec<_>>());
        }
    }
}
