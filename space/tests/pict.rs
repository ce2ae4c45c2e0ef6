//! Model files: what they hold, against an evaluation of their constraints by hand.

use paracosm_space::constraint::Constraint;
use paracosm_space::pict::Model;
use paracosm_space::{Point, Space, Value};
use proptest::prelude::*;

fn read(text: &str) -> Model {
    Model::from_pict(text).unwrap_or_else(|error| panic!("{error} in\n{text}"))
}

fn constraints(model: &Model) -> Vec<&str> {
    model.space.constraints().iter().map(Constraint::text).collect()
}

/// All tests as values in the order of the parameters, and whether the model allows them.
fn tests(model: &Model) -> Vec<(Vec<Value>, bool)> {
    let rows = model.space.levels().iter().fold(vec![vec![]], |heads: Vec<Vec<usize>>, &levels| {
        heads.iter().flat_map(|head| (0..levels).map(|level| [head.as_slice(), &[level]].concat())).collect()
    });
    let test = |discrete: Vec<usize>| {
        let point = Point { continuous: vec![], discrete };
        let values = model.space.decode(&point).iter().map(|(_, value)| value.clone()).collect();
        (values, model.space.allows(&point))
    };
    rows.into_iter().map(test).collect()
}

#[test]
fn a_model_is_read_with_its_sub_models_and_constraints() {
    let model = read(
        "# Partitions\r\n\r\n\
         Type:          Primary, Logical, Single, Span\r\n\
         Size:          10, 100, 5000, 40000\r\n\
         File system:   FAT, FAT32, NTFS (10)\r\n\
         Other system:  <file SYSTEM>, ext4 | ext3\r\n\
         Compression:   on, off\r\n\
         \r\n\
         { Size, TYPE, compression } @ 3\r\n\
         {File system, Other system}\r\n\
         if [file system] = \"fat\" then [Size] <= 4096;\r\n\
         # A comment, and a constraint on several lines\r\n\
         IF [File system] LIKE \"fat*\" AND NOT ([Size] > 100\r\n\
            OR [Type] IN {\"SPAN\", \"Single\"})\r\n\
         THEN [Compression] = \"OFF\"\r\n\
         ELSE [Type] NOT IN {\"Logical\"};\r\n\
         [File system] <> [Other system];",
    );
    let names: Vec<_> = model.space.parameters().iter().map(|parameter| parameter.name.as_str()).collect();
    assert_eq!(names, ["Type", "Size", "File system", "Other system", "Compression"]);
    assert_eq!(model.space.levels(), [4, 4, 3, 4, 2]);
    assert_eq!(model.demand.groups, [(vec![0, 1, 4], 3)]);
    assert_eq!(
        constraints(&model),
        [
            "[File system] == 'FAT' implies Size <= 4096",
            "([File system] != 'NTFS' and not (Size > 100 or Type in ['Single', 'Span']) implies Compression == 'off') and \
             (not ([File system] != 'NTFS' and not (Size > 100 or Type in ['Single', 'Span'])) implies not Type == 'Logical')",
            "[File system] != [Other system]",
        ]
    );
    assert_eq!(
        model.notes,
        [
            "line 10: the sub-model has no order, so it asks for no further combinations",
            "only the first alias of a value is used: `ext4 | ext3`",
            "weights are ignored: `NTFS (10)`",
        ]
    );
}

#[test]
fn values_are_numbers_words_and_what_they_look_like() {
    let check = |line: &str, expected: &[Value], notes: &[&str]| {
        let model = read(line);
        assert_eq!(model.space.parameters()[0].levels().unwrap(), expected, "{line}");
        assert_eq!(model.notes, notes, "{line}");
    };
    let written = |text: &str| Value::Written(text.into());
    check("A: 1, -2.50, 1e3", &[1.into(), written("-2.50"), written("1e3")], &[]);
    check("A: 1.1, 1.10, 007", &[1.1.into(), written("1.10"), written("007")], &[]);
    check(
        "A: 1.1, 1.10, x, 1.1",
        &[1.1.into(), "1.10".into(), "x".into()],
        &["parameter `A` lists `1.1` twice; both are read as one value"],
    );
    check("A: 1, x, 2m", &[1.into(), "x".into(), "2m".into()], &[]);
    check("A: nan, inf, -infinity", &["nan".into(), "inf".into(), "-infinity".into()], &[]);
    check("A: IF, a:b, c d, \"q\"", &["IF".into(), "a:b".into(), "c d".into(), "\"q\"".into()], &[]);
    check("A: f(x), g (0), h()", &["f(x)".into(), "g (0)".into(), "h()".into()], &[]);
    check("A: a, A, #b", &["a".into(), "A".into(), "#b".into()], &[]);
    check("IF so: [1], (2)x", &["[1]".into(), "(2)x".into()], &[]);
    check("A: x, y, x", &["x".into(), "y".into()], &["parameter `A` lists `x` twice; both are read as one value"]);
    check(
        "A: x|~z (3), y(2)",
        &["x".into(), "y".into()],
        &["only the first alias of a value is used: `x|~z`", "weights are ignored: `x|~z (3)`, `y(2)`"],
    );
    check(
        "A: 1, , (3)",
        &[1.into(), "".into()],
        &[
            "parameter `A` lists the empty word as a value",
            "parameter `A` lists `` twice; both are read as one value",
            "weights are ignored: `(3)`",
        ],
    );
    check("A/@B@x: x@2", &["x@2".into()], &[]);
    let note = "without `:` the name of a parameter ends at the first comma: `A b`";
    check("A b, 1, 2", &[1.into(), 2.into()], &[note]);
    check(
        "\u{feff}A: <none>, b",
        &["<none>".into(), "b".into()],
        &["line 1, column 4: no parameter is called `none`, so `<none>` is read as a value"],
    );
}

#[test]
fn levels_that_are_the_same_number_are_two_levels_of_which_constraints_see_the_number() {
    let model = read("V: 1.1, 1.10, 2.0\nW: 1.100, 2, 03\nIF [V] = 1.10 THEN [W] <> 2;\nIF [V] = [W] THEN [W] < 2;");
    assert_eq!(model.space.levels(), [3, 3]);
    let allowed: Vec<String> = (tests(&model).iter().filter(|(_, allowed)| *allowed))
        .map(|(test, _)| test.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "))
        .collect();
    assert_eq!(allowed, ["1.1 1.100", "1.1 03", "1.10 1.100", "1.10 03", "2.0 1.100", "2.0 03"]);
    for space in [
        Space::from_toml(&model.space.to_toml()).unwrap(),
        serde_json::from_str(&serde_json::to_string(&model.space).unwrap()).unwrap(),
    ] {
        assert_eq!(space, model.space, "a space keeps how its levels are written");
    }
    for (v, w) in [("1.1", "1.100"), ("1.10", "03")] {
        let mut test = paracosm_space::Values::default();
        test.set("V", Value::written(v));
        test.set("W", Value::written(w));
        let point = model.space.encode(&test).unwrap();
        assert_eq!(model.space.decode(&point), test);
        test.set("W", w.parse::<f64>().unwrap());
        assert_eq!(model.space.encode(&test).as_ref(), Ok(&point), "a number is the only level that it can be");
    }
    let one = read("V: 1.0, 1.00");
    let mut test = paracosm_space::Values::default();
    test.set("V", 1.0);
    let refused = one.space.encode(&test).unwrap_err().to_string();
    assert_eq!(refused, "parameter `V`: found 1, expected one of 1.0, 1.00");
}

#[test]
fn no_test_has_two_negative_values() {
    let model = read("A: ~-1, 0, 1\nB: ~-1, 0\nC: x, y\nD: ~bad, ~worse, good\nIF IsNegative(A) THEN [C] = \"x\";");
    assert_eq!(
        constraints(&model),
        ["A == -1 implies C == 'x'", "A == -1 implies B == 0 and D == 'good'", "B == -1 implies D == 'good'",]
    );
    for (test, allowed) in tests(&model) {
        let negatives = [test[0] == (-1).into(), test[1] == (-1).into(), test[3] != "good".into()];
        let few = negatives.iter().filter(|negative| **negative).count() <= 1;
        assert_eq!(allowed, few && (test[0] != (-1).into() || test[2] == "x".into()), "{test:?}");
    }
    assert_eq!(model.demand.negatives, [(0, 0), (1, 0), (3, 0), (3, 1)]);
    assert_eq!(model.notes, [""; 0]);
    let all = read("A: ~1, 2\nB: ~x, y\nIF IsPositive() THEN [B] = \"q\" ELSE NOT IsNegative([B]);");
    let allowed: Vec<_> = tests(&all).into_iter().filter(|(_, allowed)| *allowed).map(|(test, _)| test).collect();
    assert_eq!(allowed, [[1.into(), "y".into()]]);
    assert_eq!(all.notes[0], "line 3, column 28: parameter `B` never has the value `q`");
}

/// A comparison without regard to case, as PICT documents it, and what joins them.
#[derive(Debug, Clone)]
enum Predicate {
    Value(usize, &'static str, usize),
    Parameter(usize, &'static str, usize),
    In(usize, Vec<usize>, bool),
    Like(usize, String, bool),
    Not(Box<Predicate>),
    And(Box<Predicate>, Box<Predicate>),
    Or(Box<Predicate>, Box<Predicate>),
}

const WORDS: [&str; 5] = ["Low", "low", "mid_1", "HIGH", "hill 2"];
const NUMBERS: [&str; 5] = ["-3", "0", "2.5", "10", "1000"];

/// Parameters 0 and 1 take words, 2 and 3 numbers.
fn text_of(parameter: usize, level: usize) -> &'static str {
    if parameter < 2 { WORDS[level] } else { NUMBERS[level] }
}

fn related<T: PartialOrd>(left: T, sign: &str, right: T) -> bool {
    match sign {
        "=" => left == right,
        "<>" => left != right,
        "<" => left < right,
        "<=" => left <= right,
        ">" => left > right,
        _ => left >= right,
    }
}

fn compared(parameter: usize, left: &str, sign: &str, right: &str) -> bool {
    if parameter < 2 {
        related(left.to_lowercase(), sign, right.to_lowercase())
    } else {
        related(left.parse::<f64>().unwrap(), sign, right.parse().unwrap())
    }
}

fn is_like(pattern: &[u8], text: &[u8]) -> bool {
    match pattern.split_first() {
        None => text.is_empty(),
        Some((b'*', rest)) => (0..=text.len()).any(|taken| is_like(rest, &text[taken..])),
        Some((b'?', rest)) => !text.is_empty() && is_like(rest, &text[1..]),
        Some((sign, rest)) => text.first().is_some_and(|t| t.eq_ignore_ascii_case(sign)) && is_like(rest, &text[1..]),
    }
}

impl Predicate {
    fn holds(&self, row: &[&str]) -> bool {
        match self {
            Predicate::Value(p, sign, level) => compared(*p, row[*p], sign, text_of(*p, *level)),
            Predicate::Parameter(p, sign, q) => compared(*p, row[*p], sign, row[*q]),
            Predicate::In(p, levels, denied) => {
                levels.iter().any(|level| compared(*p, row[*p], "=", text_of(*p, *level))) != *denied
            }
            Predicate::Like(p, pattern, denied) => is_like(pattern.as_bytes(), row[*p].as_bytes()) != *denied,
            Predicate::Not(part) => !part.holds(row),
            Predicate::And(a, b) => a.holds(row) && b.holds(row),
            Predicate::Or(a, b) => a.holds(row) || b.holds(row),
        }
    }

    fn write(&self) -> String {
        let value = |p: usize, level: usize| {
            if p < 2 { format!("\"{}\"", text_of(p, level).to_uppercase()) } else { text_of(p, level).to_owned() }
        };
        let not = |denied: bool| if denied { "not " } else { "" };
        match self {
            Predicate::Value(p, sign, level) => format!("[p{p}] {sign} {}", value(*p, *level)),
            Predicate::Parameter(p, sign, q) => format!("[P{p}]{sign}[p{q}]"),
            Predicate::In(p, levels, denied) => {
                let listed: Vec<_> = levels.iter().map(|level| value(*p, *level)).collect();
                format!("[P{p}] {}In {{{}}}", not(*denied), listed.join(" ,"))
            }
            Predicate::Like(p, pattern, denied) => format!("[P{p}] {}like \"{pattern}\"", not(*denied)),
            Predicate::Not(part) => format!("NOT ({})", part.write()),
            Predicate::And(a, b) => format!("({} and {})", a.write(), b.write()),
            Predicate::Or(a, b) => format!("({}\n OR {})", a.write(), b.write()),
        }
    }
}

fn predicate() -> impl Strategy<Value = Predicate> {
    let sign = || prop::sample::select(vec!["=", "<>", "<", "<=", ">", ">="]);
    let leaf = prop_oneof![
        (0..4usize, sign(), 0..5usize).prop_map(|(p, sign, level)| Predicate::Value(p, sign, level)),
        (0..4usize, sign(), 0..2usize).prop_map(|(p, sign, q)| Predicate::Parameter(p, sign, p / 2 * 2 + q)),
        (0..4usize, prop::collection::vec(0..5usize, 1..4), any::<bool>())
            .prop_map(|(p, levels, denied)| Predicate::In(p, levels, denied)),
        (0..2usize, "[lowh*?id_ 12]{0,5}", any::<bool>())
            .prop_map(|(p, pattern, denied)| Predicate::Like(p, pattern, denied)),
    ];
    leaf.prop_recursive(3, 12, 2, |inner| {
        let two = || (inner.clone(), inner.clone()).prop_map(|(a, b)| (Box::new(a), Box::new(b)));
        prop_oneof![
            inner.clone().prop_map(|part| Predicate::Not(Box::new(part))),
            two().prop_map(|(a, b)| Predicate::And(a, b)),
            two().prop_map(|(a, b)| Predicate::Or(a, b)),
        ]
    })
}

proptest! {
    #[test]
    fn constraints_mean_what_their_comparisons_mean(
        levels in [
            prop::sample::subsequence(vec![0, 1, 2, 3, 4], 1..=5), prop::sample::subsequence(vec![0, 1, 2, 3, 4], 1..=5),
            prop::sample::subsequence(vec![0, 1, 2, 3, 4], 1..=5), prop::sample::subsequence(vec![0, 1, 2, 3, 4], 1..=5),
        ],
        condition in predicate(), consequence in predicate(), otherwise in prop::option::of(predicate()), invariant in predicate()
    ) {
        let mut text = String::new();
        for (p, levels) in levels.iter().enumerate() {
            let listed: Vec<_> = levels.iter().map(|level| text_of(p, *level)).collect();
            text += &format!("p{p}: {}\n", listed.join(","));
        }
        text += &format!("IF {} THEN {}", condition.write(), consequence.write());
        text += &otherwise.as_ref().map(|otherwise| format!(" else {}", otherwise.write())).unwrap_or_default();
        text += &format!(";\n{};", invariant.write());
        let model = read(&text);
        for (values, allowed) in tests(&model) {
            let row: Vec<String> = values.iter().map(ToString::to_string).collect();
            let row: Vec<&str> = row.iter().map(String::as_str).collect();
            let branch = if condition.holds(&row) { Some(&consequence) } else { otherwise.as_ref() };
            let expected = branch.is_none_or(|branch| branch.holds(&row)) && invariant.holds(&row);
            prop_assert_eq!(allowed, expected, "{} {:?}", text, row);
        }
    }

    #[test]
    fn any_text_is_a_model_or_an_error_within_it(
        text in prop_oneof![
            ".{0,60}",
            "([a-c:,~|<>@ ]|\n){0,40}",
            "(a: 1, 2\n)?(b: x, y|z, ~w \\(3\\)\n)?(\\{a, b\\} @ 2\n)?((IF |THEN |ELSE |NOT |AND |OR |IN |LIKE |IsNegative)|[a-b;=<>(){},\"\\[\\]0-9#\\\\]|\\[a\\]|\\[b\\] = \"x\"|\n){0,24}",
        ]
    ) {
        if let Err(error) = Model::from_pict(&text) {
            prop_assert!(error.line >= 1 && error.line <= text.matches('\n').count() + 1, "{:?} {}", text, error);
            prop_assert!(error.column >= 1);
        }
    }

    #[test]
    fn a_model_with_a_sign_changed_is_a_model_or_an_error(at in 0..200usize, sign in prop::sample::select(vec!["", " ", ";", "[", "]", "\"", "(", ")", "{", "\\", "é", "\n", "#", "~", ":"])) {
        let model = "Äpfel: ~1, 2 (3), 3\nB: x|y, <Äpfel>, zz\n{Äpfel, B} @ 2\nIF NOT [B] = \"x\" AND ([Äpfel] >= 2 OR IsNegative(Äpfel)) THEN [B] LIKE \"?*\" ELSE [Äpfel] IN {2, 3};\n[B] <> \"zz\";\n";
        let mut signs: Vec<String> = model.chars().map(String::from).collect();
        if let Some(changed) = signs.get_mut(at) {
            *changed = sign.to_owned();
        }
        if let Err(error) = Model::from_pict(&signs.concat()) {
            prop_assert!(!error.flaw.to_string().is_empty());
        }
    }
}

#[test]
fn a_constraint_as_deep_as_is_read_is_understood() {
    let deep =
        format!("A: 1, 2\nIF {0}[A] = 1{1} THEN {0}[A] = 1{1} ELSE {0}[A] = 2{1};", "NOT (".repeat(23), ")".repeat(23));
    assert!(tests(&read(&deep)).iter().all(|(_, allowed)| *allowed));
}

#[test]
fn a_constraint_that_is_too_complex_is_found_where_it_begins() {
    let mut text: String = (0..60).map(|i| format!("p{i}: 0, 1\n")).collect();
    let pairs: Vec<_> = (0..30).map(|i| format!("([p{}] = 1 AND [p{}] = 1)", 2 * i, 2 * i + 1)).collect();
    text += &format!("[p0] = 0 OR [p0] = 1;\n{};", pairs.join("\n OR "));
    let error = Model::from_pict(&text).unwrap_err();
    assert_eq!((error.line, error.column), (62, 1));
    assert!(error.to_string().contains("too many clauses"), "{error}");
}

#[test]
fn a_value_that_no_test_has_is_noted() {
    let model = read("Weather: clear, fog\nLanes: 2, 4\nIF [Weather] = \"fogg\" THEN [Lanes] IN {2, 3};");
    assert_eq!(
        model.notes,
        [
            "line 3, column 16: parameter `Weather` never has the value `fogg` (did you mean `fog`?)",
            "line 3, column 43: parameter `Lanes` never has the value `3`"
        ]
    );
    assert!(tests(&model).iter().all(|(_, allowed)| *allowed));
}

#[test]
fn statements_are_kept_with_the_lines_where_they_begin() {
    let model = read("A: ~-1, 2\nB: ~-1, 2\n# [A] = 2;\nIF [A] = 2\n\n  THEN [B] = 2;  [B] < 9;\n(\n[A] < 9);");
    let statements = [(4, "IF [A] = 2 THEN [B] = 2;"), (6, "[B] < 9;"), (7, "( [A] < 9);")];
    assert_eq!(model.statements, statements.map(|(line, statement)| (line, statement.to_owned())));
    assert_eq!(model.space.constraints().len(), 4);
}
