//! Model files: what they hold, against an evaluation of their constraints by hand.

mod predicates;

use paracosm_space::constraint::Constraint;
use paracosm_space::pict::Model;
use paracosm_space::{Point, Space, Value};
use predicates::{predicate, text_of};
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
            "tests are made with the first name of a value only: `ext4 | ext3`",
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
        &["tests are made with the first name of a value only: `x|~z`", "weights are ignored: `x|~z (3)`, `y(2)`"],
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
    let huge = read("V: 40000000000000000, 4e16, -0, 0, x").space;
    assert_eq!(Space::from_toml(&huge.to_toml()), Ok(huge), "huge numbers and both zeros are read as they are written");
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

#[test]
fn words_are_ordered_by_their_upper_case_letters_as_in_pict() {
    // `_` stands after the upper-case letters and before the lower-case letters.
    let model = read("A: a_b, aB, ac\nB: a_b, aB, ac\nIF [A] < \"aB\" THEN [B] = \"ac\";");
    assert_eq!(tests(&model).iter().filter(|(_, allowed)| *allowed).count(), 9);
}

#[test]
fn a_constraint_or_a_sub_model_on_an_unknown_parameter_is_ignored_with_a_note() {
    let model = read(
        "A: 1, 2\nB: x, y\n{A, Bee} @ 2\n\
         IF [Aa] = 1 AND ([B] = \"x\" OR [C] IN {1, 2}) THEN [B] = \"y\";\n\
         IF [B] = \"x\" THEN [A] = [D];\nIF IsNegative(E) THEN [A] = 1;\n[A] = 1;",
    );
    assert_eq!(constraints(&model), ["A == 1"]);
    assert_eq!(model.statements.len(), 1);
    assert_eq!(model.demand.groups, []);
    assert_eq!(
        model.notes,
        [
            "line 3, column 5: no parameter is called `Bee`, so this sub-model is ignored",
            "line 4, column 4: no parameter is called `Aa` (did you mean `A`?), so this constraint is ignored",
            "line 5, column 25: no parameter is called `D`, so this constraint is ignored",
            "line 6, column 15: no parameter is called `E`, so this constraint is ignored",
        ]
    );
}

#[test]
fn a_sub_model_may_name_a_parameter_twice() {
    let model = read("A: 1, 2\nB: x, y\n{B, A, b} @ 2");
    assert_eq!(model.demand.groups, [(vec![0, 1], 2)]);
    assert_eq!(model.notes, ["line 3, column 8: the sub-model names `b` twice, which changes nothing"]);
}

#[test]
fn statements_that_pict_refuses_are_refused() {
    let parameters = "A: a, b\nB: a, b\n";
    for (statement, says) in [
        (
            "[A] = [a];",
            "line 3, column 5: parameter `A` is compared with itself, expected another parameter or a value",
        ),
        ("[A] = \"a\\a\";", "line 3, column 7: found `\\a`, expected `\\\\`, `\\\"` or `\\]`"),
        ("IsPositive();", "line 3, column 14: found no `:`"),
        ("NOT [A] = \"a\";", "line 3, column 15: found no `:`"),
    ] {
        let refused = Model::from_pict(&format!("{parameters}{statement}\n")).unwrap_err().to_string();
        assert!(refused.starts_with(says), "{refused}");
    }
    read(&format!("{parameters}[A] = \"a\\\"b\" OR [B] = \"a\\\\\";\nNOT [A] = \"x\";"));
}

#[test]
fn aliases_of_values_are_known() {
    let model = read("A: ~x | Long name|L, y\nB: z");
    assert_eq!(model.space.levels(), [2, 1]);
    assert_eq!(["long NAME", "L", " l "].map(|alias| model.aliases.level(0, alias)), [Some(0); 3]);
    assert_eq!((model.aliases.level(0, "x"), model.aliases.level(1, "L")), (None, None));
}

#[test]
fn models_with_many_values_are_read_in_time_that_grows_with_their_length() {
    let words = |n: usize| (0..n).map(|i| format!("w{i}")).collect::<Vec<_>>().join(", ");
    let model = read(&format!("A: {0}\nB: 1, 2\nIF [A] IN {{{1}}} THEN [B] = 1;\n", words(200_000), {
        (0..50_000).map(|i| format!("\"W{}\"", 3 * i)).collect::<Vec<_>>().join(", ")
    }));
    assert_eq!(model.space.levels(), [200_000, 2]);
    let doubled: String = (1..40).map(|i| format!("P{i}: <P{}>, <P{}>, x{i}\n", i - 1, i - 1)).collect();
    assert_eq!(read(&format!("P0: a, b\n{doubled}")).space.levels()[39], 41);
    let many: String = (0..11).map(|i| format!("Q{i}: <A>\n")).collect();
    let refused = Model::from_pict(&format!("A: {}\n{many}", words(100_000))).unwrap_err().to_string();
    assert!(refused.contains("more than 1000000 values, which is the limit"), "{refused}");
}
