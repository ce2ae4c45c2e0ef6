//! An error is a type with data; its words are made where it is shown.
//!
//! Who gets a text as an error can only show it. Who gets a type can count, compare, translate and decide. So, outside
//! of `src/cli`, which shows:
//!
//! - No error type, and no variant of one, holds only texts that are words for a reader. An error type derives `Error`,
//!   or implements a trait of a name that ends in `Error` or `Reason`. A text is a `String`, a `str` behind whatever
//!   pointer, or an `Option` of these. A field of a text is words for a reader if it has no name, or one of [`WORDS`].
//!   A text that names a thing, as in `{ parameter: String }`, is data.
//! - No `Result` has a text as its error.

use crate::expect_none;
use crate::source::{Module, attributes, attributes_in_impl, is_for_tests, modules, modules_of};
use crate::workspace::crates;
use std::collections::BTreeSet;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, Fields, GenericArgument, Ident, ImplItem, Item, ItemMod, PathArguments, Type, TypePath};

/// Names of fields that hold words for a reader.
const WORDS: [&str; 9] = ["description", "detail", "details", "error", "message", "problem", "reason", "text", "what"];

/// Here words are made.
const SHOWN: &str = "src/cli";

#[test]
fn no_error_is_only_a_text() {
    let wrong: Vec<_> =
        crates().into_iter().flat_map(|krate| krate.targets).flat_map(|first| texts_in(&modules(&first))).collect();
    expect_none(
        &wrong,
        "Give the error a type: a variant for each case, with the data that its words are made of, and the words in \
         `#[error(\"…\")]`. If the text is the name of a thing, give its field the name of what it names.",
    );
}

/// The texts that are errors in a crate.
fn texts_in(modules: &[Module]) -> Vec<String> {
    let errors: BTreeSet<String> = modules.iter().flat_map(|module| implementors(&module.items)).collect();
    let is_exempt = |file: &str| file.starts_with(SHOWN);
    let texts = |module: &Module| {
        let mut seen = Texts { errors: &errors, file: module.name(), wrong: Vec::new() };
        module.items.iter().for_each(|item| seen.visit_item(item));
        seen.wrong
    };
    modules.iter().filter(|module| !is_exempt(&module.name())).flat_map(texts).collect()
}

/// The types that implement a trait of errors by hand.
fn implementors(items: &[Item]) -> Vec<String> {
    let implementor = |item: &Item| {
        let Item::Impl(block) = item else { return None };
        let name = block.trait_.as_ref()?.0.segments.last()?.ident.to_string();
        let Type::Path(of) = &*block.self_ty else { return None };
        (name.ends_with("Error") || name.ends_with("Reason"))
            .then(|| of.path.segments.last().map(|last| last.ident.to_string()))?
    };
    items.iter().filter_map(implementor).collect()
}

fn derives_error(attributes: &[Attribute]) -> bool {
    let mut derives = false;
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("derive")) {
        let _ = attribute.parse_nested_meta(|derived| {
            derives |= derived.path.segments.last().is_some_and(|last| last.ident == "Error");
            Ok(())
        });
    }
    derives
}

struct Texts<'a> {
    errors: &'a BTreeSet<String>,
    file: String,
    wrong: Vec<String>,
}

impl Texts<'_> {
    fn is_error(&self, name: &Ident, attributes: &[Attribute]) -> bool {
        derives_error(attributes) || self.errors.contains(&name.to_string())
    }

    fn fields(&mut self, name: &str, fields: &Fields, at: &impl Spanned) {
        let words = |field: &syn::Field| {
            field.ident.as_ref().is_none_or(|name| WORDS.contains(&name.to_string().as_str())) && is_text(&field.ty)
        };
        if !fields.is_empty() && fields.iter().all(words) {
            self.found(at, &format!("the error {name} is only a text"));
        }
    }

    fn found(&mut self, at: &impl Spanned, what: &str) {
        self.wrong.push(format!("{}:{}: {what}", self.file, at.span().start().line));
    }
}

impl<'ast> Visit<'ast> for Texts<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if is_for_tests(attributes(item)) {
            return;
        }
        match item {
            Item::Enum(item) if self.is_error(&item.ident, &item.attrs) => {
                for variant in &item.variants {
                    self.fields(&format!("{}::{}", item.ident, variant.ident), &variant.fields, variant);
                }
            }
            Item::Struct(item) if self.is_error(&item.ident, &item.attrs) => {
                self.fields(&item.ident.to_string(), &item.fields, &item.ident);
            }
            _ => {}
        }
        visit::visit_item(self, item);
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if !is_for_tests(attributes_in_impl(item)) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, _: &'ast ItemMod) {}

    fn visit_type_path(&mut self, path: &'ast TypePath) {
        let types = arguments(path);
        if path.path.segments.last().is_some_and(|last| last.ident == "Result")
            && types.get(1).is_some_and(|error| is_text(error))
        {
            self.found(path, "a `Result` has a text as its error");
        }
        visit::visit_type_path(self, path);
    }
}

/// A `String`, or a `str` behind whatever pointer, or an option of these.
fn is_text(of: &Type) -> bool {
    match of {
        Type::Reference(reference) => is_text(&reference.elem),
        Type::Path(path) => match path.path.segments.last().map(|last| last.ident.to_string()).as_deref() {
            Some("String" | "str") => true,
            Some("Box" | "Rc" | "Arc" | "Cow" | "Option") => arguments(path).iter().any(|inner| is_text(inner)),
            _ => false,
        },
        _ => false,
    }
}

/// The types between the angle brackets of a type's last name.
fn arguments(path: &TypePath) -> Vec<&Type> {
    let Some(PathArguments::AngleBracketed(list)) = path.path.segments.last().map(|last| &last.arguments) else {
        return Vec::new();
    };
    let types = list.args.iter().filter_map(|argument| match argument {
        GenericArgument::Type(of) => Some(of),
        _ => None,
    });
    types.collect()
}

#[test]
fn errors_that_are_only_texts_are_found() {
    for (code, found) in [
        ("#[derive(Error)] enum E { A(String) }", true),
        ("#[derive(thiserror::Error)] struct E { message: Box<str> }", true),
        ("struct E(Cow<'static, str>); impl std::error::Error for E {}", true),
        ("fn f() -> Result<(), &'static str> { todo!() }", true),
        ("mod a { impl T for U { type R = Result<u8, String>; } }", true),
        ("#[derive(Error)] enum E { A { parameter: String }, B(usize), C { message: String, at: usize }, D }", false),
        ("enum Token { Word(String) } fn f() -> Result<String, E> { todo!() }", false),
        ("#[cfg(test)] mod tests { fn f() -> Result<(), String> { todo!() } }", false),
    ] {
        assert_eq!(!texts_in(&modules_of(code)).is_empty(), found, "{code}");
    }
}
