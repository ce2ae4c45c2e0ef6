//! What must not change while the house is rebuilt: every file of the folders of 39 campaigns, byte for byte. This test lives
//! as long as the rebuilding takes.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use xxhash_rust::xxh3::xxh3_128;

const SCENARIOS: [&str; 13] = [
    "pedestrian-crossing",
    "follow-leader",
    "oncoming-distractor",
    "t-loop",
    "grid-traffic",
    "roundabout-entry",
    "cut-in",
    "cut-out",
    "ncap-cpna",
    "ncap-cpfa",
    "ncap-cpnco",
    "ncap-ccr",
    "highway-traffic",
];

const STRATEGIES: [&str; 3] = ["halton", "auto", "greedy"];

#[test]
fn the_folders_of_campaigns_are_what_they_were() {
    let dir = tempfile::tempdir().unwrap();
    let mut found = BTreeMap::new();
    for scenario in SCENARIOS {
        for strategy in STRATEGIES {
            let out = format!("{scenario}.{strategy}");
            let mut command = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
            command.args([
                scenario,
                "--strategy",
                strategy,
                "--budget",
                "100",
                "--out",
                &out,
                "-q",
                "--format",
                "json",
            ]);
            let output = command.current_dir(&dir).output().unwrap();
            assert!(output.status.success(), "{out}: {}", String::from_utf8_lossy(&output.stderr));
            for entry in fs::read_dir(dir.path().join(&out)).unwrap() {
                let path = entry.unwrap().path();
                let name = format!("{out}/{}", path.file_name().unwrap().to_str().unwrap());
                found.insert(name, format!("{:032x}", xxh3_128(&fs::read(path).unwrap())));
            }
        }
    }
    let found: String = found.iter().map(|(name, hash)| format!("{hash} {name}\n")).collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/frozen.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&file, found).unwrap();
        return;
    }
    let expected = fs::read_to_string(&file).unwrap();
    let lost: Vec<&str> = expected.lines().filter(|line| !found.lines().any(|other| other == *line)).collect();
    let new: Vec<&str> = found.lines().filter(|line| !expected.lines().any(|other| other == *line)).collect();
    assert!(lost.is_empty() && new.is_empty(), "was:\n{}\nis:\n{}", lost.join("\n"), new.join("\n"));
}
