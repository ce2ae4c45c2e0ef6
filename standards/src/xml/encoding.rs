//! The characters of a file, whose encoding its first bytes and its XML declaration give.

use super::error::Flaw;

/// Returns the text of a file. Its declaration names the encoding UTF-8, because the text is written in it again.
///
/// The encodings are UTF-8, UTF-16 with its mark, and ISO-8859-1 if the declaration names it.
pub(super) fn text(bytes: Vec<u8>) -> Result<String, Box<Flaw>> {
    let decoded = match bytes.as_slice() {
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ if declared(&bytes).is_some_and(|name| name.eq_ignore_ascii_case("ISO-8859-1")) => {
            Some(bytes.iter().copied().map(char::from).collect())
        }
        _ => {
            return String::from_utf8(bytes)
                .map_err(|error| Box::new(Flaw::NotUtf8 { at: error.utf8_error().valid_up_to() }));
        }
    };
    let mut text: String = decoded.ok_or_else(|| Box::new(Flaw::NotUtf16))?;
    if let Some(name) = declared(text.as_bytes()).map(str::len) {
        let at = text.find(ENCODING).map_or(0, |at| at + ENCODING.len() + 1);
        text.replace_range(at..at + name, "UTF-8");
    }
    Ok(text)
}

const ENCODING: &str = "encoding=";

/// Returns the name of the encoding in the XML declaration; `None` without one.
fn declared(bytes: &[u8]) -> Option<&str> {
    let end = bytes.windows(2).position(|pair| pair == b"?>")?;
    let declaration = str::from_utf8(&bytes[..end]).ok().filter(|text| text.starts_with("<?xml"))?;
    let (_, after) = declaration.split_once(ENCODING)?;
    let quote = after.chars().next().filter(|sign| ['"', '\''].contains(sign))?;
    after[1..].split_once(quote).map(|(name, _)| name)
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Option<String> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let units: Vec<u16> = pairs.iter().copied().map(unit).collect();
    rest.is_empty().then(|| String::from_utf16(&units).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_gives_the_same_text_in_utf_8() {
        let written = |name: &str| format!("<?xml version=\"1.0\" encoding=\"{name}\"?>\n<a b=\"Straße\"/>");
        let expected = written("UTF-8");
        let units: Vec<u16> = written("utf-16").encode_utf16().collect();
        let little = [0xff, 0xfe].into_iter().chain(units.iter().flat_map(|unit| unit.to_le_bytes()));
        let big = [0xfe, 0xff].into_iter().chain(units.iter().flat_map(|unit| unit.to_be_bytes()));
        let latin = written("iso-8859-1");
        let latin = latin.chars().map(|sign| u8::try_from(u32::from(sign)).expect("a byte"));
        for bytes in [expected.clone().into_bytes(), little.collect(), big.collect(), latin.collect()] {
            assert_eq!(text(bytes).expect("it is sound"), expected);
        }
    }

    #[test]
    fn bytes_that_are_no_text_are_refused() {
        let flaw = |bytes: &[u8]| *text(bytes.to_vec()).expect_err("it is no text");
        assert!(matches!(flaw(b"<a b=\"\xff\"/>"), Flaw::NotUtf8 { at: 6 }));
        for bytes in [[0xff, 0xfe, 0x00, 0xd8].as_slice(), &[0xff, 0xfe, 0x41]] {
            assert!(matches!(flaw(bytes), Flaw::NotUtf16));
        }
    }
}
