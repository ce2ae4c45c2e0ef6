//! The name of the program. Help and messages name the usual program; a program of a user's own shows its own name there.

use std::borrow::Cow;
use std::env::{self, consts::EXE_SUFFIX};
use std::ffi::OsString;
use std::path::Path;
use std::sync::OnceLock;

/// The name of the program that the texts of help and messages have.
const USUAL: &str = "paracosm-fuzz";

/// The name of the program that has the commands of the usual program.
static NAME: OnceLock<String> = OnceLock::new();

/// The words of the command line, if another program runs this one and says them.
static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// Takes the words of the command line from the caller, not from the operating system. Only the first call counts.
pub(super) fn is_called_with(words: Vec<OsString>) {
    let _ = WORDS.set(words);
}

/// Returns the words of the command line; the first word is the program.
pub(super) fn words() -> Vec<OsString> {
    WORDS.get().cloned().unwrap_or_else(|| env::args_os().collect())
}

/// Returns the program as the user called it, for commands that the user can type again.
pub(super) fn called() -> String {
    words().into_iter().next().map_or_else(|| USUAL.into(), |word| word.to_string_lossy().into_owned())
}

/// Says that this program has the commands of `paracosm-fuzz`. Its name is the name of its file.
pub(super) fn takes_the_place() {
    let name =
        Path::new(&called()).file_name().map_or_else(|| USUAL.into(), |name| name.to_string_lossy().into_owned());
    let _ = NAME.set(name.strip_suffix(EXE_SUFFIX).map(str::to_owned).unwrap_or(name));
}

/// Returns the name of the program that has the commands of `paracosm-fuzz`.
pub(super) fn name() -> &'static str {
    NAME.get().map_or(USUAL, String::as_str)
}

/// Returns `true` if the program has the usual name.
pub(super) fn is_usual() -> bool {
    name() == USUAL
}

/// Returns help with the name of this program.
pub(super) fn help(text: &str) -> String {
    text.replace(USUAL, name())
}

/// Returns a message in which commands have the name of this program: `` `paracosm-fuzz list` `` becomes `` `own list` ``.
pub(super) fn message(text: &str) -> Cow<'_, str> {
    if is_usual() {
        return Cow::Borrowed(text);
    }
    let command = |program: &str| format!("`{program} ");
    Cow::Owned(text.replace(&command(USUAL), &command(name())))
}
