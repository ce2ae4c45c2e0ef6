//! What the errors of constraints and of model files say, word by word.

mod common;

use common::drive;
use paracosm_space::pict::Model;
use paracosm_space::{Position, Space, SpaceError};

#[test]
fn what_is_wrong_with_a_constraint_is_said_with_the_column() {
    let check = |text: &str, column: usize, expected: &str| match drive().with_constraints([text]) {
        Err(SpaceError::Constraint { error, .. }) => {
            assert_eq!((error.offset + 1, error.to_string().as_str()), (column, expected), "{text}");
        }
        other => panic!("{text}: {other:?}"),
    };
    check("", 1, "found the end of the constraint, expected a parameter, `not` or `(`");
    check("weathr == 'fog'", 1, "no parameter is called `weathr` (did you mean `weather`?)");
    check("lanes == 2 implies wether != 'fog'", 20, "no parameter is called `wether` (did you mean `weather`?)");
    let continuous = "`speed` is continuous, so hardly any test keeps an equation with it; expected a discrete parameter, or one of `!=`, `<`, `<=`, `>` and `>=`";
    check("speed == 3", 1, continuous);
    check("lanes == speed", 10, continuous);
    check("not lanes != speed", 14, continuous);
    check("speed != lanes implies lanes == 2", 1, continuous);
    check("speed * 2 == lanes", 1, continuous);
    check("speed + 1 == lanes", 1, continuous);
    check("speed in [3]", 1, continuous);
    check("speed < 'fog'", 9, "`<` compares numbers, found 'fog'");
    check("speed < gear", 9, "only numbers can be computed with, but `gear` takes the word 'auto'");
    check("2 * gear < 3", 1, "only numbers can be computed with, but `gear` takes the word 'auto'");
    check("lanes + 'fog' < 3", 9, "found the word 'fog', expected a number or a parameter with numbers");
    check("'fog' + lanes < 3", 1, "found the word 'fog', expected a number or a parameter with numbers");
    check("lanes + 1 == 'fog'", 14, "found the word 'fog', expected a number or a parameter with numbers");
    check("lanes + < 3", 9, "found `<`, expected a number, a parameter, a function or `(`");
    check("lanes + 2 in [3]", 1, "found `lanes + 2`, expected the name of a parameter before `in`");
    check(
        "lanes + 2",
        10,
        "found the end of the constraint, expected a comparison (`==`, `!=`, `<`, `<=`, `>`, `>=` or `in`)",
    );
    check("1 + 2 < 3 + 4", 1, "found values on both sides of the comparison, expected a parameter on one side");
    check("(lanes + 2 < 3", 1, "the `(` here has no closing `)`");
    check("min(lanes 2) < 3", 11, "found `2`, expected an operator or `,`");
    check("abs(lanes, 2) < 3", 10, "found `,`, expected an operator or `)`");
    check(
        "maxi(lanes, 2) < 3",
        1,
        "no function is called `maxi` (did you mean `max`?); the functions are min, max, abs, sqrt, pow, floor, ceil, round, \
         sign, sin, cos, tan, asin, acos, atan",
    );
    check("lanes + sped > 2", 1, "no parameter is called `sped` (did you mean `speed`?)");
    let deep = format!("{}lanes < 3", "-".repeat(1000));
    check(&deep, 129, "the constraint has more than 128 levels of nesting; divide it into several constraints");
    let long = format!("lanes{} < 3", " + speed".repeat(1001));
    check(
        &long,
        8007,
        "the comparison has more than 1000 operators `+ - * / %`, expected fewer; a new parameter can replace a part of it",
    );
    check("speed ** 2 < 3", 7, "found `**`, expected `pow(a, b)`");
    check("speed^2 < 3", 6, "found `^`, expected `pow(a, b)`");
    check("speed \u{2212} 2 < 3", 7, "found `\u{2212}`, expected `-`");
    check(
        "weather == 'fogg'",
        12,
        "`weather` never has the value 'fogg', expected one of 'clear', 'rain', 'fog' (did you mean `'fog'`?)",
    );
    check(
        "weather in ['rain', 'snow']",
        21,
        "`weather` never has the value 'snow', expected one of 'clear', 'rain', 'fog'",
    );
    check("lanes != 3", 10, "`lanes` never has the value 3, expected one of 2, 4, 6");
    check("many == 10", 9, "`many` never has the value 10, expected one of 0, 1, 2, 3, 4, 5, 6, 7, .. (9 in all)");
    check("lanes == '2'", 10, "`lanes` never has the value '2', expected one of 2, 4, 6 (did you mean `2`?)");
    check("weather == fog", 12, "no parameter is called `fog`; to compare with the level of `weather`, write 'fog'");
    check("weather < 'fog'", 1, "`<` compares numbers, but `weather` takes the word 'clear'");
    check("gear >= 1", 1, "`>=` compares numbers, but `gear` takes the word 'auto'");
    check("not gear >= 1", 5, "`>=` compares numbers, but `gear` takes the word 'auto'");
    check("lanes > 2 implies open == 1 or lanes < gear", 38, "`<` compares numbers, but `gear` takes the word 'auto'");
    check("lanes < gear implies open == 1", 7, "`<` compares numbers, but `gear` takes the word 'auto'");
    check("lanes < 'fog'", 9, "`<` compares numbers, found 'fog'");
    check("lanes <= gear", 7, "`<=` compares numbers, but `gear` takes the word 'auto'");
    check("weather != lanes", 9, "`weather` and `lanes` have no value in common, so they are never equal");
    check("lanes = 2", 7, "found `=`, expected `==`");
    check("lanes => 2", 7, "found `=>`, expected `>=` or `implies`");
    check("lanes <> 2", 7, "found `<>`, expected `!=`");
    check("lanes == 2 && open == 1", 12, "found `&&`, expected `and`");
    check("!(lanes == 2)", 1, "found `!`, expected `not` or `!=`");
    check("lanes in {2, 4}", 10, "found `{`, expected `(`, or `[` around a list");
    check("lanes in (2, 4)", 10, "found `(`, expected a list like [1, 2] or ['rain', 'fog']");
    check("lanes in [2 4]", 13, "found `4`, expected `,` or `]`");
    check("lanes in [2, open]", 14, "found `open`, expected a number or a quoted word");
    check("lanes in [2,", 13, "found the end of the constraint, expected a number or a quoted word");
    check("2 in [2]", 1, "found `2`, expected the name of a parameter before `in`");
    check("2 == 2", 1, "found values on both sides of the comparison, expected a parameter on one side");
    check("lanes 2", 7, "found `2`, expected a comparison (`==`, `!=`, `<`, `<=`, `>`, `>=` or `in`)");
    check("lanes ==", 9, "found the end of the constraint, expected a number, a quoted word or a parameter");
    check("lanes not 2", 11, "found `2`, expected `in`");
    check("1 < open < 3", 10, "comparisons do not chain: join two of them with `and`");
    check("(lanes == 2", 1, "the `(` here has no closing `)`");
    check("(lanes == 2 open == 1)", 13, "found `open`, expected `and`, `or`, `implies` or `)`");
    check("lanes == 2)", 11, "found `)` without an opening `(`");
    check(
        "lanes == 2 AND open == 1",
        12,
        "found `AND`, expected `and`, `or`, `implies` or the end of the constraint (did you mean `and`?)",
    );
    check(
        "lanes == 2 implis open == 1",
        12,
        "found `implis`, expected `and`, `or`, `implies` or the end of the constraint (did you mean `implies`?)",
    );
    check("weather == 'fog", 12, "the word that begins here has no closing '");
    check("[road surface == 'dry'", 1, "the name that begins here has no closing `]`");
    check(
        "road surface == 'dry'",
        6,
        "found `surface`, expected a comparison (`==`, `!=`, `<`, `<=`, `>`, `>=` or `in`)",
    );
    check(
        "lanes == 2m",
        10,
        "found `2m`, expected a finite number; write a name that begins like a number in brackets",
    );
    check(
        "lanes == 1e999",
        10,
        "found `1e999`, expected a finite number; write a name that begins like a number in brackets",
    );
    check(
        "lanes; open",
        6,
        "found `;`, which has no meaning here; names with other characters than letters, digits, `_` and `.` stand in brackets: [road surface]",
    );
    let deep = format!("{}lanes == 2{}", "(".repeat(1000), ")".repeat(1000));
    check(&deep, 129, "the constraint has more than 128 levels of nesting; divide it into several constraints");
    let deep = format!("{}lanes == 2", "not ".repeat(1000));
    check(&deep, 4001, "the constraint has more than 128 levels of nesting; divide it into several constraints");
    let long = vec!["lanes == 2"; 1000].join(" implies ");
    check(
        &long,
        128 * 19 + 1,
        "the constraint has more than 128 levels of nesting; divide it into several constraints",
    );
}

#[test]
fn the_place_of_an_error_is_given_in_the_lines_of_the_file() {
    let check = |constraints: &str, at: Option<(usize, usize)>, expected: &str| {
        let toml = format!("constraints = {constraints}\n[[parameter]]\nname = \"lanes\"\nchoice = [2, 4]\n");
        match Space::from_toml(&toml) {
            Err(error @ SpaceError::Constraint { .. }) => {
                let found = error.at().map(|Position { line, column }| (line, column));
                assert_eq!((error.to_string().as_str(), found), (expected, at), "{toml}");
            }
            other => panic!("{toml}: {other:?}"),
        }
    };
    let three = "`lanes` never has the value 3, expected one of 2, 4";
    check("['lanes == 3']", Some((1, 26)), three);
    check("[\n  \"lanes == 2\",\n  \"lanes == 3\"]", Some((3, 13)), three);
    check(r#"["\u006canes  \t== 3"]"#, Some((1, 34)), three);
    check(r#"['''lanes == 3''']"#, Some((1, 28)), three);
    check("[\"\"\"\nlanes ==\n3\"\"\"]", Some((1, 16)), three);
    check("[\"lanes == \\\"é\\\" or lanes ~ 3\"]", Some((1, 41)), "found `~`, expected `not` or `!=`");
}

#[test]
fn the_lines_of_constraints_are_known() {
    let toml = "# A comment.\nconstraints = ['lanes == 2',\n\n  \"\"\"\nlanes\n== 2\"\"\", 'lanes != 4']\n";
    assert_eq!(Space::constraint_lines(toml), [2, 4, 6]);
    assert!(Space::constraint_lines("[[parameter]]\nname = \"lanes\"\n").is_empty());
}

#[test]
fn an_error_of_a_space_made_by_a_program_names_the_constraint() {
    let error = drive().with_constraints(["lanes == 2", "lanes == 3"]).unwrap_err();
    assert!(matches!(&error, SpaceError::Constraint { index: 1, .. }), "{error:?}");
    assert_eq!(
        error.to_string(),
        "constraint `lanes == 3`, column 10: `lanes` never has the value 3, expected one of 2, 4, 6"
    );
}

#[test]
fn what_is_wrong_with_a_model_is_said_with_line_and_column() {
    let check = |text: &str, at: (usize, usize), expected: &str| match Model::from_pict(text) {
        Err(error) => {
            assert_eq!(((error.line, error.column), error.flaw.to_string().as_str()), (at, expected), "{text}");
        }
        Ok(model) => panic!("{text}: {model:?}"),
    };
    check("", (1, 1), "found no parameters, expected a line like `Weather: clear, rain, fog`");
    check("# A: 1\n[A] = 1;", (2, 1), "found no parameters, expected a line like `Weather: clear, rain, fog`");
    check("A: 1\n Size 1 2", (2, 10), "found no `:`, expected a `:` between the name of a parameter and its values");
    check(
        "A: 1\nIFF [A] = 1 THEN [A] = 2;",
        (2, 26),
        "found no `:`, expected a `:` between the name of a parameter and its values, or a constraint that begins with IF, [ or (",
    );
    check(
        "A: 1\nIFF [A] in {1, 2};",
        (2, 19),
        "found no `:`, expected a `:` between the name of a parameter and its values, or a constraint that begins with IF, [ or (",
    );
    check(" : 1, 2", (1, 2), "found no name before `:`, expected the name of a parameter");
    for text in ["A:  \nB: 1", "A: ,\nB: 1", "A: , ,"] {
        let end = text.lines().next().unwrap().trim_end().len() + 1;
        check(text, (1, end), "found no values, expected the values of parameter `A`, with commas between them");
    }
    check("A: 1\nB: ~x, ~2", (2, 4), "every value of parameter `B` is negative (`~`), expected a value without `~`");
    check("A: 1\n$R: x", (2, 1), "`$R` is a result parameter, which is not supported");
    check(
        "A @ 2: 1",
        (1, 3),
        "the order of a parameter is not supported, expected the order of a sub-model: `{A, B, C} @ 3`",
    );
    check("OS: 1\n os: 2", (2, 2), "parameter `OS` is declared twice; case makes no difference");
    check("V: 1.1, ~1.10", (1, 9), "`1.10` is listed with and without `~`");
    check("Speed: 1, 2\nW: 3, <Spede>", (2, 7), "no parameter is called `Spede` (did you mean `Speed`?)");
    check("W: 3, <V>\nV: 1, 2", (1, 7), "found `<V>` above parameter `V`, expected the reference below the parameter");
    check("V: 1, ~1", (1, 7), "`1` is listed with and without `~`");

    let check = |rest: &str, at: (usize, usize), expected: &str| {
        check(&format!("Weather: clear, fog\nLanes: 2, 4\nFront lanes: 2, 6\n{rest}"), (at.0 + 3, at.1), expected);
    };
    check(
        "{Weather, Lanes} @ 3",
        (1, 20),
        "found `3`, expected an order from 1 to 2, the number of parameters in the sub-model",
    );
    check(
        "{Weather, Lanes} @",
        (1, 19),
        "found nothing, expected an order from 1 to 2, the number of parameters in the sub-model",
    );
    check("{Weather, Lanes} 2", (1, 18), "found `2`, expected `@` and the order of the sub-model");
    check("{Weather,}", (1, 10), "found no name, expected a parameter of the sub-model");
    check("{Weather, Lanes", (1, 16), "found no `}`, expected `}` after the names of a sub-model");
    check(
        "{Weather, Lanes}\nB: 1",
        (2, 1),
        "found a parameter after a sub-model; parameters come first, then sub-models, then constraints",
    );
    check(
        "[Lanes] = 2;\nB: 1",
        (2, 1),
        "found a parameter after a constraint; parameters come first, then sub-models, then constraints",
    );
    check(
        "[Lanes] = 2;\n{Lanes}",
        (2, 1),
        "found a sub-model after a constraint; parameters come first, then sub-models, then constraints",
    );

    check("IF [Weather] = \"fog\"\n  [Lanes] = 2;", (2, 3), "found `[Lanes]`, expected `AND`, `OR` or `THEN`");
    check(
        "IF [Weather] = \"fog\" THAN [Lanes] = 2;",
        (1, 22),
        "found `THAN`, expected `AND`, `OR` or `THEN` (did you mean `THEN`?)",
    );
    check(
        "IF [Weather] = \"fog\" THEN [Lanes] = 2",
        (1, 38),
        "found the end of the model, expected `AND`, `OR`, `ELSE` or `;`",
    );
    check("[Lanes] = 2\n[Lanes] = 4;", (2, 1), "found `[Lanes]`, expected `AND`, `OR` or `;`");
    check(
        "[Lanes] = 2;\nFI [Lanes] = 2;",
        (2, 1),
        "found `FI`, expected `IF`, `NOT`, `(` or a parameter in brackets (did you mean `IF`?)",
    );
    check("IF Lanes = 2 THEN [Lanes] = 2;", (1, 4), "found `Lanes`, expected a parameter in brackets: [Lanes]");
    check("IF (2 = 2) THEN [Lanes] = 2;", (1, 5), "found `2`, expected a parameter in brackets, `NOT` or `(`");
    check("[Weather] = fog;", (1, 13), "found `fog`, expected a value; words stand in quotes: \"fog\"");
    check("[Weather] = 'fog';", (1, 13), "found `'`, expected `\"`");
    check("[Weather] = 3;", (1, 13), "found `3`, but parameter `Weather` takes words; write words in quotes");
    check(
        "[Lanes] = \"2\";",
        (1, 11),
        "found `\"2\"`, but parameter `Lanes` takes numbers only; write numbers without quotes",
    );
    check("[Lanes] = ;", (1, 11), "found `;`, expected a number or a parameter in brackets");
    check("[Weather] = );", (1, 13), "found `)`, expected a word in quotes or a parameter in brackets");
    check("[Lanes] == 2;", (1, 9), "found `==`, expected `=`");
    check("[Lanes] != 2;", (1, 9), "found `!=`, expected `<>`");
    check("[Lanes] = 2 && [Lanes] = 4;", (1, 13), "found `&&`, expected `AND`");
    check("[Lanes] 2;", (1, 9), "found `2`, expected `=`, `<>`, `<`, `<=`, `>`, `>=`, `IN` or `LIKE`");
    check("[Lanes] = 2x;", (1, 11), "found `2x`, expected a finite number");
    check("[Lanes] LIKE \"2*\";", (1, 9), "`LIKE` compares words, but `Lanes` takes numbers only");
    check("[Weather] LIKE fog;", (1, 16), "found `fog`, expected a pattern in quotes");
    check("[Weather] NOT \"fog\";", (1, 15), "found `\"fog\"`, expected `IN` or `LIKE`");
    check("[Lanes] IN 2;", (1, 12), "found `2`, expected `{` and the values");
    check("[Lanes] IN {2; 4};", (1, 14), "found `;`, expected `,` or `}`");
    check(
        "[Lanes] = [Weather];",
        (1, 9),
        "`Lanes` takes numbers and `Weather` takes words; numbers and words cannot be compared",
    );
    check("([Lanes] = 2;", (1, 13), "found `;`, expected `AND`, `OR` or `)`");
    check("([Lanes] = 2", (1, 1), "the `(` here has no closing `)`");
    check("IF IsNegative Lanes;", (1, 15), "found `Lanes`, expected `(`");
    check(
        "[Lanes] = 2;\nB: a/b",
        (2, 1),
        "found a parameter after a constraint; parameters come first, then sub-models, then constraints",
    );
    check("[Lanes] 2;\n^", (1, 9), "found `2`, expected `=`, `<>`, `<`, `<=`, `>`, `>=`, `IN` or `LIKE`");
    check("[Lanes] IN {2, ^};", (1, 16), "found `^`, which has no meaning in a constraint");
    check("IF IsNegative(^);", (1, 15), "found `^`, which has no meaning in a constraint");
    check("IF IsNegative(Lanes;", (1, 20), "found `;`, expected `)`");
    check("[Weather] = \"fog;", (1, 13), "the word that begins here has no closing `\"`");
    check("[Weather = \"fog\";", (1, 1), "the name that begins here has no closing `]`");
    check("[Lanes] = 2; # two", (1, 14), "found `#`, which begins a comment only at the start of a line");
    check("[Lanes] = 2 ^ 3;", (1, 13), "found `^`, which has no meaning in a constraint");
    let deep = format!("{}[Lanes] = 2{};", "(".repeat(1000), ")".repeat(1000));
    check(&deep, (1, 49), "the constraint has more than 48 levels of nesting; divide it into several constraints");
    let deep = format!("IF {}[Lanes] = 2;", "NOT ".repeat(1000));
    check(&deep, (1, 196), "the constraint has more than 48 levels of nesting; divide it into several constraints");
}
