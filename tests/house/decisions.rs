//! No decision reads the words of a message.
//!
//! Words are for readers, and change when somebody finds better ones. A decision that looks for a word in them breaks
//! then, and no compiler says so. A message is here a text that `to_string` or `format!` has just made, and whatever is
//! called [`message`](MESSAGES) or so. Looking into it is [`LOOKS`], or comparing it with a literal.

use crate::expect_none;
use crate::source::{Module, attributes, attributes_in_impl, is_for_tests, modules, modules_of};
use crate::workspace::crates;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, ExprBinary, ExprMethodCall, ImplItem, Item, ItemMod, Lit, Member};

/// Names of variables, fields and methods that are messages.
const MESSAGES: [&str; 7] = ["error", "fault", "flaw", "message", "problem", "reason", "what"];

/// Methods that look for something in a text.
const LOOKS: [&str; 12] = [
    "contains",
    "ends_with",
    "find",
    "lines",
    "matches",
    "rfind",
    "rsplit",
    "split",
    "split_once",
    "starts_with",
    "strip_prefix",
    "strip_suffix",
];

/// Methods that give the same text again.
const SAME: [&str; 9] =
    ["as_deref", "as_ref", "as_str", "clone", "to_lowercase", "to_owned", "trim", "unwrap", "unwrap_or_default"];

#[test]
fn no_decision_reads_the_words_of_a_message() {
    let modules = crates().into_iter().flat_map(|krate| krate.targets).flat_map(|first| modules(&first));
    let wrong: Vec<_> = modules.flat_map(|module| decisions_in(&module)).collect();
    expect_none(&wrong, "Decide by the type of the error or by a field of it, not by its words.");
}

/// The decisions by words in a module.
fn decisions_in(module: &Module) -> Vec<String> {
    let mut seen = Decisions { file: module.name(), wrong: Vec::new() };
    module.items.iter().for_each(|item| seen.visit_item(item));
    seen.wrong
}

struct Decisions {
    file: String,
    wrong: Vec<String>,
}

impl Decisions {
    fn found(&mut self, at: &impl Spanned) {
        self.wrong.push(format!("{}:{}: looks into a message", self.file, at.span().start().line));
    }
}

impl<'ast> Visit<'ast> for Decisions {
    fn visit_item(&mut self, item: &'ast Item) {
        if !is_for_tests(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if !is_for_tests(attributes_in_impl(item)) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, _: &'ast ItemMod) {}

    fn visit_expr_method_call(&mut self, call: &'ast ExprMethodCall) {
        if LOOKS.contains(&call.method.to_string().as_str()) && is_message(&call.receiver) {
            self.found(&call.method);
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_expr_binary(&mut self, binary: &'ast ExprBinary) {
        let compares = matches!(binary.op, BinOp::Eq(_) | BinOp::Ne(_));
        let [left, right] = [&*binary.left, &*binary.right];
        if compares && (is_message(left) && is_literal(right) || is_literal(left) && is_message(right)) {
            self.found(&binary.op);
        }
        visit::visit_expr_binary(self, binary);
    }
}

fn is_message(expression: &Expr) -> bool {
    let named = |name: &syn::Ident| MESSAGES.contains(&name.to_string().as_str());
    match expression {
        Expr::Paren(inner) => is_message(&inner.expr),
        Expr::Reference(inner) => is_message(&inner.expr),
        Expr::Unary(inner) => is_message(&inner.expr),
        Expr::Path(path) => path.path.get_ident().is_some_and(named),
        Expr::Field(field) => matches!(&field.member, Member::Named(name) if named(name)),
        Expr::Macro(call) => call.mac.path.is_ident("format"),
        Expr::MethodCall(call) if SAME.contains(&call.method.to_string().as_str()) => is_message(&call.receiver),
        Expr::MethodCall(call) => call.method == "to_string" || named(&call.method),
        _ => false,
    }
}

fn is_literal(expression: &Expr) -> bool {
    matches!(expression, Expr::Lit(literal) if matches!(literal.lit, Lit::Str(_)))
}

#[test]
fn decisions_by_words_are_found() {
    for (expression, found) in [
        ("error.to_string().contains(\"disk\")", true),
        ("fault.message.as_str().starts_with(\"no\")", true),
        ("trial.problem().unwrap() == \"dead\"", true),
        ("format!(\"{e}\").to_lowercase() != \"x\"", true),
        ("name.starts_with(\"halton\")", false),
        ("error.kind() == ErrorKind::NotFound", false),
    ] {
        let modules = modules_of(&format!("fn f() {{ if {expression} {{}} }}"));
        assert_eq!(!decisions_in(&modules[0]).is_empty(), found, "{expression}");
    }
}
