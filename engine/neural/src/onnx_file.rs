//! A file in the ONNX format, operation by operation.

use burn::prelude::Tensor;
use prost::Message;
use tract_onnx::pb::attribute_proto::AttributeType;
use tract_onnx::pb::tensor_proto::DataType;
use tract_onnx::pb::tensor_shape_proto::{Dimension, dimension};
use tract_onnx::pb::{
    AttributeProto, GraphProto, ModelProto, NodeProto, OperatorSetIdProto, StringStringEntryProto, TensorProto,
    TensorShapeProto, TypeProto, ValueInfoProto, type_proto,
};

/// The version of the ONNX format, and the version of its set of operations.
const FORMAT: i64 = 8;
const OPERATIONS: i64 = 13;

/// The parts of a file that is being written.
#[derive(Default)]
pub(crate) struct File {
    nodes: Vec<NodeProto>,
    constants: Vec<TensorProto>,
    properties: Vec<StringStringEntryProto>,
}

impl File {
    /// Adds an operation with one output, which also names the operation.
    pub fn node(&mut self, kind: &str, inputs: &[&str], output: &str, attribute: Vec<AttributeProto>) {
        self.nodes.push(NodeProto {
            input: inputs.iter().map(|&name| name.to_owned()).collect(),
            output: vec![output.to_owned()],
            name: output.to_owned(),
            op_type: kind.to_owned(),
            attribute,
            ..NodeProto::default()
        });
    }

    /// Adds a constant tensor of floats.
    pub fn constant(&mut self, name: &str, shape: &[usize], numbers: Vec<f32>) {
        self.constants.push(TensorProto {
            dims: shape.iter().map(|&size| size as i64).collect(),
            data_type: DataType::Float as i32,
            name: name.to_owned(),
            raw_data: numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            ..TensorProto::default()
        });
    }

    /// Adds a tensor that was learnt, and returns its name.
    pub fn tensor<const D: usize>(&mut self, name: &str, tensor: Tensor<D>) -> String {
        let shape = tensor.dims();
        let data = tensor.into_data();
        self.constant(name, &shape, data.as_slice().expect("networks are made of floats").to_vec());
        name.to_owned()
    }

    /// Adds a constant tensor of whole numbers, such as a shape.
    pub fn integers(&mut self, name: &str, numbers: &[i64]) {
        self.constants.push(TensorProto {
            dims: vec![numbers.len() as i64],
            data_type: DataType::Int64 as i32,
            name: name.to_owned(),
            raw_data: numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            ..TensorProto::default()
        });
    }

    /// Adds a property of the network that is no part of its arithmetic.
    pub fn property(&mut self, key: &str, value: &str) {
        self.properties.push(StringStringEntryProto { key: key.to_owned(), value: value.to_owned() });
    }

    /// Returns the contents of the file. Inputs and outputs have names and shapes; `story` describes the origin of the
    /// network.
    pub fn finish(self, name: &str, inputs: &[(&str, &[i64])], outputs: &[(&str, &[i64])], story: &str) -> Vec<u8> {
        let values = |of: &[(&str, &[i64])]| of.iter().map(|(name, shape)| value(name, shape)).collect();
        let graph = GraphProto {
            name: name.to_owned(),
            node: self.nodes,
            initializer: self.constants,
            input: values(inputs),
            output: values(outputs),
            ..GraphProto::default()
        };
        let model = ModelProto {
            ir_version: FORMAT,
            opset_import: vec![OperatorSetIdProto { domain: String::new(), version: OPERATIONS }],
            producer_name: env!("CARGO_PKG_NAME").to_owned(),
            producer_version: env!("CARGO_PKG_VERSION").to_owned(),
            doc_string: story.to_owned(),
            graph: Some(graph),
            metadata_props: self.properties,
            ..ModelProto::default()
        };
        model.encode_to_vec()
    }
}

/// Makes an attribute of whole numbers.
pub(crate) fn attribute(name: &str, ints: Vec<i64>) -> AttributeProto {
    AttributeProto { name: name.to_owned(), r#type: AttributeType::Ints as i32, ints, ..AttributeProto::default() }
}

/// Makes an attribute of one whole number.
pub(crate) fn integer(name: &str, i: i64) -> AttributeProto {
    AttributeProto { name: name.to_owned(), r#type: AttributeType::Int as i32, i, ..AttributeProto::default() }
}

fn value(name: &str, shape: &[i64]) -> ValueInfoProto {
    let size = |&size: &i64| Dimension { value: Some(dimension::Value::DimValue(size)), ..Dimension::default() };
    let shape = TensorShapeProto { dim: shape.iter().map(size).collect() };
    let tensor = type_proto::Tensor { elem_type: DataType::Float as i32, shape: Some(shape) };
    let of_tensor = TypeProto { value: Some(type_proto::Value::TensorType(tensor)), ..TypeProto::default() };
    ValueInfoProto { name: name.to_owned(), r#type: Some(of_tensor), ..ValueInfoProto::default() }
}

/// Makes an attribute of one number.
pub(crate) fn number(name: &str, f: f32) -> AttributeProto {
    AttributeProto { name: name.to_owned(), r#type: AttributeType::Float as i32, f, ..AttributeProto::default() }
}
