//! Writes a graph of streams in the DOT language of Graphviz, to be looked at.

use super::node::{Binary, Equation, Node, NodeKind};
use super::order::{GraphFlaw, order};
use super::sketch::{Line, Sketch};
use std::collections::HashMap;
use std::fmt::Write;
use std::rc::Rc;

/// Writes a graph of streams with its readers as DOT. Outputs of objects are boxes, parameters ellipses, and readers
/// bold boxes. The input of a `pre`, which is from the tick before, is a dashed line. If the order of two inputs
/// matters, their lines are numbered. The parts of objects follow: `inputs` is the number of readers before the first input of an
/// object. The lines from parts to outputs are dashed, because an output shows the state at the beginning of a tick.
pub(crate) fn dot(
    title: &str,
    readers: &[(String, Rc<Node>)],
    equations: &[Equation],
    (sketch, inputs): (&Sketch, usize),
) -> Result<String, GraphFlaw> {
    let ordered = order(readers.iter().map(|(_, node)| node), equations)?;
    let mut names: HashMap<*const Node, Vec<&str>> = HashMap::new();
    let mut numbers: HashMap<*const Node, usize> = HashMap::new();
    for node in &ordered {
        match &node.kind {
            NodeKind::Named(name) | NodeKind::Forward { name, .. } => {
                names.entry(Rc::as_ptr(meant(node, equations))).or_default().push(name);
            }
            _ => {
                let number = numbers.len();
                numbers.insert(Rc::as_ptr(node), number);
            }
        }
    }
    let number = |node| numbers[&Rc::as_ptr(meant(node, equations))];
    let mut text = format!("digraph {} {{\n  rankdir=LR;\n", quoted(title));
    for node in ordered.iter().filter(|node| numbers.contains_key(&Rc::as_ptr(node))) {
        let name: String =
            names.get(&Rc::as_ptr(node)).into_iter().flatten().map(|name| format!("{name} = ")).collect();
        let (label, shape) = match &node.kind {
            NodeKind::Constant { parameter: Some(name), .. } => (format!("{name} = {node}"), "ellipse"),
            NodeKind::Signal { .. } => (node.label(), "ellipse"),
            NodeKind::Output { .. } => (node.label(), "box"),
            _ => (node.label(), "plaintext"),
        };
        let label = quoted(&format!("{name}{label}"));
        let _ = writeln!(text, "  n{} [label={label}, shape={shape}];", number(node));
    }
    for node in ordered.iter().filter(|node| numbers.contains_key(&Rc::as_ptr(node))) {
        for (i, input) in node.inputs.iter().enumerate() {
            let style = match &node.kind {
                NodeKind::Pre => " [style=dashed]".to_owned(),
                kind if node.inputs.len() > 1 && !commutes(kind) => format!(" [headlabel={}]", i + 1),
                _ => String::new(),
            };
            let _ = writeln!(text, "  n{} -> n{}{style};", number(input), number(node));
        }
    }
    for (i, (reader, node)) in readers.iter().enumerate() {
        let _ = writeln!(text, "  r{i} [label={}, shape=box, style=bold];", quoted(reader));
        let _ = writeln!(text, "  n{} -> r{i};", number(node));
    }
    for (i, (label, form)) in sketch.parts.iter().enumerate() {
        let _ = writeln!(text, "  p{i} [label={}, {}];", quoted(label), form.style());
    }
    for line in &sketch.lines {
        let _ = match line {
            Line::Starts(input, to, words) => {
                writeln!(text, "  r{} -> p{} [label={}];", inputs + input.0, to.0, quoted(words))
            }
            Line::Leads(from, to) => writeln!(text, "  p{} -> p{};", from.0, to.0),
            Line::Shows(from, _) => {
                let mut shown = ordered.iter().filter(|node| line.shows(node)).map(|node| number(node));
                shown.try_for_each(|to| writeln!(text, "  p{} -> n{to} [style=dashed];", from.0))
            }
        };
    }
    text.push_str("}\n");
    Ok(text)
}

/// Returns the node that a name stands for.
fn meant<'a>(node: &'a Rc<Node>, equations: &'a [Equation]) -> &'a Rc<Node> {
    let mut node = node;
    loop {
        node = match &node.kind {
            NodeKind::Named(_) => &node.inputs[0],
            NodeKind::Forward { equation, .. } => match &equations[*equation].definition {
                Some(definition) => definition,
                None => return node,
            },
            _ => return node,
        };
    }
}

fn commutes(kind: &NodeKind) -> bool {
    use Binary::{And, Dot, Greatest, Least, Or, Product, Sum};
    matches!(kind, NodeKind::Equal | NodeKind::Binary(Sum | Product | Least | Greatest | Dot | And | Or))
}

/// Returns a text as a quoted string of DOT.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n"))
}
