//! Networks at the wheel, by the command line; and what a program says that was built without them.

use crate::common::{fuzz, refused};

#[cfg(not(feature = "neural"))]
#[test]
fn a_program_without_networks_says_how_to_build_one_with_them() {
    let dir = tempfile::tempdir().expect("a folder");
    for driver in ["cnn", "mine.onnx"] {
        let output = fuzz(dir.path(), &["follow-leader", "--driver", driver, "--budget", "1"]);
        refused(&output, &[driver, "cargo build --release --features neural"]);
    }
}

#[cfg(feature = "neural")]
mod with_networks {
    use super::*;
    use crate::common::{stderr, stdout, succeeds};
    use std::fs;
    use std::path::Path;

    /// A field of a protobuf message that holds bytes: a text, or another message.
    fn field(number: u8, contents: &[u8]) -> Vec<u8> {
        let mut length = contents.len();
        let mut bytes = vec![number << 3 | 2];
        while length >= 128 {
            bytes.push((length % 128) as u8 | 128);
            length /= 128;
        }
        bytes.push(length as u8);
        [bytes, contents.to_vec()].concat()
    }

    /// A field that holds a small number.
    fn number(field: u8, value: u8) -> Vec<u8> {
        vec![field << 3, value]
    }

    fn node(operation: &str, inputs: &[&str], output: &str) -> Vec<u8> {
        let inputs: Vec<u8> = inputs.iter().flat_map(|input| field(1, input.as_bytes())).collect();
        field(1, &[inputs, field(2, output.as_bytes()), field(4, operation.as_bytes())].concat())
    }

    fn tensor(name: &str, shape: [u8; 2], numbers: &[f32]) -> Vec<u8> {
        let raw: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let shape = shape.map(|size| number(1, size)).concat();
        field(5, &[shape, number(2, 1), field(8, name.as_bytes()), field(9, &raw)].concat())
    }

    fn value(which: u8, name: &str, shape: &[u8]) -> Vec<u8> {
        let shape: Vec<u8> = shape.iter().flat_map(|size| field(1, &number(1, *size))).collect();
        let of_tensor = field(1, &[number(1, 1), field(2, &shape)].concat());
        field(which, &[field(1, name.as_bytes()), field(2, &of_tensor)].concat())
    }

    /// An ONNX file, byte by byte: a driver that goes straight on and gives as much power, whatever it sees.
    fn model(throttle: f32) -> Vec<u8> {
        answering(&[0.0, throttle])
    }

    /// One that always answers with these numbers.
    fn answering(numbers: &[f32]) -> Vec<u8> {
        let count = numbers.len() as u8;
        let graph = [
            node("GlobalAveragePool", &["image"], "mean"),
            node("Flatten", &["mean"], "colours"),
            node("Gemm", &["colours", "weights", "bias"], "control"),
            field(2, b"steady"),
            tensor("weights", [3, count], &vec![0.0; 3 * numbers.len()]),
            tensor("bias", [1, count], numbers),
            value(11, "image", &[1, 3, 16, 24]),
            value(12, "control", &[1, count]),
        ];
        [number(1, 8), field(8, &[field(1, b""), number(2, 13)].concat()), field(7, &graph.concat())].concat()
    }

    fn run(dir: &Path, arguments: &[&str]) -> std::process::Output {
        let common = ["follow-leader", "--budget", "3", "--set", "leader_speed=20"];
        fuzz(dir, &[&common[..], arguments].concat())
    }

    #[test]
    fn a_users_network_drives_and_is_known_by_its_hash() {
        let dir = tempfile::tempdir().expect("a folder");
        let dir = dir.path();
        fs::write(dir.join("steady.onnx"), model(0.1)).expect("a file");
        let open = ["--open", "light", "--driver", "steady.onnx", "--out", "out"];
        succeeds(run(dir, &open));
        let campaign: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(dir.join("out/campaign.json")).expect("a file")).expect("JSON");
        assert_eq!(campaign["driver"]["name"], "steady.onnx");
        assert_eq!(campaign["driver"]["network"]["hash"].as_str().map(str::len), Some(32));
        let replayed = succeeds(fuzz(dir, &["replay", "out", "1"]));
        assert!(stdout(&replayed).contains("pass") || stderr(&replayed).contains("pass"));
        // Another network under the same name is not the one that was tested.
        fs::write(dir.join("steady.onnx"), model(0.2)).expect("a file");
        refused(&fuzz(dir, &["replay", "out", "1"]), &["steady.onnx", "hash"]);
        refused(&run(dir, &[&open[..], &["--resume"]].concat()), &["different"]);
    }

    #[test]
    fn what_is_no_network_is_refused_with_a_reason() {
        let dir = tempfile::tempdir().expect("a folder");
        let dir = dir.path();
        fs::write(dir.join("none.onnx"), "no network").expect("a file");
        refused(&run(dir, &["--open", "fog", "--driver", "none.onnx"]), &["none.onnx", "ONNX"]);
        refused(&run(dir, &["--open", "fog", "--driver", "missing.onnx"]), &["cannot read missing.onnx"]);
        fs::write(dir.join("three.onnx"), answering(&[0.0; 3])).expect("a file");
        let three = run(dir, &["--open", "fog", "--driver", "three.onnx"]);
        refused(&three, &["three.onnx", "the output is", "1,3", "expected 1 x 2"]);
        fs::write(dir.join("steady.onnx"), model(0.1)).expect("a file");
        let set = ["--open", "fog", "--driver", "steady.onnx", "--set", "driver.ttc=1"];
        refused(&run(dir, &set), &["network", "`ttc`"]);
        refused(&fuzz(dir, &["cut-in", "--driver", "cnn", "--budget", "1"]), &["`cut-in`", "MODEL.onnx"]);
    }

    #[test]
    fn the_network_that_comes_along_drives_the_same_on_any_number_of_threads() {
        let dir = tempfile::tempdir().expect("a folder");
        let dir = dir.path();
        let log = |jobs: &str| {
            let study = ["--open", "fog", "--open", "light", "--driver", "cnn", "--jobs", jobs, "--out", jobs];
            succeeds(run(dir, &study));
            fs::read_to_string(dir.join(jobs).join("trials.jsonl")).expect("a log")
        };
        assert_eq!(log("1"), log("2"));
        assert!(stdout(&succeeds(fuzz(dir, &["replay", "2", "1", "--format", "json"]))).contains("hash"));
    }

    #[test]
    fn a_failure_of_a_network_shrinks_to_a_sentence() {
        let dir = tempfile::tempdir().expect("a folder");
        let dir = dir.path();
        fs::write(dir.join("steady.onnx"), model(0.3)).expect("a file");
        // It sees neither the leader nor the fog, and so runs into the one at whatever speed the other allows.
        let open = ["--open", "gap=10..60", "--open", "fog", "--set", "leader_speed=5", "--driver", "steady.onnx"];
        succeeds(fuzz(dir, &[&["follow-leader", "--budget", "2", "--out", "out"][..], &open].concat()));
        let shrunk = stdout(&succeeds(fuzz(dir, &["shrink", "out", "0", "--format", "json"])));
        assert!(shrunk.contains("violates no-collision with everything nominal"), "{shrunk}");
    }
}
