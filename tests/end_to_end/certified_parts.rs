//! Certificates within the valid part of a space, and of the rows of an audit: the checker computes each cell itself.

use crate::certificate::{check, claim};
use crate::common::{cover, stderr, stdout, succeeds};
use serde_json::{Value, json};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A space with two continuous parameters that a constraint joins, one that is free, and a discrete parameter that moves the
/// constraint. A second constraint leaves out a row.
const SPACE: &str = "constraints = [\"ego - lead >= 10 + slack\", \"ego * gap >= 40 or lead > 5\", \"slack == 5 implies lane != 'left'\"]\n\
                     [[parameter]]\nname = \"ego\"\ninterval = [20.0, 60.0]\n\
                     [[parameter]]\nname = \"lead\"\ninterval = [0.0, 50.0]\n\
                     [[parameter]]\nname = \"gap\"\ninterval = [1.0, 3.0]\n\
                     [[parameter]]\nname = \"slack\"\nchoice = [0, 5]\n\
                     [[parameter]]\nname = \"lane\"\nchoice = [\"left\", \"right\"]\n";

/// The certificate of the first `n` tests of a strategy in a space.
fn certificate(dir: &Path, space: &str, n: u32, more: &[&str]) -> (Value, Value) {
    fs::write(dir.join("SPACE.toml"), space).unwrap();
    let budget = n.to_string();
    let made = cover(dir, &["generate", "--space", "SPACE.toml", "--strategy", "halton", "--budget", &budget]);
    fs::write(dir.join("tests.csv"), stdout(&succeeds(made))).unwrap();
    let arguments =
        ["estimate", "tests.csv", "--space", "SPACE.toml", "--certificate", "certificate.json", "--format", "json"];
    let printed = stdout(&succeeds(cover(dir, &[&arguments, more].concat())));
    (read(&dir.join("certificate.json")), serde_json::from_str(&printed).unwrap())
}

fn read(file: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap()
}

#[test]
fn a_certificate_within_the_valid_part_proves_what_estimate_prints_and_is_accepted() {
    let dir = tempfile::tempdir().unwrap();
    let (mut certificate, printed) = certificate(dir.path(), SPACE, 60, &[]);
    assert_eq!(certificate["format"], 2);
    for (measure, printed) in
        [("dispersion", &printed["continuous"]["dispersion"]), ("k-wise-dispersion", &printed["k_wise_dispersion"])]
    {
        let claim = claim(&mut certificate, measure);
        let [lower, upper] = ["lower", "upper"].map(|end| claim[end].as_f64().unwrap());
        assert_eq!(lower, printed["lower"]);
        let bound = printed["upper"].as_f64().unwrap();
        assert!(upper >= lower && upper <= bound * (1.0 + 1e-9) && upper < 1.0, "{measure}: {upper} for {bound}");
    }
    if let Some(checked) = check(dir.path(), &certificate) {
        let says = stdout(&succeeds(checked));
        assert!(
            says.contains("of the valid part in all 3 continuous parameters together has been hit: proved"),
            "{says}"
        );
        assert!(says.contains("which constraints exclude") && !says.contains("on trust"), "{says}");
    }
}

#[test]
fn a_valid_part_that_was_tampered_with_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let (whole, _) = certificate(dir.path(), SPACE, 60, &[]);
    let refuses = |says: &str, tamper: &dyn Fn(&mut Value)| {
        let mut certificate = whole.clone();
        tamper(&mut certificate);
        assert!(certificate != whole, "{says}: nothing was changed");
        let Some(checked) = check(dir.path(), &certificate) else { return };
        let message = stderr(&checked);
        assert_eq!(checked.status.code(), Some(1), "{says}: {} {message}", stdout(&checked));
        assert!(message.starts_with("refused: ") && message.contains(says), "`{says}` is missing in: {message}");
    };
    let cells = |certificate: &mut Value| {
        let part = claim(certificate, "dispersion")["witness"]["part"].as_u64().unwrap() as usize;
        certificate["parts"][part]["cells"].as_array_mut().unwrap().clone()
    };
    let with_cells = |certificate: &mut Value, change: &dyn Fn(&mut Vec<Value>)| {
        let mut changed = cells(certificate);
        change(&mut changed);
        let part = claim(certificate, "dispersion")["witness"]["part"].as_u64().unwrap() as usize;
        certificate["parts"][part]["cells"] = json!(changed);
    };
    let first = |cells: &[Value], is: &dyn Fn(&Value) -> bool| cells.iter().position(is).unwrap();
    for (is, becomes, says) in [
        ("undecided", json!("invalid"), "is marked invalid"),
        ("undecided", json!([0, 0]), "is marked valid"),
        ("invalid", json!([0, 0]), "is marked valid"),
        ("invalid", json!([99, 0]), "names no row or place"),
    ] {
        refuses(says, &|certificate| {
            with_cells(certificate, &|cells| {
                let place = first(cells, &|cell| *cell == is);
                cells[place] = becomes.clone();
            });
        });
    }
    refuses("is marked invalid", &|certificate| {
        with_cells(certificate, &|cells| {
            let place = first(cells, &Value::is_array);
            cells[place] = json!("invalid");
        });
    });
    refuses("the cells end too early", &|certificate| with_cells(certificate, &|cells| drop(cells.pop())));
    refuses("the cells go on after their end", &|certificate| {
        with_cells(certificate, &|cells| cells.push(json!("undecided")));
    });
    refuses("is cut along no axis", &|certificate| with_cells(certificate, &|cells| cells[0] = json!(7)));
    // Cells that a checker believes less than it could still make a weaker statement, which the pivots do not prove.
    refuses("valid part", &|certificate| {
        with_cells(certificate, &|cells| {
            cells.iter_mut().filter(|cell| **cell == "invalid").for_each(|cell| *cell = json!("undecided"));
        });
    });
    refuses("is marked valid", &|certificate| certificate["constraints"][0] = json!("ego - lead >= 10.5 + slack"));
    refuses("is marked invalid", &|certificate| certificate["constraints"][0] = json!("ego - lead >= 9.5 + slack"));
    refuses("is marked invalid", &|certificate| certificate["constraints"] = json!([]));
    refuses("cannot be read", &|certificate| certificate["constraints"][0] = json!("ego - lead >= 10 + slack)"));
    refuses("cannot be read", &|certificate| certificate["constraints"][0] = json!("ego - leader >= 10 + slack"));
    refuses("is marked", &|certificate| certificate["continuous"][0]["interval"] = json!([20.0, 61.0]));
    refuses("a row with it keeps the constraints", &|certificate| {
        certificate["constraints"].as_array_mut().unwrap().truncate(2);
    });
    refuses("was not looked at", &|certificate| {
        for part in certificate["parts"].as_array_mut().unwrap() {
            part["rows"] = json!([[1]]);
            for cell in part["cells"].as_array_mut().unwrap().iter_mut().filter(|cell| cell.is_array()) {
                *cell = json!("undecided");
            }
        }
    });
    for measure in ["dispersion", "k-wise-dispersion"] {
        refuses("box from", &|certificate| {
            let claim = claim(certificate, measure);
            claim["upper"] = json!(claim["upper"].as_f64().unwrap() * 0.97);
            (claim["lower"], claim["witness"]) = (json!(0.0), Value::Null);
        });
        refuses("does not show", &|certificate| {
            let claim = claim(certificate, measure);
            claim["lower"] = json!(claim["lower"].as_f64().unwrap() * 1.0001);
        });
        refuses("valid part", &|certificate| {
            let proof = &mut claim(certificate, measure)["proofs"][0];
            proof["pivots"].as_array_mut().unwrap().remove(0);
        });
        refuses("others for their share of a valid part", &|certificate| {
            claim(certificate, measure)["proofs"][0].as_object_mut().unwrap().remove("part");
        });
        refuses("there is no part", &|certificate| claim(certificate, measure)["proofs"][0]["part"] = json!(1000));
    }
    refuses("is inside the witness", &|certificate| {
        let witness = &claim(certificate, "dispersion")["witness"];
        let middle = |axis: usize| {
            let end = |end: &str| witness[end][axis].as_f64().unwrap();
            f64::midpoint(end("lower"), end("upper"))
        };
        let inside = [middle(0), middle(1), middle(2)];
        certificate["claims"].as_array_mut().unwrap().retain(|claim| claim["measure"] == "dispersion");
        certificate["coordinates"][7] = json!(inside);
    });
    refuses("does not show", &|certificate| {
        let witness = &mut claim(certificate, "dispersion")["witness"];
        let [lower, upper] = ["lower", "upper"].map(|end| witness[end][2].as_f64().unwrap());
        witness["upper"][2] = json!(lower + 0.9 * (upper - lower));
    });
}

/// A sequence of numbers that looks random, the same in each run.
struct Numbers(u64);

impl Numbers {
    /// Returns a number below `n`.
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 33) as usize % n
    }
}

/// A term over the parameters `a`, `b`, ..
fn term(numbers: &mut Numbers, dims: usize, depth: usize) -> String {
    let name = |numbers: &mut Numbers| ["a", "b", "c"][numbers.below(dims)].to_owned();
    if depth == 0 {
        return if numbers.below(3) == 0 { format!("{}", numbers.below(30) as f64 / 7.0) } else { name(numbers) };
    }
    let [left, right] = [0; 2].map(|_| term(numbers, dims, depth - 1));
    match numbers.below(14) {
        0..=2 => format!("({left} + {right})"),
        3..=4 => format!("({left} - {right})"),
        5..=6 => format!("{left} * ({right})"),
        7 => format!("({left}) / (1 + abs({right}))"),
        8 => format!("min({left}, {right})"),
        9 => format!("max({left}, -{right})"),
        10 => format!("sqrt(abs({left}))"),
        11 => format!("pow(0.5 + abs({left}), {right})"),
        12 => format!("round({left}) + floor({right}) % 3"),
        _ => format!("atan({left}) - sin({right})"),
    }
}

#[test]
fn random_constraints_and_points_are_certified_as_they_are_measured() {
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    let (mut proved, mut parts) = (0, 0);
    for case in 0..30 {
        let dims = 1 + case % 3;
        let dir = tempfile::tempdir().unwrap();
        let relation = [">=", "<", "!=", "<="][numbers.below(4)];
        let [left, right] = [2, 1].map(|depth| term(&mut numbers, dims, depth));
        let constraint = match numbers.below(4) {
            0 => format!("{left} {relation} {right} or a > 0.8"),
            1 => format!("word == 'x' implies {left} < {right}"),
            2 => format!("a >= 0.3 and {left} > {right} or word != 'y' and a < 0.4"),
            _ => format!("not ({left} > {right} and a <= 0.9)"),
        };
        let mut space =
            format!("constraints = [\"{constraint}\"]\n[[parameter]]\nname = \"word\"\nchoice = [\"x\", \"y\", 3]\n");
        for (name, interval) in ["a", "b", "c"].into_iter().zip(["0.0, 1.0", "-1.3, 2.1", "0.1, 0.7"]).take(dims) {
            write!(space, "[[parameter]]\nname = \"{name}\"\ninterval = [{interval}]\n").unwrap();
        }
        fs::write(dir.path().join("SPACE.toml"), space).unwrap();
        let made = ["generate", "--space", "SPACE.toml", "--budget", "24", "--strategy", "halton"];
        let made = cover(dir.path(), &made);
        if !made.status.success() {
            // No test keeps the constraint.
            continue;
        }
        fs::write(dir.path().join("tests.csv"), stdout(&made)).unwrap();
        let given = [
            "estimate",
            "tests.csv",
            "--space",
            "SPACE.toml",
            "--certificate",
            "c.json",
            "--format",
            "json",
            "--measures",
        ];
        let printed = stdout(&succeeds(cover(dir.path(), &[&given[..], &["dispersion,k-wise-dispersion"]].concat())));
        let printed: Value = serde_json::from_str(&printed).unwrap();
        let mut certificate = read(&dir.path().join("c.json"));
        parts += certificate["parts"].as_array().map_or(0, Vec::len);
        for (measure, printed) in
            [("dispersion", &printed["continuous"]["dispersion"]), ("k-wise-dispersion", &printed["k_wise_dispersion"])]
        {
            let claim = claim(&mut certificate, measure);
            assert_eq!(claim["lower"], printed["lower"], "{constraint}");
            let [upper, bound] = [claim, printed].map(|of| of["upper"].as_f64().unwrap());
            assert!(upper <= bound * (1.0 + 1e-9) || bound >= 1.0 || upper >= 1.0, "{constraint}: {upper} for {bound}");
            proved += usize::from(upper < 1.0);
        }
        let Some(checked) = check(dir.path(), &certificate) else { return };
        assert!(checked.status.success(), "{constraint}: {}", stderr(&checked));
    }
    assert!(proved > 20 && parts > 40, "{proved} claims are proved within {parts} parts");
}
