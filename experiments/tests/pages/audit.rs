//! Computes the numbers of the page on stated suites.

use crate::page::Page;
use crate::rows::{Row, count, mean, numbers_of, rows};
use std::collections::BTreeMap;
use std::fmt::Write;

const SUITES: &[u8] = include_bytes!("../../data/audit.csv");
const KINDS: &[u8] = include_bytes!("../../data/audit-kinds.csv");
const STATISTICS: &[u8] = include_bytes!("../../data/audit-statistics.csv");
const STRATEGIES: &[u8] = include_bytes!("../../data/audit-strategies.csv");

fn number(row: &Row, name: &str) -> Option<f64> {
    row[name].parse().ok()
}

fn percent(share: Option<f64>) -> String {
    share.map_or("–".to_owned(), |share| format!("{:.0} %", 100.0 * share))
}

/// The volume of a hole, as a certified bracket if it is not exact; a dash if nothing is continuous.
fn hole(lower: Option<f64>, upper: Option<f64>) -> String {
    match (lower, upper) {
        (Some(lower), Some(upper)) if upper > 0.0 && upper - lower > 5e-4 => {
            let digits = if format!("{lower:.3}") == format!("{upper:.3}") { 4 } else { 3 };
            format!("{lower:.digits$} to {upper:.digits$}")
        }
        (Some(_), Some(upper)) | (None, Some(upper)) if upper > 0.0 => format!("{upper:.3}"),
        _ => "–".to_owned(),
    }
}

/// Returns the table of suites.
fn suites() -> String {
    let mut text = String::from(
        "| scenario | tests | rows | largest hole | witness | mutants | killed | better suite: tests | its hole | \
         killed by stated / better |\n|",
    );
    text.push_str(&" --- |".repeat(10));
    text.push('\n');
    for row in rows(SUITES) {
        let witness = match number(&row, "witness_tried") {
            Some(tried) if tried > 0.0 => format!("fails in {} of {}", row["witness_failing"], row["witness_tried"]),
            _ => "–".to_owned(),
        };
        let better = if row["better_tests"].is_empty() { "–" } else { row["better_tests"] };
        let both =
            format!("{} / {}", percent(number(&row, "other_score")), percent(number(&row, "better_other_score")));
        writeln!(
            text,
            "| {} | {} | {} | {} | {witness} | {} | {} | {better} | {} | {both} |",
            row["scenario"],
            row["tests"],
            row["rows"],
            hole(number(&row, "hole_lower"), number(&row, "hole_upper")),
            row["mutants"],
            percent(number(&row, "score")),
            hole(None, number(&row, "better_hole_upper")),
        )
        .unwrap();
    }
    text
}

/// Returns the table of the kinds of defects that a suite misses, over all scenarios, from the kind that is missed most often.
fn kinds() -> String {
    let mut sums: BTreeMap<&str, [u32; 2]> = BTreeMap::new();
    for row in rows(KINDS) {
        let sum = sums.entry(row["kind"]).or_default();
        sum[0] += row["mutants"].parse::<u32>().unwrap();
        sum[1] += row["killed"].parse::<u32>().unwrap();
    }
    let (mut missed, all): (Vec<_>, Vec<_>) = sums.into_iter().partition(|(_, [mutants, killed])| killed < mutants);
    missed.sort_by_key(|(_, [mutants, killed])| (1_000_000 * killed / mutants, std::cmp::Reverse(*mutants)));
    let mut text = String::from("| kind | mutants | killed |\n| --- | --- | --- |\n");
    for (kind, [mutants, killed]) in missed {
        writeln!(text, "| `{kind}` | {mutants} | {killed} |").unwrap();
    }
    let mutants: u32 = all.iter().map(|(_, [mutants, _])| mutants).sum();
    writeln!(text, "| the {} other kinds | {mutants} | {mutants} |", all.len()).unwrap();
    text
}

/// The row of a comparison among all mutants, or among mutants with conditions.
fn compared<'a>(statistics: &'a [Row], comparison: &str, mutants: &str) -> &'a Row {
    statistics.iter().find(|row| row["comparison"] == comparison && row["mutants"] == mutants).unwrap()
}

/// A p-value in one digit that counts.
fn small(p: f64) -> String {
    if p >= 1e-4 { format!("{p:.*}", -libm::log10(p).floor() as usize) } else { format!("{p:.0e}") }
}

/// The table of the differences to random suites, in percentage points.
fn differences(statistics: &[Row]) -> String {
    let random =
        mean(&numbers_of(&rows(STRATEGIES), "score", |row| row["strategy"] == "random" && !row["score"].is_empty()));
    let mut text = format!(
        "| against `random` (score {:.1} %) | all mutants | p | mutants with conditions | p |\n| --- | --- | --- | --- | --- |\n",
        100.0 * random
    );
    for strategy in ["lhs", "greedy", "halton-scrambled", "sobol-owen", "random-corners"] {
        write!(text, "| `{strategy}` |").unwrap();
        for mutants in ["all", "conditional"] {
            let row = compared(statistics, &format!("{strategy} - random"), mutants);
            let [difference, low, high] = ["mean", "lower", "upper"].map(|column| 100.0 * number(row, column).unwrap());
            write!(text, " {difference:+.1} ({low:+.1} to {high:+.1}) | {} |", small(number(row, "p").unwrap()))
                .unwrap();
        }
        text.push('\n');
    }
    text
}

/// The table of the rank correlations of dispersions with the score.
fn correlations(statistics: &[Row]) -> String {
    let mut text = String::from(
        "| rank correlation with the score (Spearman, mean over scenarios) | all mutants | mutants with conditions |\n| --- | --- | --- |\n",
    );
    let names = [
        ("low dispersion ~ score", "low dispersion"),
        ("low dispersion ~ score, without random-corners", "low dispersion, without `random-corners`"),
        ("low dispersion of pairs ~ score", "low dispersion of pairs of parameters"),
        (
            "low dispersion of pairs ~ score, without random-corners",
            "low dispersion of pairs, without `random-corners`",
        ),
    ];
    for (comparison, name) in names {
        let cell = |mutants: &str| {
            let row = compared(statistics, comparison, mutants);
            let [value, low, high] = ["mean", "lower", "upper"].map(|column| number(row, column).unwrap());
            format!("{value:.2} ({low:.2} to {high:.2})")
        };
        writeln!(text, "| {name} | {} | {} |", cell("all"), cell("conditional")).unwrap();
    }
    text
}

#[test]
fn the_numbers_of_the_page_follow_from_its_suites() {
    let (suites_rows, statistics, all_kinds) = (rows(SUITES), rows(STATISTICS), rows(KINDS));
    let mut page = Page::open("audit.md");
    page.table("suites", &suites());
    page.table("kinds", &kinds());
    page.table("differences", &differences(&statistics));
    page.table("correlations", &correlations(&statistics));

    let has = |name: &'static str| move |row: &Row| number(row, name).is_some_and(|value| value > 0.0);
    page.says(format!(
        "{} of {} scenarios have a parameter with a range. For {} of these there is a driver",
        count(&suites_rows, has("hole_upper")),
        suites_rows.len(),
        count(&suites_rows, has("witness_tried"))
    ));
    let always = count(&suites_rows, |row| row["witness_tried"] == "64" && row["witness_failing"] == "64");
    page.says(format!("For {always} of them this driver violates a requirement in each of 64 tests"));
    let of = |name: &str| suites_rows.iter().find(|row| row["scenario"].starts_with(name)).unwrap();
    let thousands = |tests: &str| {
        tests
            .parse::<usize>()
            .map(|n| if n < 1000 { n.to_string() } else { format!("{},{:03}", n / 1000, n % 1000) })
            .unwrap()
    };
    let killed =
        |row: &Row, column: &str| (number(row, column).unwrap() * number(row, "other_mutants").unwrap()).round();
    let (cut_in, cut_out, following) = (of("4_4_1"), of("4_5_1"), of("4_3_1"));
    page.says(format!("The cut-in (4.4_1) has {} tests", thousands(cut_in["tests"])));
    assert!(number(cut_in, "hole_lower").unwrap() > 1.0 / 3.0);
    page.says(format!(
        "the better suite has {} tests instead of {}",
        cut_in["better_tests"],
        thousands(cut_in["tests"])
    ));
    page.says(format!(
        "It kills {} of {} mutants that had no part in it; the stated suite kills {}",
        killed(cut_in, "better_other_score"),
        cut_in["other_mutants"],
        killed(cut_in, "other_score")
    ));
    page.says(format!(
        "For the cut-out (4.5_1), {} tests take the place of {}, and both suites kill all {} mutants",
        cut_out["better_tests"],
        thousands(cut_out["tests"]),
        cut_out["other_mutants"]
    ));
    assert_eq!([killed(cut_out, "better_other_score"), killed(cut_out, "other_score")], [64.0; 2]);
    page.says(format!(
        "For following (4.3_1), the better suite has {} tests instead of {}",
        following["better_tests"],
        thousands(following["tests"])
    ));
    page.says(format!(
        "It kills all {} mutants that had no part in it; the stated suite kills {}",
        killed(following, "better_other_score"),
        killed(following, "other_score")
    ));
    let lhs = compared(&statistics, "lhs - random", "all");
    page.says(format!(
        "Over {} scenarios, a Latin hypercube of 40 tests kills {:.1} percentage points more mutants",
        lhs["scenarios"],
        100.0 * number(lhs, "mean").unwrap()
    ));
    let sum = |column: &str, of: &dyn Fn(&Row) -> bool| numbers_of(&all_kinds, column, of).iter().sum::<f64>();
    let (all, found) = (sum("mutants", &|_| true), sum("killed", &|_| true));
    page.says(format!("All suites together kill {found} of {all} mutants"));
    let of_following = |row: &Row| row["scenario"].starts_with("4_3_1");
    assert_eq!(
        2.0 * (sum("mutants", &of_following) - sum("killed", &of_following)),
        all - found,
        "half of the missed mutants"
    );
    page.says(format!("This study has {} scenarios", lhs["scenarios"]));
    let correlation = |mutants: &str| {
        number(compared(&statistics, "low dispersion ~ score, without random-corners", mutants), "p").unwrap()
    };
    assert!(correlation("all") < 0.0002 && correlation("conditional") < 0.0002);
    page.given(&[
        "UN Regulation No. 157 (ALKS",
        "and 4.3_1 has half of those",
        "even in a grid of 7 tests",
        "Each of the 417 [defects]",
        "first on in 16 random tests",
        "128 mutants are made",
    ]);
    page.given(&[
        "the 15 that come with the software, and the 17 published scenarios above",
        "three suites of 40 tests",
        "Up to 64 mutants of each scenario",
        "The intervals are 95 % bootstrap intervals",
        "(p < 0.0002)",
        "In the 17 scenarios with two discrete",
        "A defect that 16 random tests do not",
    ]);
    page.given(&[
        "**No witness in 4.1_1 and 4.1_2.**",
        "In 4.1_1, the ego",
        "A defect that none of 16 random",
        "With 200 mutants and other seeds, the stated suite of 4.4_1 killed 96 to 98 %",
    ]);
    page.close();
}

#[test]
fn no_kind_has_more_killed_mutants_than_mutants_and_holes_are_brackets() {
    for row in rows(KINDS) {
        assert!(row["killed"].parse::<u32>().unwrap() <= row["mutants"].parse().unwrap(), "{row:?}");
    }
    for row in rows(SUITES) {
        let bounds = ["hole_lower", "hole_upper"].map(|name| number(&row, name).unwrap());
        assert!(0.0 <= bounds[0] && bounds[0] <= bounds[1] && bounds[1] <= 1.0, "{row:?}");
        // The witness is in the largest hole, or in a smaller one.
        assert!(number(&row, "witness_volume").is_none_or(|volume| volume <= bounds[1] + 1e-9), "{row:?}");
        // A better suite has fewer tests and a smaller hole.
        if let Some(tests) = number(&row, "better_tests") {
            assert!(tests < number(&row, "tests").unwrap(), "{row:?}");
            assert!(number(&row, "better_hole_upper").unwrap() < bounds[0], "{row:?}");
        }
    }
}
