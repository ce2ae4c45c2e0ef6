//! Expressions in attributes: `${$Speed / 3.6}`, with numbers, truths, parameters, operators and functions (OpenSCENARIO 1.1, section
//! 9.2).

use paracosm_space::constraint::{Function, Term};
use std::f64::consts::PI;
use thiserror::Error;

/// The greatest depth of nested expressions.
const DEEPEST: usize = 64;
/// The greatest number of operators between two operands in an expression. Each of them makes the tree of the expression one level
/// deeper.
pub(crate) const MOST_OPERATORS: usize = 500;

/// The reason why an expression has no value.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ExpressionFlaw {
    /// The expression ends too early.
    #[error("it ends where a value was expected")]
    Ends,
    /// A part of the expression is not understood.
    #[error("`{found}` was found, expected {expected}")]
    Unexpected {
        /// The rest of the expression.
        found: String,
        /// The expected part, in words.
        expected: &'static str,
    },
    /// There is no parameter with this name.
    #[error("there is no parameter `{name}`{}", paracosm_space::did_you_mean(nearest))]
    NoParameter {
        /// The unknown name.
        name: String,
        /// The most similar name of a parameter; `None` if no name is similar.
        nearest: Option<String>,
    },
    /// The expression gives a parameter its value, and names this parameter.
    #[error("it names the parameter `{name}` itself")]
    Itself {
        /// The name of the parameter.
        name: String,
    },
    /// The expression gives a parameter its value, and names a parameter that is declared later.
    #[error("the parameter `{name}` is declared later; declare it before this one")]
    Later {
        /// The name of the later parameter.
        name: String,
    },
    /// There is no function with this name, or its arguments are missing.
    #[error(
        "`{name}` was found, expected a number, a parameter such as $Speed, or a function with its arguments{}",
        paracosm_space::did_you_mean(nearest)
    )]
    NoFunction {
        /// The unknown name.
        name: String,
        /// The most similar name of a function; `None` if no name is similar.
        nearest: Option<&'static str>,
    },
    /// A value has the wrong type for an operator.
    #[error("`{found}` is not {expected}")]
    Type {
        /// The value.
        found: String,
        /// The expected type, in words.
        expected: &'static str,
    },
    /// A number is divided by zero.
    #[error("it divides by zero")]
    DividesByZero,
    /// A result is not a finite number.
    #[error("its value is not a finite number")]
    NotFinite,
    /// The expression is nested too deeply.
    #[error("it is nested deeper than {DEEPEST} levels")]
    TooDeep,
    /// The expression has too many operators.
    #[error(
        "it has more than {MOST_OPERATORS} operators, counted with the expressions of the parameters that it names"
    )]
    TooLong,
}

/// A function or an operator of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Operator {
    Number(Function),
    And,
    Or,
    Not,
}

/// An expression as a tree.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Expression {
    Value(Value),
    Parameter(String),
    Call(Operation),
}

/// An operator with its operands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Operation {
    operator: Operator,
    operands: Vec<Expression>,
}

/// The value of an expression.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Truth(bool),
    Text(String),
}

impl Value {
    /// Reads the value of a parameter.
    pub fn of(text: &str) -> Self {
        match (text.trim(), text.trim().parse()) {
            ("true", _) => Self::Truth(true),
            ("false", _) => Self::Truth(false),
            (_, Ok(number)) if f64::is_finite(number) => Self::Number(number),
            (text, _) => Self::Text(text.to_owned()),
        }
    }

    fn number(&self) -> Result<f64, ExpressionFlaw> {
        match self {
            Self::Number(number) => Ok(*number),
            other => Err(ExpressionFlaw::Type { found: other.to_string(), expected: "a number" }),
        }
    }

    fn truth(&self) -> Result<bool, ExpressionFlaw> {
        match self {
            Self::Truth(truth) => Ok(*truth),
            other => Err(ExpressionFlaw::Type { found: other.to_string(), expected: "true or false" }),
        }
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Truth(truth) => truth.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

impl Expression {
    /// Reads the part of an attribute between `${` and `}`.
    pub fn parse(text: &str) -> Result<Self, ExpressionFlaw> {
        let mut parser = Parser { rest: text.trim_start(), depth: 0, operators: 0 };
        let expression = parser.disjunction()?;
        if parser.rest.is_empty() { Ok(expression) } else { Err(parser.unexpected("an operator or the end")) }
    }

    /// Returns the value of the expression, with the given values of parameters.
    pub fn value(&self, parameter: &dyn Fn(&str) -> Result<Value, ExpressionFlaw>) -> Result<Value, ExpressionFlaw> {
        match self {
            Self::Value(value) => Ok(value.clone()),
            Self::Parameter(name) => parameter(name),
            Self::Call(operation) => operation.value(parameter),
        }
    }

    /// Returns the expression as a term of constraints, with the given terms in the place of parameters.
    pub fn term(&self, parameter: &dyn Fn(&str) -> Result<Term, ExpressionFlaw>) -> Result<Term, ExpressionFlaw> {
        match self {
            Self::Value(value) => value.number().map(Term::Number),
            Self::Parameter(name) => parameter(name),
            Self::Call(operation) => Ok(operation.term(parameter)?.computed()),
        }
    }
}

impl Operation {
    fn value(&self, parameter: &dyn Fn(&str) -> Result<Value, ExpressionFlaw>) -> Result<Value, ExpressionFlaw> {
        let operand = |index: usize| self.operands[index].value(parameter);
        let function = match self.operator {
            Operator::And => return Ok(Value::Truth(operand(0)?.truth()? && operand(1)?.truth()?)),
            Operator::Or => return Ok(Value::Truth(operand(0)?.truth()? || operand(1)?.truth()?)),
            Operator::Not => return Ok(Value::Truth(!operand(0)?.truth()?)),
            Operator::Number(function) => function,
        };
        let a = operand(0)?.number()?;
        let b = if self.operands.len() > 1 { operand(1)?.number()? } else { a };
        let divides = matches!(function, Function::Divide | Function::Remainder);
        let flaw = if divides && b == 0.0 { ExpressionFlaw::DividesByZero } else { ExpressionFlaw::NotFinite };
        function.value(&[a, b]).map(Value::Number).ok_or(flaw)
    }

    fn term(&self, parameter: &dyn Fn(&str) -> Result<Term, ExpressionFlaw>) -> Result<Term, ExpressionFlaw> {
        let Operator::Number(function) = self.operator else {
            return Err(ExpressionFlaw::Type { found: "a truth".to_owned(), expected: "a number" });
        };
        let operands = self.operands.iter().map(|operand| operand.term(parameter));
        Ok(Term::Applied(function, operands.collect::<Result<_, _>>()?))
    }
}

struct Parser<'a> {
    rest: &'a str,
    depth: usize,
    operators: usize,
}

impl Parser<'_> {
    fn disjunction(&mut self) -> Result<Expression, ExpressionFlaw> {
        self.chain(&[("or", Operator::Or)], Self::conjunction)
    }

    fn conjunction(&mut self) -> Result<Expression, ExpressionFlaw> {
        self.chain(&[("and", Operator::And)], Self::sum)
    }

    fn sum(&mut self) -> Result<Expression, ExpressionFlaw> {
        self.chain(
            &[("+", Operator::Number(Function::Add)), ("-", Operator::Number(Function::Subtract))],
            Self::product,
        )
    }

    fn product(&mut self) -> Result<Expression, ExpressionFlaw> {
        let operators = [
            ("*", Operator::Number(Function::Multiply)),
            ("/", Operator::Number(Function::Divide)),
            ("%", Operator::Number(Function::Remainder)),
        ];
        self.chain(&operators, Self::unary)
    }

    /// Reads operands with operators of one rank between them, from left to right.
    fn chain(
        &mut self,
        operators: &[(&str, Operator)],
        operand: fn(&mut Self) -> Result<Expression, ExpressionFlaw>,
    ) -> Result<Expression, ExpressionFlaw> {
        let mut left = operand(self)?;
        while let Some((_, operator)) = operators.iter().find(|(token, _)| self.takes(token)) {
            self.operators += 1;
            if self.operators > MOST_OPERATORS {
                return Err(ExpressionFlaw::TooLong);
            }
            let operands = vec![left, operand(self)?];
            left = Expression::Call(Operation { operator: *operator, operands });
        }
        Ok(left)
    }

    fn unary(&mut self) -> Result<Expression, ExpressionFlaw> {
        let operators = [("-", Operator::Number(Function::Negate)), ("not", Operator::Not)];
        let Some((_, operator)) = operators.iter().find(|(token, _)| self.takes(token)) else {
            return self.primary();
        };
        let operand = self.nested(Self::unary)?;
        Ok(Expression::Call(Operation { operator: *operator, operands: vec![operand] }))
    }

    fn primary(&mut self) -> Result<Expression, ExpressionFlaw> {
        if self.rest.is_empty() {
            return Err(ExpressionFlaw::Ends);
        }
        if self.takes("(") {
            let inside = self.nested(Self::disjunction)?;
            return if self.takes(")") { Ok(inside) } else { Err(self.unexpected("`)`")) };
        }
        if let Some(after) = self.rest.strip_prefix('$') {
            self.rest = after;
            let name = self.word("the name of a parameter")?;
            return Ok(Expression::Parameter(name));
        }
        if self.rest.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            return self.number();
        }
        match self.word("a value")?.as_str() {
            "true" => Ok(Expression::Value(Value::Truth(true))),
            "false" => Ok(Expression::Value(Value::Truth(false))),
            "pi" => Ok(Expression::Value(Value::Number(PI))),
            name => self.call(name),
        }
    }

    fn call(&mut self, name: &str) -> Result<Expression, ExpressionFlaw> {
        let Some(function) = Function::named(name).filter(|_| self.takes("(")) else {
            let nearest = paracosm_space::nearest(name, Function::names());
            return Err(ExpressionFlaw::NoFunction { name: name.to_owned(), nearest });
        };
        let mut operands = vec![self.nested(Self::disjunction)?];
        while operands.len() < function.operands() {
            if !self.takes(",") {
                return Err(self.unexpected("`,` and another argument"));
            }
            operands.push(self.nested(Self::disjunction)?);
        }
        if !self.takes(")") {
            return Err(self.unexpected("`)`"));
        }
        Ok(Expression::Call(Operation { operator: Operator::Number(function), operands }))
    }

    fn number(&mut self) -> Result<Expression, ExpressionFlaw> {
        let mut end = self.rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(self.rest.len());
        // An exponent counts only with digits.
        let exponent =
            self.rest[end..].strip_prefix(['e', 'E']).map(|after| after.strip_prefix(['+', '-']).unwrap_or(after));
        if let Some(digits) = exponent.filter(|after| after.starts_with(|c: char| c.is_ascii_digit())) {
            let length = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
            end = self.rest.len() - digits.len() + length;
        }
        let number = self.rest[..end].parse().map_err(|_| self.unexpected("a number"))?;
        self.rest = self.rest[end..].trim_start();
        Ok(Expression::Value(Value::Number(number)))
    }

    fn word(&mut self, expected: &'static str) -> Result<String, ExpressionFlaw> {
        let end = self.rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(self.rest.len());
        if end == 0 {
            return Err(self.unexpected(expected));
        }
        let word = self.rest[..end].to_owned();
        self.rest = self.rest[end..].trim_start();
        Ok(word)
    }

    /// Reads a token if it is next. A word is a token only if the word ends there.
    fn takes(&mut self, token: &str) -> bool {
        let Some(after) = self.rest.strip_prefix(token) else { return false };
        let goes_on = after.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        if token.starts_with(char::is_alphabetic) && goes_on {
            return false;
        }
        self.rest = after.trim_start();
        true
    }

    fn nested(
        &mut self,
        read: fn(&mut Self) -> Result<Expression, ExpressionFlaw>,
    ) -> Result<Expression, ExpressionFlaw> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(ExpressionFlaw::TooDeep);
        }
        let inside = read(self);
        self.depth -= 1;
        inside
    }

    fn unexpected(&self, expected: &'static str) -> ExpressionFlaw {
        let found = if self.rest.is_empty() { "the end".to_owned() } else { self.rest.to_owned() };
        ExpressionFlaw::Unexpected { found, expected }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<Value, ExpressionFlaw> {
        let parameter = |name: &str| match name {
            "Speed" => Ok(Value::Number(36.0)),
            "Wet" => Ok(Value::Truth(true)),
            _ => Err(ExpressionFlaw::NoParameter { name: name.to_owned(), nearest: None }),
        };
        Expression::parse(text)?.value(&parameter)
    }

    #[test]
    fn operators_have_their_usual_ranks() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("10 - 4 - 3", 3.0),
            ("-$Speed / 3.6", -10.0),
            ("2 * -3", -6.0),
            ("7 % 4", 3.0),
            ("1.5e1 + 1E-1", 15.1),
            ("pow(2, 3) + max(1, 2) - min(1, 2)", 9.0),
            ("round(2.5) + floor(-0.5) + ceil(0.2) + sqrt(9) + sign(-3) + abs(-2)", 7.0),
        ] {
            assert_eq!(value(text), Ok(Value::Number(expected)), "{text}");
        }
        assert_eq!(value("not $Wet or true and false"), Ok(Value::Truth(false)));
    }

    #[test]
    fn a_wrong_expression_is_described() {
        assert_eq!(value("1 / (2 - 2)"), Err(ExpressionFlaw::DividesByZero));
        assert_eq!(value("1 +"), Err(ExpressionFlaw::Ends));
        assert!(matches!(value("$Sped"), Err(ExpressionFlaw::NoParameter { .. })));
        assert!(matches!(value("1 + true"), Err(ExpressionFlaw::Type { .. })));
        assert!(matches!(value("system(1)"), Err(ExpressionFlaw::NoFunction { .. })));
        assert!(matches!(value("1 2"), Err(ExpressionFlaw::Unexpected { .. })));
        assert_eq!(value("pow(10, 400)"), Err(ExpressionFlaw::NotFinite));
        assert_eq!(value(&"(".repeat(100_000)), Err(ExpressionFlaw::TooDeep));
        assert_eq!(value(&"-".repeat(100_000)), Err(ExpressionFlaw::TooDeep));
        assert_eq!(value(&format!("1{}", " + 1".repeat(MOST_OPERATORS))), Ok(Value::Number(501.0)));
        assert_eq!(value(&format!("1{}", " + 1".repeat(1_000_000))), Err(ExpressionFlaw::TooLong));
    }
}
