//! A bench written up: tables, figures, LaTeX and CSV.

mod figures;
mod files;
mod latex;
mod table;

pub use files::write;
pub use table::table;
