//! Breaks texts that are wider than a picture into lines, and cuts them if the lines do not suffice.

use plotters::coord::Shift;
use plotters::prelude::*;

/// The ratio of the drawn width of a text to the width that plotters assumes. Plotters measures by the height of the
/// font, of which Open Sans has 1.362 in an em, and writes a font's size as 1.24 of an em.
const WIDER: f64 = 1.1;

/// The mark that stands for the rest of a text that was cut.
const REST: &str = " ..";

/// The lines of a text, or the reason why the text could not be measured.
type Lines<B> = std::result::Result<Vec<String>, DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// Breaks a text into at most `most` lines of at most `width` pixels. Text that does not fit is left out, and dots say
/// so.
pub(super) fn wrapped<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    text: &str,
    style: &TextStyle,
    width: f64,
    most: usize,
) -> Lines<B> {
    // A character is at least a pixel wide. To measure a text of millions of characters would take hours.
    let text: String = text.chars().take(most * width as usize + 1).collect();
    let fits = |line: &str| area.estimate_text_size(line, style).map(|(found, _)| WIDER * f64::from(found) <= width);
    let (mut lines, mut line) = (Vec::new(), String::new());
    for word in text.split(' ') {
        let joined = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if line.is_empty() || fits(&joined)? {
            line = joined;
        } else if lines.len() + 1 < most {
            lines.push(std::mem::replace(&mut line, word.to_owned()));
        } else {
            line.push_str(REST);
            break;
        }
    }
    lines.push(line);
    for line in &mut lines {
        // Shortens a line that is too wide because of the dots, or because of a single word wider than the picture.
        if fits(line)? {
            continue;
        }
        let all: Vec<char> = line.trim_end_matches(REST).chars().collect();
        let first = |count: usize| all[..count].iter().collect::<String>().trim_end().to_owned() + REST;
        // The first `low` characters fit, and more than `high` do not.
        let (mut low, mut high) = (0, all.len().saturating_sub(1));
        while low < high {
            let middle = low + (high - low).div_ceil(2);
            if fits(&first(middle))? {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        *line = first(low);
    }
    Ok(lines)
}

#[cfg(test)]
mod tests {
    use super::super::{ink, with_font};
    use super::*;

    /// Returns the lines of a text that is wrapped at 200 pixels.
    fn lines(text: &str, most: usize) -> Vec<String> {
        with_font();
        let mut svg = String::new();
        let area = SVGBackend::with_string(&mut svg, (200, 100)).into_drawing_area();
        let style = ink(15.0);
        let lines = wrapped(&area, text, &style, 200.0, most).unwrap();
        assert!(lines.iter().all(|line| area.estimate_text_size(line, &style).unwrap().0 <= 181), "{lines:?}");
        lines
    }

    #[test]
    fn a_text_stands_whole_in_as_many_lines_as_it_takes() {
        let text = "500 tests, strategy halton; varied too, and averaged over: friction, fog";
        let found = lines(text, 5);
        assert!((2..5).contains(&found.len()) && found.join(" ") == text, "{found:?}");
        assert_eq!(lines("500 tests", 3), ["500 tests"]);
        assert_eq!(lines("", 3), [""]);
    }

    #[test]
    fn of_a_longer_one_the_last_line_says_that_there_is_more() {
        for text in ["one two three four five six seven eight nine ten eleven", &"endless".repeat(20), "x"] {
            let found = lines(text, 1);
            assert!(found.len() == 1 && (found[0] == text || found[0].ends_with(" ..")), "{found:?}");
        }
        let wide = lines(&format!("{} and so on", "endless".repeat(20)), 2);
        assert!(wide[0].ends_with(" ..") && wide[1] == "and so on", "{wide:?}");
    }
}
