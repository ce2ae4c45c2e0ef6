//! Limits on networks in files of strangers: on their size, and on the operations that they may have.
//!
//! The library that runs networks computes constants while it reads a network, so a small file could ask for any amount
//! of memory. Only operations that networks for driving need are run, and tensors have a greatest size.

use std::collections::{HashMap, HashSet};
use thiserror::Error;
use tract_onnx::pb::{GraphProto, ModelProto, NodeProto};
use tract_onnx::prelude::TypedModel;

/// The greatest size of a network's file in MiB.
pub const MOST_MEBIBYTES: usize = 256;

/// The greatest number of operations in a network.
const MOST_OPERATIONS: usize = 10_000;

/// The greatest number of numbers in all tensors of a network together.
const MOST_NUMBERS: usize = 1 << 28;

/// The operations that a network may have, by their names in ONNX.
#[rustfmt::skip]
const OPERATIONS: [&str; 60] = [
    "Abs", "Add", "AveragePool", "BatchNormalization", "Cast", "Ceil", "Clip", "Concat", "Constant", "Conv", "Div",
    "Dropout", "Elu", "Erf", "Exp", "Flatten", "Floor", "Gather", "Gelu", "Gemm", "GlobalAveragePool",
    "GlobalMaxPool", "HardSigmoid", "HardSwish", "Identity", "InstanceNormalization", "LayerNormalization",
    "LeakyRelu", "Log", "LogSoftmax", "MatMul", "Max", "MaxPool", "Min", "Mish", "Mul", "Neg", "PRelu", "Pow",
    "Reciprocal", "ReduceMax", "ReduceMean", "ReduceMin", "ReduceSum", "Relu", "Reshape", "Selu", "Shape", "Sigmoid",
    "Slice", "Softmax", "Softplus", "Split", "Sqrt", "Squeeze", "Sub", "Sum", "Tanh", "Transpose", "Unsqueeze",
];

/// Operations with padding: the sizes of the inputs do not bound the size of the result.
const WITH_PADDING: [&str; 3] = ["AveragePool", "Conv", "MaxPool"];

/// The limit that a network exceeds.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Limit {
    /// The file is too large.
    #[error("the file has more than {MOST_MEBIBYTES} MiB, which is the limit: reduce the network")]
    Size,
    /// The network has too many operations.
    #[error("the network has {found} operations, expected at most {MOST_OPERATIONS}: reduce the network")]
    Operations {
        /// The number of operations in the network.
        found: usize,
    },
    /// The network has an operation that is not run.
    #[error("the network has the operation `{name}`, which is not run; the operations are {}", OPERATIONS.join(", "))]
    Operation {
        /// The name of the operation in ONNX.
        name: String,
    },
    /// An operation uses a tensor that no earlier operation makes.
    #[error("an operation uses the tensor `{name}` before the tensor is made, expected the operations in order")]
    Order {
        /// The name of the tensor.
        name: String,
    },
    /// Two operations make a tensor of the same name.
    #[error("two operations make the tensor `{name}`")]
    Twice {
        /// The name of the tensor.
        name: String,
    },
    /// The tensors of the network are too large.
    #[error("the tensors of the network have more than {MOST_NUMBERS} numbers, which is the limit: reduce the network")]
    Tensors,
}

/// Checks a file before its network is computed.
///
/// # Errors
/// The network is beyond a limit.
pub(crate) fn check(file: &ModelProto) -> Result<(), Limit> {
    let Some(graph) = &file.graph else { return Ok(()) };
    if graph.node.len() > MOST_OPERATIONS {
        return Err(Limit::Operations { found: graph.node.len() });
    }
    let unknown = graph.node.iter().find(|node| !is_known(node));
    if let Some(node) = unknown {
        return Err(Limit::Operation { name: node.op_type.clone() });
    }
    check_constants(graph)
}

fn is_known(node: &NodeProto) -> bool {
    let has_graph = node.attribute.iter().any(|setting| setting.g.is_some() || !setting.graphs.is_empty());
    matches!(node.domain.as_str(), "" | "ai.onnx") && OPERATIONS.contains(&node.op_type.as_str()) && !has_graph
}

/// Checks that the constants of a network, and the results of operations on constants alone, fit in memory. The result
/// of an operation on constants has at most the product of the sizes of its inputs, or their sum.
fn check_constants(graph: &GraphProto) -> Result<(), Limit> {
    let numbers = |dimensions: &[i64]| {
        let dimensions = dimensions.iter().map(|size| usize::try_from(*size).unwrap_or(usize::MAX));
        dimensions.fold(1, usize::saturating_mul)
    };
    let mut sizes: HashMap<&str, usize> =
        graph.initializer.iter().map(|tensor| (tensor.name.as_str(), numbers(&tensor.dims))).collect();
    let mut named: HashSet<&str> =
        graph.input.iter().map(|input| input.name.as_str()).chain(sizes.keys().copied()).collect();
    let mut all = sizes.values().fold(0usize, |all, size| all.saturating_add(*size));
    for node in &graph.node {
        let inputs = node.input.iter().filter(|name| !name.is_empty());
        // As the format demands, an operation comes after the operations that make its inputs. Otherwise a constant would
        // not be known as one.
        if let Some(unknown) = inputs.clone().find(|name| !named.contains(name.as_str())) {
            return Err(Limit::Order { name: unknown.clone() });
        }
        if let Some(twice) = node.output.iter().filter(|name| !name.is_empty()).find(|name| !named.insert(name)) {
            return Err(Limit::Twice { name: twice.clone() });
        }
        let Some(inputs) = inputs.map(|name| sizes.get(name.as_str()).copied()).collect::<Option<Vec<usize>>>() else {
            // The shape of any tensor is a constant.
            if node.op_type == "Shape" {
                sizes.extend(node.output.iter().map(|name| (name.as_str(), 8)));
            }
            continue;
        };
        let own = node.attribute.iter().filter_map(|setting| setting.t.as_ref()).map(|tensor| numbers(&tensor.dims));
        let product = inputs.iter().copied().filter(|size| *size > 0).fold(1, usize::saturating_mul);
        let sum = inputs.iter().copied().chain(own).fold(0, usize::saturating_add);
        let size = if WITH_PADDING.contains(&node.op_type.as_str()) { usize::MAX } else { product.max(sum) };
        all = all.saturating_add(size);
        if all > MOST_NUMBERS {
            return Err(Limit::Tensors);
        }
        sizes.extend(node.output.iter().map(|name| (name.as_str(), size)));
    }
    if all > MOST_NUMBERS { Err(Limit::Tensors) } else { Ok(()) }
}

/// Checks the tensors of a network that was read.
///
/// # Errors
/// The tensors are beyond the limit.
pub(crate) fn check_tensors(network: &TypedModel) -> Result<(), Limit> {
    let outputs = network.nodes.iter().flat_map(|node| &node.outputs);
    let sizes = outputs.map(|output| output.fact.shape.volume().as_i64().and_then(|size| usize::try_from(size).ok()));
    let all = sizes.fold(0usize, |all, size| all.saturating_add(size.unwrap_or(usize::MAX)));
    if all > MOST_NUMBERS { Err(Limit::Tensors) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CLONED, Model};
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64;
    use tract_onnx::pb::{TensorProto, ValueInfoProto};
    use tract_onnx::prelude::Framework;

    fn node(kind: &str, inputs: &[&str], output: &str) -> NodeProto {
        let input = inputs.iter().map(|name| (*name).to_owned()).collect();
        NodeProto { op_type: kind.to_owned(), input, output: vec![output.to_owned()], ..NodeProto::default() }
    }

    fn with(node: Vec<NodeProto>) -> ModelProto {
        let initializer = vec![TensorProto { name: "c".to_owned(), dims: vec![100, 100], ..TensorProto::default() }];
        let input = vec![ValueInfoProto { name: "image".to_owned(), ..ValueInfoProto::default() }];
        let graph = GraphProto { node, initializer, input, ..GraphProto::default() };
        ModelProto { graph: Some(graph), ..ModelProto::default() }
    }

    #[test]
    fn the_networks_that_come_with_the_software_are_within_all_limits() {
        for network in CLONED {
            let file = tract_onnx::onnx().proto_model_for_read(&mut &network.contents[..]).unwrap();
            assert_eq!(check(&file), Ok(()), "{}", network.name);
        }
    }

    #[test]
    fn operations_and_constants_beyond_the_limits_are_refused() {
        assert_eq!(check(&with(vec![node("Relu", &["image"], "y"), node("Add", &["c", "c"], "z")])), Ok(()));
        let name = || "Loop".to_owned();
        assert_eq!(check(&with(vec![node("Loop", &["c"], "y")])), Err(Limit::Operation { name: name() }));
        let late = vec![node("Mul", &["d", "d"], "z"), node("Identity", &["c"], "d")];
        assert_eq!(check(&with(late)), Err(Limit::Order { name: "d".to_owned() }));
        let twice = vec![node("Relu", &["image"], "d"), node("Identity", &["c"], "d")];
        assert_eq!(check(&with(twice)), Err(Limit::Twice { name: "d".to_owned() }));
        let many = vec![node("Relu", &["image"], "y"); MOST_OPERATIONS + 1];
        assert_eq!(check(&with(many)), Err(Limit::Operations { found: MOST_OPERATIONS + 1 }));
        // Each operation doubles the constant before it.
        let doubles = (0..40).map(|i| {
            let before = if i == 0 { "c".to_owned() } else { format!("d{}", i - 1) };
            node("Concat", &[&before, &before], &format!("d{i}"))
        });
        assert_eq!(check(&with(doubles.collect())), Err(Limit::Tensors));
        assert_eq!(
            check(&with(vec![node("MatMul", &["c", "c"], "d"), node("MatMul", &["d", "d"], "e")])),
            Err(Limit::Tensors)
        );
        assert_eq!(check(&with(vec![node("Conv", &["c", "c"], "d")])), Err(Limit::Tensors));
    }

    #[test]
    fn mutated_networks_are_read_or_refused() {
        let cases = std::env::var("PARACOSM_CASES").map_or(150, |cases| cases.parse().expect("a number of cases"));
        let mut rng = Pcg64::seed_from_u64(20);
        let smallest = CLONED.iter().map(|network| network.contents).min_by_key(|contents| contents.len()).unwrap();
        for _ in 0..cases {
            let mut contents = smallest.to_vec();
            for _ in 0..rng.random_range(1..8) {
                // Weights take most of the file. The description of the operations stands at both ends.
                let near = rng.random_range(0..contents.len().min(4000));
                let at = if rng.random() { near } else { contents.len() - 1 - near };
                match rng.random_range(0..3) {
                    0 => contents[at] = rng.random(),
                    1 => contents[at] ^= 1 << rng.random_range(0..8),
                    _ => drop(contents.drain(at..(at + rng.random_range(1..9)).min(contents.len()))),
                }
            }
            if let Err(error) = Model::read(&contents) {
                assert!(!error.to_string().is_empty());
            }
        }
    }
}
