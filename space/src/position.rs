//! Positions in a text as editors count them: lines and columns.

/// A position in a text, as a line and a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position {
    /// The line of the position, counted from 1.
    pub line: usize,
    /// The column of the position, counted in characters from 1.
    pub column: usize,
}

impl Position {
    /// Returns the line and the column of the byte at `offset` in a text. If the offset is behind the end of the text,
    /// returns the end.
    ///
    /// ```
    /// use paracosm_space::Position;
    /// assert_eq!(Position::of("x = 1\né = 2", 10), Position { line: 2, column: 4 });
    /// ```
    ///
    /// # Panics
    /// The offset is inside a character of several bytes.
    pub fn of(text: &str, offset: usize) -> Self {
        let before = &text[..offset.min(text.len())];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        Self { line, column }
    }
}
