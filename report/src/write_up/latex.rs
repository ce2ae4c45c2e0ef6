//! Formats text and numbers for LaTeX.

use paracosm_analysis::statistics::Versus;

/// The greatest corrected p-value at which a difference is marked as significant.
pub const LEVEL: f64 = 0.05;

/// Returns three columns of a LaTeX table, which are a ratio with its interval, the probability of a better result, and
/// the corrected p-value.
pub fn ratio(versus: &Versus) -> String {
    let [low, high] = versus.interval;
    format!("${:.2}$ $[{low:.2}, {high:.2}]$ & ${:.2}$ & {}", versus.ratio, versus.better, p_value(versus.p_holm))
}

/// Formats a p-value for LaTeX.
pub fn p_value(p: f64) -> String {
    if p < 1e-4 { "$<10^{-4}$".into() } else { format!("${p:.4}$") }
}

/// Formats a number for a LaTeX formula, so that `1.23e-5` becomes `1.23 \cdot 10^{-5}`.
pub fn in_math(number: &str) -> String {
    number.split_once('e').map_or_else(|| number.to_owned(), |(m, e)| format!("{m} \\cdot 10^{{{e}}}"))
}

/// Escapes all characters of a text that have a special meaning in LaTeX.
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
