//! The types of parameters, and the values that each type allows.

use super::moment::moment;
use crate::xml;
use paracosm_space::Value;

/// The type of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Boolean,
    DateTime,
    Double,
    Text,
    /// The whole numbers from the first to the second.
    Whole(i64, i64),
}

/// The names of all types.
pub(super) const KINDS: [(&str, Kind); 8] = [
    ("boolean", Kind::Boolean),
    ("dateTime", Kind::DateTime),
    ("double", Kind::Double),
    ("int", Kind::Whole(i32::MIN as i64, i32::MAX as i64)),
    ("integer", Kind::Whole(i32::MIN as i64, i32::MAX as i64)),
    ("string", Kind::Text),
    ("unsignedInt", Kind::Whole(0, u32::MAX as i64)),
    ("unsignedShort", Kind::Whole(0, u16::MAX as i64)),
];

impl Kind {
    /// Returns `true` if a text is a value of the type. A whole number may have decimals if they are 0, because expressions
    /// give such numbers.
    pub fn takes(self, text: &str) -> bool {
        let number = || text.parse().ok().filter(|number: &f64| number.is_finite());
        match self {
            Self::Boolean => ["true", "false", "1", "0"].contains(&text),
            Self::DateTime => moment(text).is_some(),
            Self::Double => number().is_some(),
            Self::Text => true,
            Self::Whole(least, most) => {
                number().is_some_and(|number| number.fract() == 0.0 && (least as f64..=most as f64).contains(&number))
            }
        }
    }

    /// Describes the values of the type.
    pub fn expected(self) -> String {
        match self {
            Self::Boolean => "true or false".to_owned(),
            Self::DateTime => "a time such as 2026-01-31T12:00:00".to_owned(),
            Self::Double => "a finite number".to_owned(),
            Self::Text => "a text".to_owned(),
            Self::Whole(least, most) => format!("a whole number from {least} to {most}"),
        }
    }

    /// Returns `true` if the values of the type are texts, also if they look like numbers.
    pub fn is_text(self) -> bool {
        matches!(self, Self::DateTime | Self::Text)
    }

    /// Returns `true` if the values of the type are numbers.
    pub fn is_number(self) -> bool {
        self == Self::Double || self.is_whole()
    }

    /// Returns `true` if the values of the type are whole numbers.
    pub fn is_whole(self) -> bool {
        matches!(self, Self::Whole(..))
    }

    /// Returns the value of a text of the type as spaces have it.
    pub fn value(self, text: &str) -> Value {
        let text = self.plain(text);
        if self.is_text() { Value::from(text) } else { Value::parse(text) }
    }

    /// Returns the value of a text of the type as variables have it.
    pub fn typed(self, text: &str) -> xml::Value {
        let text = self.plain(text);
        if self.is_text() { xml::Value::Text(text.to_owned()) } else { xml::Value::of(text) }
    }

    /// Returns a text of the type in the form in which all parts of a scenario see it: a truth may be written as a number.
    pub fn plain(self, text: &str) -> &str {
        match (self, text) {
            (Self::Boolean, "1") => "true",
            (Self::Boolean, "0") => "false",
            (_, text) => text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_type_takes_its_values_alone() {
        let kind = |name: &str| KINDS.iter().find(|(known, _)| *known == name).expect("it is a type").1;
        for (name, taken, refused) in [
            ("boolean", ["true", "0"].as_slice(), ["yes", "TRUE", "2", ""].as_slice()),
            ("dateTime", &["2026-01-31T12:00:00Z"], &["2026-01-31", "noon", ""]),
            ("double", &["-1.5", "2e3", "7"], &["NaN", "inf", "1,5", "fast", ""]),
            ("int", &["-2147483648", "2147483647", "3.0"], &["2147483648", "0.5", "one", "NaN", ""]),
            ("integer", &["0", "-3"], &["-2147483649", "1e-3"]),
            ("string", &["", "7", "car"], &[]),
            ("unsignedInt", &["0", "4294967295"], &["-1", "4294967296", "0.25"]),
            ("unsignedShort", &["0", "65535"], &["-1", "65536", "1.5"]),
        ] {
            assert!(taken.iter().all(|text| kind(name).takes(text)), "{name}");
            for text in refused {
                assert!(!kind(name).takes(text), "{name} takes `{text}`");
            }
        }
    }
}
