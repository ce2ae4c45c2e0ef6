//! Mistakes that are found while a program builds its world.

use std::cell::RefCell;
use std::rc::Rc;

/// Mistakes found while the program ran, in words, shared with the handles that it got.
pub(crate) type Problems = Rc<RefCell<Vec<String>>>;
