//! Formulas as text: what is read, what is refused and with which words, and what is printed.

mod common;

use common::{expressions, formulas};
use paracosm_oracles::{Comparison, Formula, Interval, flag, signal};
use proptest::prelude::*;

fn parsed(text: &str) -> Formula {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Each text is read as the other one.
#[test]
fn formulas_are_read_by_these_rules() {
    for (text, meaning) in [
        ("x < 3", "(x < 3)"),
        ("always[0,30] (speed < 120)", "always[0,30] (speed < 120)"),
        ("G[0,30] speed < 120", "always[0,30] (speed < 120)"),
        ("F[0,5] (b) ", "eventually[0,5] b"),
        ("H x > 0 and O[1,2] x > 0", "historically (x > 0) and once[1,2] (x > 0)"),
        ("(a > 0) until[0,2] (b <= 1)", "(a > 0) until[0,2] (b <= 1)"),
        ("a U b", "a until b"),
        ("a R[0,1] b or a S b", "(a release[0,1] b) or (a since b)"),
        ("always (near -> eventually[0,5] (speed < 0.1))", "always (near -> eventually[0,5] (speed < 0.1))"),
        ("a -> b -> c", "a -> (b -> c)"),
        ("a implies b or c and d until e", "a -> (b or (c and (d until e)))"),
        ("a and b and c", "(a and b) and c"),
        ("not a and b", "not a and b"),
        ("not always x < 3 and b", "not always (x < 3) and b"),
        (
            "always[0,30] rpm < 3000 implies always[0,4] speed < 35",
            "always[0,30] (rpm < 3000) -> always[0,4] (speed < 35)",
        ),
        ("x + 2 * y - 3 <= -z / 4", "(x + 2 * y - 3 <= -z / 4)"),
        ("(x + 2) * -3 != - 4", "((x + 2) * -3 != -4)"),
        ("x - (y - z) == --x", "(x - (y - z) == --x)"),
        ("-(3) < min(x, max(y,1)) ", "(-(3) < min(x, max(y, 1)))"),
        ("abs(x - y) >= 1e-3", "(abs(x - y) >= 0.001)"),
        ("((x)) > .5", "(x > 0.5)"),
        ("true and not false", "true and not false"),
        ("eventually~[0.1,0.25] a", "eventually~[0.1,0.25] a"),
        ("always[2,inf] a", "always[2,inf] a"),
        ("always[0,inf] a", "always a"),
        ("\"until\" and 'a b'", "\"until\" and \"a b\""),
        (r#""say \"a\" \\" > 0"#, r#"("say \"a\" \\" > 0)"#),
        ("größe > 0", "(größe > 0)"),
        ("\n always\t(x\n<3)", "always (x < 3)"),
    ] {
        assert_eq!(parsed(text).to_string(), meaning, "{text}");
        assert_eq!(parsed(meaning), parsed(text), "{text}");
    }
}

#[test]
fn what_is_no_formula_is_refused_with_its_place_and_what_belongs_there() {
    for (text, complaint) in [
        ("", "column 1: found the end, expected a formula"),
        ("always", "column 7: found the end, expected a formula"),
        ("x <", "column 4: found the end, expected a number or a signal"),
        ("x < 3)", "column 6: found `)`, expected an operator or the end"),
        ("(x < 3", "column 7: found the end, expected an operator or `)`"),
        ("x + 1", "column 6: found the end, expected a comparison such as `<`"),
        ("always (3)", "column 11: found the end, expected a comparison such as `<`"),
        ("x < 3 and 4", "column 12: found the end, expected a comparison such as `<`"),
        (
            "(x < 3) + 1 > 2",
            "column 9: found `+`, expected an operator between formulas or the end (`(x < 3)` is true or false, not a \
             number)",
        ),
        (
            "0 < x < 3",
            "column 7: found `<`, expected an operator or the end (comparisons do not chain: write `a < b and b < c`)",
        ),
        (
            "a until b until c",
            "column 11: found `until`, expected an operator or the end (`until`, `release` and `since` do not chain: use \
             parentheses)",
        ),
        ("a && b", "column 3: found `&&`, expected `and` (formulas use this operator)"),
        ("!a", "column 1: found `!`, expected `not` (formulas use this operator)"),
        ("x ≤ 3", "column 3: found `≤`, expected `<=` (formulas use this operator)"),
        ("x = 3", "column 3: found `=`, expected `==` (formulas use this operator)"),
        (
            "größe # 3",
            "column 7: found `#`, expected a formula (write names with characters other than letters, digits, \
             `_` and `.` in quotes)",
        ),
        (
            "alway (x < 3)",
            "column 7: found `(`, expected an operator or the end (did you mean `always` instead of `alway`?)",
        ),
        (
            "x < G",
            "column 5: found `G`, expected a number or a signal (`G` is a word of the language; write a signal of this \
             name in quotes)",
        ),
        (
            "x + not y > 3",
            "column 5: found `not`, expected a number or a signal (`not` is a word of the language; write a signal of \
             this name in quotes)",
        ),
        ("3x > 1", "column 1: found `3x`, expected a finite number"),
        ("x > 1e999", "column 5: found `1e999`, expected a finite number"),
        ("'x > 1", "column 1: found a name without a closing quotation mark, expected a closing `'`"),
        ("abs x", "column 5: found `x`, expected `(`"),
        ("min(x) > 1", "column 6: found `)`, expected `,`"),
        ("always[0 a", "column 10: found `a`, expected `,`"),
        ("always[0:3] a", "column 9: found `:`, expected `,`"),
        ("always[-1,3] a", "column 8: found `-`, expected a time in seconds, from 0 on"),
        ("always[inf,inf] a", "column 8: found `inf`, expected a time in seconds, from 0 on"),
        ("always[3,2.5] a", "column 10: found `2.5`, expected a time of at least 3 s"),
        ("always[0,x] a", "column 10: found `x`, expected a time in seconds, or `inf`"),
        ("always~ a", "column 9: found `a`, expected `[`"),
    ] {
        assert_eq!(text.parse::<Formula>().map_err(|error| error.to_string()), Err(complaint.to_owned()), "{text}");
    }
}

#[test]
fn a_signal_that_the_trace_does_not_have_is_named_with_the_nearest() {
    let complaint = |text: &str| Formula::parse(text, &["speed", "rpm"]).unwrap_err().to_string();
    assert_eq!(
        complaint("always (rpm < 3 and speeed > 2)"),
        "column 21: found `speeed`, expected a signal of the trace (did you mean `speed`?)"
    );
    assert_eq!(
        complaint("\"a b\" > 2"),
        "column 1: found the name \"a b\", expected a signal of the trace (the signals of the trace are speed, rpm)"
    );
    assert!(Formula::parse("always (speed < rpm)", &["speed", "rpm"]).is_ok());
}

#[test]
fn nesting_has_a_limit_rather_than_the_stack() {
    for text in [
        "(".repeat(1_000_000),
        "not ".repeat(1_000_000) + "a",
        "-".repeat(1_000_000) + "x < 1",
        vec!["a"; 1_000_000].join(" -> "),
        vec!["a"; 1_000_000].join(" and "),
        vec!["x"; 1_000_000].join(" + ") + " < 1",
        "abs(".repeat(1_000_000),
    ] {
        let error = text.parse::<Formula>().unwrap_err();
        assert_eq!(error.expected, "a formula with at most 200 levels of nesting");
    }
    parsed(&("(".repeat(190) + "a" + &")".repeat(190)));
    parsed(&vec!["a"; 190].join(" and "));
}

#[test]
fn a_formula_as_deep_as_is_read_is_read_again_as_it_is_written() {
    for text in [
        vec!["a"; 199].join(" -> "),
        vec!["(a -> b)"; 198].join(" -> "),
        vec!["x"; 198].join(" - (") + &")".repeat(197) + " < 1",
        "always (a -> ".repeat(99) + "b" + &")".repeat(99),
        "not (".repeat(190) + "a" + &")".repeat(190),
        "abs(".repeat(190) + "x" + &")".repeat(190) + " != 1",
    ] {
        let formula = text.parse::<Formula>().unwrap_or_else(|error| panic!("{error}: {text}"));
        assert_eq!(formula.to_string().parse().as_ref(), Ok(&formula), "{text}");
    }
}

#[test]
fn formulas_are_built_as_they_are_said() {
    let near = (signal("gap") - signal("margin") * 2.0).below(5.0);
    let formula = near.implies(signal("speed").below(0.1).eventually(0.0..=5.0)).always(..);
    assert_eq!(formula.to_string(), "always ((gap - margin * 2 < 5) -> eventually[0,5] (speed < 0.1))");
    let formula = (!flag("red")).or(signal("v").abs().at_most(0.0).since(1.0..=2.0, flag("red"))).historically(3.0..);
    assert_eq!(formula.to_string(), "historically[3,inf] (not red or ((abs(v) <= 0) since[1,2] red))");
    let outward = flag("a").once(Interval::from(0.0..=0.3).outward());
    assert_eq!(outward.to_string(), "once~[0,0.3] a");
}

#[test]
fn a_formula_knows_its_signals_and_how_far_it_looks() {
    let formula = parsed("always[0,20] (near -> eventually[0,5] speed < abs(near - x)) and once[0,90] y > 0");
    assert_eq!(formula.signals(), ["near", "speed", "x", "y"]);
    assert_eq!(formula.horizon(), 25.0);
    assert_eq!(parsed("always a until[1,2] b").horizon(), f64::INFINITY);
    let longest = formula.outlasting(30.0).unwrap();
    assert_eq!(longest.to_string(), "once[0,90] (y > 0)");
    assert_eq!(formula.outlasting(90.0), None);
}

proptest! {
    #[test]
    fn what_is_printed_parses_to_the_same_formula(formula in formulas(5)) {
        prop_assert_eq!(parsed(&formula.to_string()), formula);
    }

    #[test]
    fn arithmetic_with_any_names_and_numbers_parses_back(left in expressions(), name in any::<String>(), x in any::<f64>()) {
        prop_assume!(x.is_finite());
        let formula = (left - signal(name.clone()) / (-signal(name.clone()) * x))
            .compare(Comparison::Equal, -(signal(name.clone()) + 1.0))
            .and(flag(name));
        prop_assert_eq!(parsed(&formula.to_string()), formula);
    }

    #[test]
    fn no_text_is_too_strange(text in any::<String>()) {
        let _ = text.parse::<Formula>();
    }

    #[test]
    fn no_sequence_of_words_is_too_strange(
        words in prop::collection::vec(prop::sample::select(vec![
            "always", "G", "F[0,1]", "until", "U", "R[0,2]", "since~[0,.3]", "not", "and", "or", "->", "x", "y.z", "3",
            "-", "+", "*", "/", "<", ">=", "==", "(", ")", "[", "]", ",", "~", "abs", "min", "true", "inf", "'", "\"q\"",
        ]), 0..24),
    ) {
        let text = words.join(" ");
        if let Ok(formula) = text.parse::<Formula>() {
            prop_assert_eq!(parsed(&formula.to_string()), formula, "{}", text);
        }
    }
}
