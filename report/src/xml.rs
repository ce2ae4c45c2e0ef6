//! Text for SVG files, which may have only the characters of XML.

/// Returns a text with the replacement character U+FFFD in place of characters that XML does not have (Extensible
/// Markup Language 1.0, section 2.2). A reader would refuse a file with such a character.
pub(crate) fn xml_text(text: String) -> String {
    let is_xml = |c: char| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..);
    if text.chars().all(is_xml) {
        return text;
    }
    text.chars().map(|c| if is_xml(c) { c } else { '\u{fffd}' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_that_xml_does_not_have_are_replaced() {
        assert_eq!(xml_text("a\u{7}b\u{0}\u{ffff}\tc".to_owned()), "a\u{fffd}b\u{fffd}\u{fffd}\tc");
        let plain = "<text>é, 東, \u{1f600}</text>\n".to_owned();
        assert_eq!(xml_text(plain.clone()), plain);
    }
}
