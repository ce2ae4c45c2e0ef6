//! `--draw` of `describe` and `replay`: worlds and runs as pictures.

use crate::common::{fuzz, golden, refused, stderr, stdout, succeeds};
use std::fs::{self, File};
use std::path::Path;

/// A small campaign in `dir/out`; the index of its first failing test.
fn campaign(dir: &Path) -> String {
    succeeds(fuzz(dir, &["--budget", "10", "--out", "out"]));
    let trials = fs::read_to_string(dir.join("out/trials.jsonl")).unwrap();
    trials.lines().position(|line| line.contains("\"fail\"")).expect("a test fails").to_string()
}

fn png_size(path: &Path) -> (u32, u32) {
    let mut reader = png::Decoder::new(std::io::BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.iter().any(|part| *part != pixels[0]), "it is not all of one colour");
    (info.width, info.height)
}

#[test]
fn a_world_is_the_same_picture_everywhere() {
    let dir = tempfile::tempdir().unwrap();
    let drawn = succeeds(fuzz(dir.path(), &["describe", "pedestrian-crossing", "--draw", "world.svg"]));
    assert_eq!(stdout(&drawn), "");
    assert!(stderr(&drawn).contains("world.svg"), "{}", stderr(&drawn));
    golden("world.svg", &fs::read_to_string(dir.path().join("world.svg")).unwrap());
    succeeds(fuzz(dir.path(), &["describe", "--draw", "world.png"]));
    let (width, height) = png_size(&dir.path().join("world.png"));
    assert!(width == 2400 && height < width, "{width} x {height}");
}

#[test]
fn a_run_is_the_same_picture_everywhere() {
    let dir = tempfile::tempdir().unwrap();
    let index = campaign(dir.path());
    succeeds(fuzz(dir.path(), &["replay", "out", &index, "--draw", "run.svg"]));
    golden("run.svg", &fs::read_to_string(dir.path().join("run.svg")).unwrap());
    succeeds(fuzz(dir.path(), &["replay", "out", &index, "--draw", "run.PNG"]));
    assert_eq!(png_size(&dir.path().join("run.PNG")).0, 2400);
}

#[test]
fn a_film_of_a_run_is_an_animated_gif_that_ends_with_the_contact() {
    let dir = tempfile::tempdir().unwrap();
    let index = campaign(dir.path());
    succeeds(fuzz(dir.path(), &["replay", "out", &index, "--draw", "run.gif"]));
    let file = dir.path().join("run.gif");
    assert!(fs::metadata(&file).unwrap().len() < 100_000, "it is small");
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut film = options.read_info(File::open(&file).unwrap()).unwrap();
    let (width, height) = (film.width(), film.height());
    assert!(width == 800 && (60..600).contains(&height), "{width} x {height}");
    let mut delays = Vec::new();
    let mut last_changes = Vec::new();
    while let Some(frame) = film.read_next_frame().unwrap() {
        let whole = (frame.left, frame.top, frame.width, frame.height) == (0, 0, width, height);
        assert_eq!(whole, delays.is_empty(), "only the first frame is whole");
        delays.push(frame.delay);
        last_changes = frame.buffer.to_vec();
    }
    // One frame for every tenth of a second of the run; the last one stays for a while.
    let trial = fs::read_to_string(dir.path().join("out/trials.jsonl")).unwrap();
    let trial: serde_json::Value = serde_json::from_str(trial.lines().nth(index.parse().unwrap()).unwrap()).unwrap();
    let tenths = trial["ticks"].as_u64().unwrap() / 10;
    assert!(delays.len().abs_diff(tenths as usize) <= 2, "{} frames, {tenths} tenths of a second", delays.len());
    let (last, others) = delays.split_last().unwrap();
    assert!(others.iter().all(|delay| *delay == 10) && *last > 100, "{delays:?}");
    let star = |pixel: &[u8]| pixel[3] > 0 && pixel[0] > 220 && pixel[1] > 200 && pixel[2] < 100;
    assert!(last_changes.chunks_exact(4).filter(|pixel| star(pixel)).count() > 50, "the star is on the last frame");
}

#[test]
fn the_same_film_is_the_same_file() {
    let dir = tempfile::tempdir().unwrap();
    let index = campaign(dir.path());
    for file in ["a.gif", "b.gif"] {
        succeeds(fuzz(dir.path(), &["replay", "out", &index, "--draw", file]));
    }
    assert!(fs::read(dir.path().join("a.gif")).unwrap() == fs::read(dir.path().join("b.gif")).unwrap());
}

#[test]
fn a_picture_replaces_what_was_drawn_before_and_has_an_ending_that_is_known() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path());
    for command in [&["describe", "pedestrian-crossing"][..], &["replay", "out", "0"]] {
        let drawing = |file: &str| fuzz(dir.path(), &[command, &["--draw", file]].concat());
        fs::write(dir.path().join("there.svg"), "older").unwrap();
        succeeds(drawing("there.svg"));
        assert!(fs::read_to_string(dir.path().join("there.svg")).unwrap().starts_with("<svg"));
        refused(&drawing("picture.jpg"), &["picture.jpg", "`.jpg`", "expected .svg or .png"]);
        refused(&drawing("picture.svgg"), &["`.svgg`", "svg"]);
        refused(&drawing("picture"), &["picture", "no ending", ".svg"]);
        refused(&drawing("nowhere/picture.svg"), &["--draw nowhere/picture.svg", "the folder nowhere does not exist"]);
    }
    refused(&fuzz(dir.path(), &["describe", "--draw", "world.gif"]), &["`.gif`", "expected .svg or .png"]);
    fs::remove_file(dir.path().join("out/failure-map.svg")).unwrap();
    let own = fuzz(dir.path(), &["replay", "out", "0", "--draw", "out/failure-map.svg"]);
    refused(&own, &["failure-map.svg", "belongs to campaigns"]);
    assert!(!dir.path().join("picture.svgg").exists());
}
