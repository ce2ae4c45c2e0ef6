//! Where in a text something stands, as editors count.

/// A place in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1, in characters.
    pub column: usize,
}

impl Position {
    /// The place of a byte of a text; of a byte behind its end, the end.
    ///
    /// ```
    /// use paracosm_space::Position;
    /// assert_eq!(Position::of("x = 1\né = 2", 10), Position { line: 2, column: 4 });
    /// ```
    ///
    /// # Panics
    /// The byte is within a character.
    pub fn of(text: &str, offset: usize) -> Self {
        let before = &text[..offset.min(text.len())];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        Self { line, column }
    }
}
