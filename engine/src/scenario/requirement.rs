//! Requirements as programs state them: temporal operators over streams.

use crate::stream::{Binary, DatumSample, Node, NodeKind, Stream, Unary};
use paracosm_oracles::{Comparison, Formula, Interval, Requirement, signal};
use std::cell::RefCell;
use std::ops::Not;
use std::rc::Rc;

/// A temporal statement about streams, which is a [`Formula`] over the recorded samples of the streams.
///
/// A stream of truths is a statement about every tick. A truth that is made of comparisons, `&`, `|` and `!` keeps its
/// robustness. Any other truth is recorded as 1 or 0, without a robustness.
///
/// ```
/// # use paracosm_engine::{AutonomousVehicle, Program, RoadSegment, Scenario, Temporal, never};
/// # fn build(s: &mut Scenario) {
/// # let road = s.place(RoadSegment::new(300.0));
/// # let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
/// // The car does not stand still for 5 s.
/// s.require("moves", never(Temporal::from(car.speed().below(0.1)).historically(0.0..=5.0)));
/// // Whenever it is quick, it is slow again within 3 s.
/// s.require("slows", Temporal::from(car.speed().above(20.0)).implies(
///     Temporal::from(car.speed().below(10.0)).eventually(0.0..=3.0),
/// ).always(..));
/// # }
/// # Program::new("moves", "moves", build).declare().unwrap();
/// ```
#[derive(Debug, Clone)]
pub struct Temporal {
    formula: Formula,
    /// The streams of the formula, by their names.
    signals: Vec<Rc<Node>>,
}

/// Makes the statement that `statement` holds at no tick.
pub fn never(statement: impl Into<Temporal>) -> Temporal {
    (!statement.into()).always(..)
}

/// Makes the statement that `statement` holds at every tick.
pub fn always(statement: impl Into<Temporal>) -> Temporal {
    statement.into().always(..)
}

/// Makes the statement that `statement` holds at some tick.
pub fn eventually(statement: impl Into<Temporal>) -> Temporal {
    statement.into().eventually(..)
}

impl Temporal {
    /// Makes the statement that this statement holds throughout an interval, in seconds from now on.
    pub fn always(self, interval: impl Into<Interval>) -> Self {
        Self { formula: self.formula.always(interval), ..self }
    }

    /// Makes the statement that this statement holds at some tick of an interval, in seconds from now on.
    pub fn eventually(self, interval: impl Into<Interval>) -> Self {
        Self { formula: self.formula.eventually(interval), ..self }
    }

    /// Makes the statement that this statement held throughout an interval, in seconds back from now.
    pub fn historically(self, interval: impl Into<Interval>) -> Self {
        Self { formula: self.formula.historically(interval), ..self }
    }

    /// Makes the statement that this statement held at some tick of an interval, in seconds back from now.
    pub fn once(self, interval: impl Into<Interval>) -> Self {
        Self { formula: self.formula.once(interval), ..self }
    }

    /// Makes the statement that this statement holds until `goal` holds at a tick of an interval from now on.
    pub fn until(self, interval: impl Into<Interval>, goal: impl Into<Temporal>) -> Self {
        self.join(goal.into(), |hold, goal| hold.until(interval, goal))
    }

    /// Makes the statement that this statement and `other` both hold.
    pub fn and(self, other: impl Into<Temporal>) -> Self {
        self.join(other.into(), Formula::and)
    }

    /// Makes the statement that this statement or `other` holds, or both.
    pub fn or(self, other: impl Into<Temporal>) -> Self {
        self.join(other.into(), Formula::or)
    }

    /// Makes the statement that `other` holds if this statement holds.
    pub fn implies(self, other: impl Into<Temporal>) -> Self {
        self.join(other.into(), Formula::implies)
    }

    fn join(mut self, other: Self, join: impl FnOnce(Formula, Formula) -> Formula) -> Self {
        self.signals.extend(other.signals);
        Self { formula: join(self.formula, other.formula), signals: self.signals }
    }

    /// Compares a recorded stream with a number.
    fn compare(measured: Rc<Node>, comparison: Comparison, threshold: f64) -> Self {
        let formula = signal(measured.to_string()).compare(comparison, threshold);
        Self { formula, signals: vec![measured] }
    }

    /// Makes the statement of a node of truths. If two streams are compared, their difference is compared with 0.
    fn of(node: &Rc<Node>) -> Self {
        let truth = node.unnamed();
        match (&truth.kind, truth.inputs.as_slice()) {
            (NodeKind::Compare(comparison), [left, right]) => match &right.unnamed().kind {
                NodeKind::Constant { value, .. } if let [DatumSample::Number(threshold)] = value[..] => {
                    Self::compare(left.clone(), *comparison, threshold)
                }
                _ => {
                    let difference = NodeKind::Binary(Binary::Difference);
                    let difference = Node { kind: difference, inputs: vec![left.clone(), right.clone()], width: 1 };
                    Self::compare(Rc::new(difference), *comparison, 0.0)
                }
            },
            (NodeKind::Unary(Unary::Not), [negated]) => !Self::of(negated),
            (NodeKind::Binary(Binary::And), [left, right]) => Self::of(left).and(Self::of(right)),
            (NodeKind::Binary(Binary::Or), [left, right]) => Self::of(left).or(Self::of(right)),
            _ => Self::compare(node.clone(), Comparison::AtLeast, 1.0),
        }
    }
}

impl From<Stream<bool>> for Temporal {
    fn from(truth: Stream<bool>) -> Self {
        Self::of(&truth.node)
    }
}

impl From<&Stream<bool>> for Temporal {
    fn from(truth: &Stream<bool>) -> Self {
        Self::of(&truth.node)
    }
}

impl Not for Temporal {
    type Output = Self;

    fn not(self) -> Self {
        Self { formula: !self.formula, ..self }
    }
}

/// A requirement with the streams whose samples its formula uses.
#[derive(Debug, Clone)]
pub(crate) struct Stated {
    pub requirement: Requirement,
    pub signals: Vec<Rc<Node>>,
}

/// A requirement that was just stated; its methods add a text, a unit and a scale.
#[derive(Debug)]
pub struct RequirementDraft {
    stated: Rc<RefCell<Vec<Stated>>>,
    index: usize,
}

impl RequirementDraft {
    pub(super) fn new(stated: Rc<RefCell<Vec<Stated>>>, id: &str, asked: Temporal) -> Self {
        let Temporal { formula, signals } = asked;
        let requirement =
            Requirement { id: id.to_owned(), text: formula.to_string(), formula, unit: String::new(), scale: 1.0 };
        let index = stated.borrow().len();
        stated.borrow_mut().push(Stated { requirement, signals });
        Self { stated, index }
    }

    /// Sets the text of the requirement, which is one sentence for people. The default is the formula itself.
    pub fn text(self, text: &str) -> Self {
        self.change(|requirement| text.clone_into(&mut requirement.text))
    }

    /// Sets the unit of the requirement's robustness.
    pub fn unit(self, unit: &str) -> Self {
        self.change(|requirement| unit.clone_into(&mut requirement.unit))
    }

    /// Sets the scale of the requirement, which is the robustness in its unit that counts as large. The default is 1.
    /// A scale that is not a number above 0 is a mistake, which the scenario reports.
    pub fn scale(self, scale: f64) -> Self {
        self.change(|requirement| requirement.scale = scale)
    }

    fn change(self, change: impl FnOnce(&mut Requirement)) -> Self {
        change(&mut self.stated.borrow_mut()[self.index].requirement);
        self
    }
}
