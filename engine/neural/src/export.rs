//! Writes a trained network as a file in the ONNX format.

use crate::network::{CONVOLUTIONS, DENSE, LEAK, MIDDLE, Network, SPEED_SCALE};
use burn::prelude::Tensor;
use prost::Message;
use tract_onnx::pb::attribute_proto::AttributeType;
use tract_onnx::pb::tensor_proto::DataType;
use tract_onnx::pb::tensor_shape_proto::{Dimension, dimension};
use tract_onnx::pb::{
    AttributeProto, GraphProto, ModelProto, NodeProto, OperatorSetIdProto, TensorProto, TensorShapeProto, TypeProto,
    ValueInfoProto, type_proto,
};

/// The version of the ONNX format, and the version of its set of operations.
const FORMAT: i64 = 8;
const OPERATIONS: i64 = 13;

/// Returns the contents of the ONNX file of a network. `story` describes the origin of the network.
pub fn onnx(network: &Network, [width, height]: [u32; 2], story: &str) -> Vec<u8> {
    let mut file = File::default();
    file.constant("middle", &[], vec![MIDDLE]);
    file.constant("speed scale", &[], vec![SPEED_SCALE]);
    file.node("Sub", &["image", "middle"], "seen", vec![]);
    let mut last = "seen".to_owned();
    for (i, (layer, form)) in network.convolutions.iter().zip(CONVOLUTIONS).enumerate() {
        let name = format!("convolution {}", i + 1);
        let weights = file.tensor(&format!("{name} weights"), layer.weight.val());
        let bias = file.tensor(&format!("{name} bias"), layer.bias.as_ref().expect("it was made with one").val());
        let both = |name, size: usize| attribute(name, vec![size as i64; 2]);
        let around = attribute("pads", vec![form.padding as i64; 4]);
        let attributes = vec![both("kernel_shape", form.kernel), both("strides", form.stride), around];
        file.node("Conv", &[&last, &weights, &bias], &name, attributes);
        last = format!("{name} rectified");
        file.node("LeakyRelu", &[&name], &last, vec![leak()]);
    }
    file.node("Flatten", &[&last], "found", vec![]);
    file.node("Mul", &["speed", "speed scale"], "scaled speed", vec![]);
    file.node("Concat", &["found", "scaled speed"], "found and speed", vec![integer("axis", 1)]);
    last = "found and speed".to_owned();
    for (i, layer) in network.dense.iter().enumerate() {
        let name = format!("dense {}", i + 1);
        let weights = file.tensor(&format!("{name} weights"), layer.weight.val());
        let bias = file.tensor(&format!("{name} bias"), layer.bias.as_ref().expect("it was made with one").val());
        file.node("Gemm", &[&last, &weights, &bias], &name, vec![]);
        if i + 1 < DENSE.len() {
            last = format!("{name} rectified");
            file.node("LeakyRelu", &[&name], &last, vec![leak()]);
        } else {
            file.node("Tanh", &[&name], "control", vec![]);
        }
    }
    let graph = GraphProto {
        name: "driver".to_owned(),
        node: file.nodes,
        initializer: file.constants,
        input: vec![value("image", &[1, 3, height.into(), width.into()]), value("speed", &[1, 1])],
        output: vec![value("control", &[1, 2])],
        ..GraphProto::default()
    };
    let model = ModelProto {
        ir_version: FORMAT,
        opset_import: vec![OperatorSetIdProto { domain: String::new(), version: OPERATIONS }],
        producer_name: env!("CARGO_PKG_NAME").to_owned(),
        producer_version: env!("CARGO_PKG_VERSION").to_owned(),
        doc_string: story.to_owned(),
        graph: Some(graph),
        ..ModelProto::default()
    };
    model.encode_to_vec()
}

#[derive(Default)]
struct File {
    nodes: Vec<NodeProto>,
    constants: Vec<TensorProto>,
}

impl File {
    fn node(&mut self, kind: &str, inputs: &[&str], output: &str, attribute: Vec<AttributeProto>) {
        self.nodes.push(NodeProto {
            input: inputs.iter().map(|&name| name.to_owned()).collect(),
            output: vec![output.to_owned()],
            name: output.to_owned(),
            op_type: kind.to_owned(),
            attribute,
            ..NodeProto::default()
        });
    }

    fn constant(&mut self, name: &str, shape: &[usize], numbers: Vec<f32>) {
        self.constants.push(TensorProto {
            dims: shape.iter().map(|&size| size as i64).collect(),
            data_type: DataType::Float as i32,
            name: name.to_owned(),
            raw_data: numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            ..TensorProto::default()
        });
    }

    /// Adds a tensor that was learnt, and returns its name.
    fn tensor<const D: usize>(&mut self, name: &str, tensor: Tensor<D>) -> String {
        let shape = tensor.dims();
        let data = tensor.into_data();
        self.constant(name, &shape, data.as_slice().expect("networks are made of floats").to_vec());
        name.to_owned()
    }
}

fn attribute(name: &str, ints: Vec<i64>) -> AttributeProto {
    AttributeProto { name: name.to_owned(), r#type: AttributeType::Ints as i32, ints, ..AttributeProto::default() }
}

/// Makes the attribute for the slope of a rectifier below zero.
fn leak() -> AttributeProto {
    AttributeProto {
        name: "alpha".to_owned(),
        r#type: AttributeType::Float as i32,
        f: LEAK,
        ..AttributeProto::default()
    }
}

fn integer(name: &str, i: i64) -> AttributeProto {
    AttributeProto { name: name.to_owned(), r#type: AttributeType::Int as i32, i, ..AttributeProto::default() }
}

fn value(name: &str, shape: &[i64]) -> ValueInfoProto {
    let size = |&size: &i64| Dimension { value: Some(dimension::Value::DimValue(size)), ..Dimension::default() };
    let shape = TensorShapeProto { dim: shape.iter().map(size).collect() };
    let tensor = type_proto::Tensor { elem_type: DataType::Float as i32, shape: Some(shape) };
    let of_tensor = TypeProto { value: Some(type_proto::Value::TensorType(tensor)), ..TypeProto::default() };
    ValueInfoProto { name: name.to_owned(), r#type: Some(of_tensor), ..ValueInfoProto::default() }
}
