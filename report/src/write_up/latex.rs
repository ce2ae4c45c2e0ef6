//! Words and numbers in LaTeX.

use paracosm_analysis::statistics::Versus;

/// Up to which corrected p-value a difference is marked.
pub const LEVEL: f64 = 0.05;

/// A ratio with its interval, how often it is better, and the corrected p-value: three columns.
pub fn ratio(versus: &Versus) -> String {
    let [low, high] = versus.interval;
    format!("${:.2}$ $[{low:.2}, {high:.2}]$ & ${:.2}$ & {}", versus.ratio, versus.better, p_value(versus.p_holm))
}

/// A p-value.
pub fn p_value(p: f64) -> String {
    if p < 1e-4 { "$<10^{-4}$".into() } else { format!("${p:.4}$") }
}

/// A number in a formula: `1.23e-5` with its power of ten.
pub fn in_math(number: &str) -> String {
    number.split_once('e').map_or_else(|| number.to_owned(), |(m, e)| format!("{m} \\cdot 10^{{{e}}}"))
}

/// Text in which nothing means anything to LaTeX.
pub fn escaped(text: &str) -> String {
    let escape = |c: char| match c {
        '&' | '%' | '$' | '#' | '_' | '{' | '}' => format!("\\{c}"),
        '~' => "\\textasciitilde{}".into(),
        '^' => "\\textasciicircum{}".into(),
        '\\' => "\\textbackslash{}".into(),
        c => c.to_string(),
    };
    text.chars().map(escape).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_latex_would_read_as_a_command_is_escaped() {
        assert_eq!(escaped("l2_star 50 % & {x}"), "l2\\_star 50 \\% \\& \\{x\\}");
        assert_eq!(escaped("a\\b^c~d"), "a\\textbackslash{}b\\textasciicircum{}c\\textasciitilde{}d");
        assert_eq!(in_math("1.23e-5"), "1.23 \\cdot 10^{-5}");
        assert_eq!(in_math("0.0405"), "0.0405");
    }
}
