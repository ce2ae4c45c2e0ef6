//! Requirements as programs state them: temporal operators over streams.

use crate::stream::{Binary, Kind, Node, Sample, Stream};
use paracosm_oracles::{Comparison, Formula, Requirement, signal};
use std::cell::RefCell;
use std::rc::Rc;

/// A temporal statement about a stream.
#[derive(Debug, Clone)]
pub struct Temporal {
    operator: Operator,
    event: Stream<bool>,
}

#[derive(Debug, Clone, Copy)]
enum Operator {
    Never,
    Eventually,
}

/// The event occurs at no tick.
pub fn never(event: Stream<bool>) -> Temporal {
    Temporal { operator: Operator::Never, event }
}

/// The event occurs at some tick.
pub fn eventually(event: Stream<bool>) -> Temporal {
    Temporal { operator: Operator::Eventually, event }
}

/// A requirement with the stream whose samples its formula speaks of.
#[derive(Debug, Clone)]
pub(crate) struct Stated {
    pub requirement: Requirement,
    pub signal: Rc<Node>,
}

/// A requirement just stated; its methods say more of it.
#[derive(Debug)]
pub struct Draft {
    stated: Rc<RefCell<Vec<Stated>>>,
    index: usize,
}

impl Draft {
    pub(super) fn new(stated: Rc<RefCell<Vec<Stated>>>, id: &str, asked: Temporal) -> Self {
        let (node, compare) = comparison(&asked.event);
        let formula = match asked.operator {
            Operator::Never => (!compare).always(..),
            Operator::Eventually => compare.eventually(..),
        };
        let requirement =
            Requirement { id: id.to_owned(), text: formula.to_string(), formula, unit: String::new(), scale: 1.0 };
        let index = stated.borrow().len();
        stated.borrow_mut().push(Stated { requirement, signal: node });
        Self { stated, index }
    }

    /// One sentence for people; the formula itself where nothing is said.
    pub fn text(self, text: &str) -> Self {
        self.change(|requirement| text.clone_into(&mut requirement.text))
    }

    /// The unit of its robustness.
    pub fn unit(self, unit: &str) -> Self {
        self.change(|requirement| unit.clone_into(&mut requirement.unit))
    }

    /// How much robustness is a lot, in that unit; 1 where nothing is said.
    pub fn scale(self, scale: f64) -> Self {
        self.change(|requirement| requirement.scale = scale)
    }

    fn change(self, change: impl FnOnce(&mut Requirement)) -> Self {
        change(&mut self.stated.borrow_mut()[self.index].requirement);
        self
    }
}

/// A stream of truths as a comparison of a recorded signal with a number. What is a comparison already keeps its
/// robustness: of two streams, their difference is compared with 0. Of anything else only the truth is known, which is
/// recorded as 1 and 0.
fn comparison(event: &Stream<bool>) -> (Rc<Node>, Formula) {
    let node = event.node.unnamed();
    let (measured, comparison, threshold) = match (&node.kind, node.inputs.as_slice()) {
        (Kind::Compare(comparison), [left, right]) => match &right.unnamed().kind {
            Kind::Constant { value, .. } if let [Sample::Number(threshold)] = value[..] => {
                (left.clone(), *comparison, threshold)
            }
            _ => {
                let difference = Kind::Binary(Binary::Difference);
                let difference = Node { kind: difference, inputs: vec![left.clone(), right.clone()], width: 1 };
                (Rc::new(difference), *comparison, 0.0)
            }
        },
        _ => (event.node.clone(), Comparison::AtLeast, 1.0),
    };
    let formula = signal(measured.to_string()).compare(comparison, threshold);
    (measured, formula)
}
