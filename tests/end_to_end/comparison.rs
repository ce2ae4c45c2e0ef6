//! `paracosm-cover compare`: what it writes, that it is right, and what it refuses.

use crate::common::{cover, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A tiny study in `dir/NAME`.
fn compare(dir: &Path, name: &str, more: &[&str]) -> String {
    let study = ["compare", "--strategies", "random,halton,fibonacci,lhs", "--dims", "3,2", "--budgets", "24,8"];
    let arguments = [&study, ["--seeds", "6", "--out", name].as_slice(), more].concat();
    stdout(&succeeds(cover(dir, &arguments)))
}

/// The rows of a CSV, each by the names of its columns.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
    let header: Vec<String> = lines.next().unwrap().collect();
    lines.map(|line| header.iter().cloned().zip(line).collect()).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} is `{}`", row[column]))
}

fn is(row: &BTreeMap<String, String>, strategy: &str, d: &str, n: &str) -> bool {
    row["strategy"] == strategy && row["d"] == d && row["n"] == n
}

#[test]
fn a_comparison_has_a_row_for_every_set_and_a_figure_for_every_measure_and_dimension() {
    let dir = tempfile::tempdir().unwrap();
    let printed = compare(dir.path(), "out", &["--measures", "dispersion,star,k-wise-dispersion", "--format", "table"]);
    for words in ["dispersion, d = 2: median over 6 seeds", "star discrepancy, d = 3", "2-wise dispersion, d = 3"] {
        assert!(printed.contains(words), "`{words}` is missing in:\n{printed}");
    }
    assert!(!printed.contains("2-wise dispersion, d = 2"), "in two dimensions it is the dispersion:\n{printed}");
    let out = dir.path().join("out");
    let mut names: Vec<_> =
        fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let figures = ["dispersion-d2", "dispersion-d3", "k-wise-dispersion-d3", "star-d2", "star-d3"];
    let mut expected: Vec<String> =
        figures.iter().flat_map(|figure| ["png", "svg"].map(|end| format!("{figure}.{end}"))).collect();
    expected.extend(["sets.csv", "slopes.csv", "summary.csv", "table.tex"].map(str::to_owned));
    expected.sort();
    assert_eq!(names, expected);
    // Four strategies in 2 and three in 3 dimensions, two budgets, six seeds; halton and fibonacci are plain as well.
    let sets = rows(&out.join("sets.csv"));
    assert_eq!(sets.len(), (4 + 3) * 2 * 6 + 2 * (2 + 1));
    assert_eq!(sets.iter().filter(|set| set["seed"].is_empty()).count(), 2 * (2 + 1));
    assert!(sets.iter().all(|set| set["exact"] == "true" && set["star_lower"] == set["star_upper"]));
    assert!(sets.iter().all(|set| set["k-wise-dispersion_lower"].is_empty() == (set["d"] == "2")));
    assert!(!sets.iter().any(|set| set["strategy"] == "fibonacci" && set["d"] == "3"));
}

#[test]
fn points_in_files_are_compared_like_those_of_a_strategy() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("sets")).unwrap();
    let generate = |seed: &str, to: &str| {
        let arguments = ["generate", "--dims", "2", "--strategy", "halton", "--budget", "24", "--seed", seed];
        let csv = stdout(&succeeds(cover(dir.path(), &arguments)));
        // As `numpy.savetxt` writes it.
        let plain = csv.lines().skip(1).map(|line| line.replace(',', " ") + "\n").collect::<String>();
        fs::write(dir.path().join(to), plain).unwrap();
    };
    ["1", "2", "3"].into_iter().for_each(|seed| generate(seed, &format!("sets/{seed}.txt")));
    let study = ["compare", "--strategies", "halton,lhs,mine=sets/*.txt", "--dims", "2", "--budgets", "24,8"];
    let more = ["--seeds", "3", "--measures", "dispersion,star", "--out", "out", "--format", "table"];
    let compared = succeeds(cover(dir.path(), &[&study[..], &more].concat()));
    assert!(stderr(&compared).contains("mine has no set at d = 2, n = 8"), "{}", stderr(&compared));
    let sets = rows(&dir.path().join("out/sets.csv"));
    let values = |strategy: &str| {
        let of = sets.iter().filter(|set| is(set, strategy, "2", "24") && !set["seed"].is_empty());
        of.map(|set| (set["seed"].clone(), number(set, "dispersion_lower"), number(set, "star_lower")))
            .collect::<Vec<_>>()
    };
    assert_eq!((values("mine").len(), values("mine")), (3, values("halton")));
    // One set has a value and no comparison. It can be the baseline.
    generate("9", "alone.csv");
    let alone =
        ["compare", "--strategies", "one=alone.csv,halton", "--dims", "2", "--budgets", "24", "--baseline", "one"];
    let alone = succeeds(cover(dir.path(), &[&alone[..], &["--seeds", "3", "--out", "alone"]].concat()));
    assert!(stderr(&alone).contains("one has 1 set at d = 2, n = 24, too few for a comparison"), "{}", stderr(&alone));
    assert!(stdout(&alone).contains("order unknown"), "{}", stdout(&alone));
    // Without --seeds, there are as many seeds as sets.
    let shared =
        ["compare", "--strategies", "halton,mine=sets/*.txt", "--dims", "2", "--budgets", "24", "--out", "shared"];
    let shared = stdout(&succeeds(cover(dir.path(), &shared)));
    assert!(shared.contains("median over 3 seeds") && !shared.contains("median over 30"), "{shared}");
    fs::write(dir.path().join("outside.csv"), "x,y\n0.1,0.2\n1.5,0.3\n").unwrap();
    let outside = cover(dir.path(), &["compare", "--strategies", "halton,mine=outside.csv", "--out", "no"]);
    refused(&outside, &["outside.csv, line 3: parameter `x`: found 1.5, expected a number in [0, 1]"]);
    assert!(!stderr(&outside).contains("--space"), "compare has no such option: {}", stderr(&outside));
    for (strategies, says) in [
        ("halton=sets/*.txt", "a strategy is called `halton` already"),
        ("mine=nowhere/*.csv", "mine=nowhere/*.csv: found no file"),
        ("mine=sets", "expected files, for example FOLDER/*.csv"),
    ] {
        refused(&cover(dir.path(), &["compare", "--strategies", strategies, "--out", "no"]), &[says]);
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_jobs() {
    let dir = tempfile::tempdir().unwrap();
    let measures = ["--measures", "dispersion,centered,star", "--quiet", "--jobs"];
    let one = compare(dir.path(), "one", &[measures.as_slice(), &["1", "--format", "table"]].concat());
    let two = compare(dir.path(), "two", &[measures.as_slice(), &["2", "--format", "table"]].concat());
    assert_eq!(one, two);
    for name in ["sets.csv", "summary.csv", "slopes.csv", "table.tex", "star-d3.svg", "dispersion-d2.png"] {
        let read = |folder: &str| fs::read(dir.path().join(folder).join(name)).unwrap();
        assert!(read("one") == read("two"), "{name} differs");
    }
}

#[test]
fn sets_are_those_that_estimate_measures() {
    let dir = tempfile::tempdir().unwrap();
    compare(dir.path(), "out", &["--seed", "40"]);
    let sets = rows(&dir.path().join("out/sets.csv"));
    for (strategy, dims, budget, seed) in
        [("halton", "3", "24", ""), ("random", "2", "8", "45"), ("lhs", "3", "24", "40"), ("fibonacci", "2", "24", "")]
    {
        let mut arguments =
            vec!["estimate", "--strategy", strategy, "--dims", dims, "--budget", budget, "--format", "json"];
        if !seed.is_empty() {
            arguments.extend(["--seed", seed]);
        }
        let found: Value = serde_json::from_str(&stdout(&succeeds(cover(dir.path(), &arguments)))).unwrap();
        let set = sets.iter().find(|set| is(set, strategy, dims, budget) && set["seed"] == seed).unwrap();
        let continuous = &found["continuous"];
        for (column, value) in [
            ("dispersion_lower", &continuous["dispersion"]["lower"]),
            ("star_upper", &continuous["star_discrepancy"]["upper"]),
            ("extreme_lower", &continuous["extreme_discrepancy"]["lower"]),
            ("l2-star_lower", &continuous["l2_star"]),
            ("mixture_upper", &continuous["mixture"]),
        ] {
            assert_eq!(Some(number(set, column)), value.as_f64(), "{strategy} {column}");
        }
    }
}

#[test]
fn the_summary_is_what_the_rows_of_the_sets_say() {
    let dir = tempfile::tempdir().unwrap();
    compare(dir.path(), "out", &["--measures", "star", "--baseline", "lhs"]);
    let (sets, summary) = (rows(&dir.path().join("out/sets.csv")), rows(&dir.path().join("out/summary.csv")));
    let values = |strategy: &str, d: &str, n: &str| -> Vec<f64> {
        let of_seeds = sets.iter().filter(|set| is(set, strategy, d, n) && !set["seed"].is_empty());
        of_seeds.map(|set| number(set, "star_lower")).collect()
    };
    // Six values: the median is the middle of the third and the fourth.
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        f64::midpoint(values[2], values[3])
    };
    assert_eq!(summary.len(), (4 + 3) * 2);
    for row in &summary {
        let mine = values(&row["strategy"], &row["d"], &row["n"]);
        let base = values("lhs", &row["d"], &row["n"]);
        assert!((number(row, "median") - median(mine.clone())).abs() < 1e-12, "{row:?}");
        if row["strategy"] == "lhs" {
            assert!(row["ratio"].is_empty() && row["holm_p"].is_empty(), "{row:?}");
            continue;
        }
        let ratio = median(mine.iter().zip(&base).map(|(a, b)| a / b).collect());
        assert!((number(row, "ratio") - ratio).abs() < 1e-12, "{row:?}");
        assert!(number(row, "ratio_low") <= ratio && ratio <= number(row, "ratio_high"), "{row:?}");
        let better = mine.iter().flat_map(|a| base.iter().map(move |b| a < b)).filter(|lower| *lower).count();
        assert!((number(row, "a12_better") - better as f64 / 36.0).abs() < 1e-12, "{row:?}");
        // Ten comparisons with six pairs: p is a number of 2^-6, twice, and its correction at most ten times that.
        let (p, holm) = (number(row, "wilcoxon_p"), number(row, "holm_p"));
        assert!((p * 32.0).fract() == 0.0 && p <= holm && holm <= 10.0 * p + 1e-12, "{row:?}");
    }
    // Two budgets: the slope is that of the line through both medians.
    for row in rows(&dir.path().join("out/slopes.csv")) {
        let at = |n| median(values(&row["strategy"], &row["d"], n));
        let slope = libm::log(at("24") / at("8")) / libm::log(3.0);
        assert!((number(&row, "slope") - slope).abs() < 1e-9, "{row:?}");
        assert_eq!(row["plain_slope"].is_empty(), row["strategy"] == "random" || row["strategy"] == "lhs");
    }
}

#[test]
fn the_latex_table_has_rows_of_one_length_and_closes_what_it_opens() {
    let dir = tempfile::tempdir().unwrap();
    compare(dir.path(), "out", &["--measures", "l2-star,k-wise-dispersion"]);
    let text = fs::read_to_string(dir.path().join("out/table.tex")).unwrap();
    let tables: Vec<&str> = text.split("\\begin{tabular}").skip(1).collect();
    assert_eq!(tables.len(), 2);
    for table in tables {
        let cells = table.lines().filter(|line| line.ends_with("\\\\")).map(|line| line.matches('&').count());
        // d, strategy, two budgets, slope, ratio, A12 and p.
        assert!(cells.clone().count() >= 4 && cells.into_iter().all(|count| count == 7), "{table}");
    }
    let plain = text.replace("\\{", "").replace("\\}", "");
    assert_eq!(plain.matches('{').count(), plain.matches('}').count());
    assert_eq!(text.matches('$').count() % 2, 0);
    for environment in ["table", "tabular"] {
        let count = |what: &str| text.matches(&format!("\\{what}{{{environment}}}")).count();
        assert_eq!((count("begin"), count("end")), (2, 2));
    }
}

#[test]
fn values_that_the_time_limit_cut_short_say_so() {
    let dir = tempfile::tempdir().unwrap();
    let arguments = ["compare", "--strategies", "random,halton", "--dims", "8", "--budgets", "300", "--seeds", "2"];
    let limited = ["--measures", "dispersion,star", "--time-limit", "0.02", "--out", "out", "--format", "table"];
    let output = succeeds(cover(dir.path(), &[arguments.as_slice(), &limited].concat()));
    assert!(stdout(&output).contains("* cut short by the limit"), "{}", stdout(&output));
    assert!(stderr(&output).contains("cut 5 sets short"), "{}", stderr(&output));
    for set in rows(&dir.path().join("out/sets.csv")) {
        assert_eq!(set["exact"], "false");
        assert!(number(&set, "star_lower") < number(&set, "star_upper"), "{set:?}");
    }
    let summary = rows(&dir.path().join("out/summary.csv"));
    assert!(summary.iter().all(|row| row["exact"] == "false"));
    // The two ends of the brackets enclose the median.
    assert!(summary.iter().all(|row| number(row, "median") < number(row, "median_upper")));
}

#[test]
fn programs_get_json_and_everybody_is_told_what_is_left_out() {
    let dir = tempfile::tempdir().unwrap();
    let arguments =
        ["compare", "--strategies", "halton,fibonacci", "--dims", "2,5", "--budgets", "9,99", "--seeds", "3"];
    let output = succeeds(cover(dir.path(), &[arguments.as_slice(), &["--out", "out", "--format", "json"]].concat()));
    let found: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(found["baseline"], "halton");
    assert_eq!(found["sets"], (2 * 2 + 2) * 4);
    let cell = &found["summary"][1];
    assert_eq!((cell["measure"].as_str(), cell["strategy"].as_str()), (Some("dispersion"), Some("fibonacci")));
    assert!(cell["versus"]["interval"][0].as_f64() <= cell["versus"]["ratio"].as_f64());
    let said = stderr(&output);
    for words in ["fibonacci supports exactly 2", "left out at d = 5, n = 99", "3 seeds are few", "written to out"] {
        assert!(said.contains(words), "`{words}` is missing in:\n{said}");
    }
}

#[test]
fn wrong_comparisons_are_refused_and_leave_nothing_behind() {
    let dir = tempfile::tempdir().unwrap();
    let cases: &[(&[&str], &[&str])] = &[
        (&[], &["--strategies"]),
        (&["--strategies", "haltom"], &["`haltom`", "`halton`"]),
        (&["--strategies", ""], &["strategy"]),
        (&["--strategies", "halton,random,halton"], &["halton is twice", "strategies"]),
        (&["--strategies", "halton", "--baseline", "random"], &["baseline random is not among the strategies"]),
        (&["--strategies", "halton", "--baseline", "greeedy"], &["`greeedy`", "`greedy`"]),
        (&["--strategies", "fibonacci"], &["baseline fibonacci", "exactly 2", "d = 3"]),
        (&["--strategies", "halton", "--dims", "0"], &["found 0"]),
        (&["--strategies", "halton", "--dims", "2,2"], &["2 is twice", "dimensions"]),
        (&["--strategies", "halton", "--dims", "two"], &["two"]),
        (&["--strategies", "halton", "--budgets", "0,5"], &["found 0"]),
        (&["--strategies", "halton", "--budgets", "5,5"], &["5 is twice", "budgets"]),
        (&["--strategies", "halton", "--budgets", "300000000"], &["do not fit in memory"]),
        (&["--strategies", "halton", "--seeds", "1"], &["seeds is 1", "at least 2"]),
        (
            &["--strategies", "halton", "--seed", "18446744073709551615"],
            &["30 seeds from the first seed 18446744073709551615"],
        ),
        (&["--strategies", "halton", "--k", "0"], &["k is 0"]),
        (&["--strategies", "halton", "--measures", "stars"], &["`stars`", "`star`"]),
        (&["--strategies", "halton", "--measures", "k-wise"], &["discrete parameters"]),
        (&["--strategies", "halton", "--measures", "k-wise-dispersion", "--dims", "2"], &["needs d > 2"]),
        (&["--strategies", "halton", "--time-limit=-1"], &["--time-limit"]),
        (&["--strategies", "halton", "--jobs", "0"], &["--jobs"]),
    ];
    for (arguments, says) in cases {
        refused(&cover(dir.path(), &[["compare"].as_slice(), arguments].concat()), says);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0, "{arguments:?} wrote something");
    }
}

#[test]
fn folders_with_something_in_them_are_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("file"), "mine").unwrap();
    fs::create_dir(dir.path().join("full")).unwrap();
    fs::write(dir.path().join("full/notes.txt"), "mine").unwrap();
    let command = ["compare", "--strategies", "halton", "--seeds", "2", "--out"];
    refused(&cover(dir.path(), &[command.as_slice(), &["file"]].concat()), &["file is a file, expected a folder"]);
    refused(&cover(dir.path(), &[command.as_slice(), &["full"]].concat()), &["full is not empty"]);
    assert_eq!(fs::read_dir(dir.path().join("full")).unwrap().count(), 1);
}
