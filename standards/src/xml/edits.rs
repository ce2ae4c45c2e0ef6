//! Changes of the text of a file at the places of its elements. Everything else keeps its bytes, comments too.

use super::element::Element;
use super::writer::escaped;
use std::ops::Range;

/// Changes within an element of a file.
pub(crate) struct Edits<'a> {
    root: Element<'a, 'a>,
    /// The parts of the file with the texts that replace them. No part lies within another part.
    all: Vec<(Range<usize>, String)>,
}

impl<'a> Edits<'a> {
    pub fn new(root: Element<'a, 'a>) -> Self {
        Self { root, all: Vec::new() }
    }

    /// Gives an attribute of an element a value. The last value holds.
    pub fn set(&mut self, element: Element<'a, 'a>, attribute: &str, value: &str) {
        let value = escaped(value).replace('\'', "&apos;");
        match element.value_range(attribute) {
            Some(range) => self.all.push((range, value)),
            None => {
                let name = element.source().find(|sign: char| sign.is_whitespace() || "/>".contains(sign));
                let at = element.range().start + name.unwrap_or(0);
                self.all.push((at..at, format!(" {attribute}=\"{value}\"")));
            }
        }
    }

    /// Replaces an element by a text, in which there may be other elements.
    pub fn replace(&mut self, element: Element<'a, 'a>, text: String) {
        self.all.push((element.range(), text));
    }

    /// Adds a text after everything within an element.
    pub fn append(&mut self, element: Element<'a, 'a>, text: &str) {
        let (Range { start, end }, source) = (element.range(), element.source());
        match (source.strip_suffix("/>"), source.rfind("</")) {
            (Some(_), _) => {
                let name =
                    source[1..].split(|sign: char| sign.is_whitespace() || sign == '/').next().unwrap_or_default();
                self.all.push((end - 2..end, format!(">{text}</{name}>")));
            }
            (None, at) => {
                let at = start + at.unwrap_or(source.len());
                self.all.push((at..at, text.to_owned()));
            }
        }
    }

    /// Returns the text of the element with all changes.
    pub fn finish(self) -> String {
        let whole = self.root.range();
        self.within(whole)
    }

    /// Returns the text of the whole file with all changes.
    pub fn finish_file(self) -> String {
        let whole = 0..self.root.file_text().len();
        self.within(whole)
    }

    fn within(mut self, Range { start: mut at, end }: Range<usize>) -> String {
        // Changes at the same place keep their order.
        self.all.sort_by_key(|(range, _)| (range.start, range.end));
        let text = self.root.file_text();
        let mut changed = String::new();
        for (index, (range, new)) in self.all.iter().enumerate() {
            let is_last = self.all.get(index + 1).is_none_or(|(next, _)| next != range || range.is_empty());
            if !is_last {
                continue;
            }
            changed.push_str(&text[at..range.start]);
            changed.push_str(new);
            at = range.end;
        }
        changed.push_str(&text[at..end]);
        changed
    }
}

#[cfg(test)]
mod tests {
    use crate::xml::{Document, Edits};

    #[test]
    fn changes_leave_everything_else_as_it_is() {
        let text = "<?xml version=\"1.0\"?><!-- one --><a x='1' y = \"2\"><b/>é<c z=\"3\"></c>\n<d  /><e>f</e></a> ";
        let document = Document::of("a.xml".as_ref(), text.to_owned()).expect("it is sound");
        let root = document.root("a").expect("it is there");
        let within = |name| root.first(name).expect("it is there");
        let mut edits = Edits::new(root);
        edits.set(root, "y", "<\"&'");
        edits.set(root, "x", "7");
        edits.set(root, "x", "0");
        edits.set(within("c"), "new", "5");
        edits.append(within("b"), "<in/>");
        edits.append(within("c"), "<in/>");
        edits.append(within("d"), "<in/>");
        edits.append(root, "<last/>");
        edits.replace(within("e"), String::new());
        let expected = "<?xml version=\"1.0\"?><!-- one --><a x='0' y = \"&lt;&quot;&amp;&apos;\"><b><in/></b>é\
                        <c new=\"5\" z=\"3\"><in/></c>\n<d  ><in/></d><last/></a> ";
        assert_eq!(edits.finish_file(), expected);
        assert_eq!(Edits::new(within("c")).finish(), "<c z=\"3\"></c>");
    }
}
