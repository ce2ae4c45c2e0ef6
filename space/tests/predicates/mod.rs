//! Random conditions of PICT models on two parameters with words and two with numbers, and their values.

use proptest::prelude::*;

/// Comparisons that ignore case, as PICT documents them, and their combinations.
#[derive(Debug, Clone)]
pub enum Predicate {
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
pub fn text_of(parameter: usize, level: usize) -> &'static str {
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
        related(left.to_uppercase(), sign, right.to_uppercase())
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
    pub fn holds(&self, row: &[&str]) -> bool {
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

    pub fn write(&self) -> String {
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

pub fn predicate() -> impl Strategy<Value = Predicate> {
    let sign = || prop::sample::select(vec!["=", "<>", "<", "<=", ">", ">="]);
    let leaf = prop_oneof![
        (0..4usize, sign(), 0..5usize).prop_map(|(p, sign, level)| Predicate::Value(p, sign, level)),
        (0..4usize, sign()).prop_map(|(p, sign)| Predicate::Parameter(p, sign, p ^ 1)),
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
