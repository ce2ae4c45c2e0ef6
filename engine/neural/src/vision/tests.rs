//! Tests of networks that see, on networks that are small enough to compute by hand.

use super::*;
use paracosm_perception::{Rect, TaskFlaw};
use prost::Message;
use tract_onnx::pb::{
    AttributeProto, GraphProto, ModelProto, NodeProto, OperatorSetIdProto, TensorProto, TensorShapeProto, TypeProto,
    ValueInfoProto, attribute_proto, tensor_proto, tensor_shape_proto, type_proto,
};

/// A picture of one colour.
fn picture(rgb: &[u8], width: u32, height: u32) -> Picture<'_> {
    Picture { width, height, rgb }
}

fn of_colour(colour: [u8; 3], width: u32, height: u32) -> Vec<u8> {
    colour.repeat((width * height) as usize)
}

fn tensor_of(name: &str, dims: &[i64], numbers: &[f32]) -> TensorProto {
    let raw_data = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let data_type = tensor_proto::DataType::Float as i32;
    TensorProto { name: name.to_owned(), dims: dims.to_vec(), data_type, raw_data, ..TensorProto::default() }
}

fn whole_numbers(name: &str, numbers: &[i64]) -> TensorProto {
    let raw_data = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let data_type = tensor_proto::DataType::Int64 as i32;
    let dims = vec![numbers.len() as i64];
    TensorProto { name: name.to_owned(), dims, data_type, raw_data, ..TensorProto::default() }
}

fn value(name: &str, dims: &[i64]) -> ValueInfoProto {
    let dim = |size: &i64| tensor_shape_proto::Dimension {
        value: Some(tensor_shape_proto::dimension::Value::DimValue(*size)),
        ..tensor_shape_proto::Dimension::default()
    };
    let shape = Some(TensorShapeProto { dim: dims.iter().map(dim).collect() });
    let tensor = type_proto::Tensor { elem_type: tensor_proto::DataType::Float as i32, shape };
    let kind = TypeProto { value: Some(type_proto::Value::TensorType(tensor)), ..TypeProto::default() };
    ValueInfoProto { name: name.to_owned(), r#type: Some(kind), ..ValueInfoProto::default() }
}

fn node(kind: &str, inputs: &[&str], output: &str) -> NodeProto {
    let input = inputs.iter().map(|name| (*name).to_owned()).collect();
    NodeProto { op_type: kind.to_owned(), input, output: vec![output.to_owned()], ..NodeProto::default() }
}

fn file(nodes: Vec<NodeProto>, constants: Vec<TensorProto>, outputs: Vec<ValueInfoProto>) -> Vec<u8> {
    let graph = GraphProto {
        node: nodes,
        initializer: constants,
        input: vec![value("image", &[1, 3, 8, 16])],
        output: outputs,
        ..GraphProto::default()
    };
    let opset_import = vec![OperatorSetIdProto { domain: String::new(), version: 13 }];
    ModelProto { ir_version: 8, opset_import, graph: Some(graph), ..ModelProto::default() }.encode_to_vec()
}

/// A detector with one box, whose scores for three classes are the means of the three channels. `last` is the operation
/// on the scores.
fn detector(last: &str) -> Vec<u8> {
    let nodes = vec![
        node("GlobalAveragePool", &["image"], "means"),
        node("Reshape", &["means", "shape"], "flat"),
        node(last, &["flat"], "scores"),
        node("Identity", &["corners"], "boxes"),
    ];
    let constants = vec![tensor_of("corners", &[1, 1, 4], &[0.25, 0.5, 0.75, 1.0]), whole_numbers("shape", &[1, 1, 3])];
    file(nodes, constants, vec![value("boxes", &[1, 1, 4]), value("scores", &[1, 1, 3])])
}

/// A segmentation network that answers the channels themselves.
fn segmenter() -> Vec<u8> {
    let pool = NodeProto {
        attribute: vec![whole_setting("kernel_shape", &[2, 2]), whole_setting("strides", &[2, 2])],
        ..node("MaxPool", &["image"], "mask")
    };
    file(vec![pool], Vec::new(), vec![value("mask", &[1, 3, 4, 8])])
}

fn whole_setting(name: &str, numbers: &[i64]) -> AttributeProto {
    let r#type = attribute_proto::AttributeType::Ints as i32;
    AttributeProto { name: name.to_owned(), ints: numbers.to_vec(), r#type, ..AttributeProto::default() }
}

const DETECTOR: &str = "\
task = \"detection\"
[input]
size = [16, 8]
mean = [0, 0, 0]
scale = [0.003921569, 0.003921569, 0.003921569]
[output]
boxes = \"boxes\"
scores = \"scores\"
form = \"xyxy\"
unit = \"share\"
classes = [\"car\", \"person\", \"dog\"]
";

const SEGMENTER: &str = "\
task = \"segmentation\"
[input]
size = [16, 8]
mean = [0, 0, 0]
scale = [0.003921569, 0.003921569, 0.003921569]
[output]
mask = \"mask\"
classes = [\"road\", \"grass\", \"sky\"]
positive = [\"road\"]
";

fn described(text: &str) -> Description {
    Description::parse(text).unwrap()
}

fn answer(network: &mut Vision, picture: Picture<'_>) -> Percept {
    network.perceive(&[picture]).unwrap().remove(0)
}

fn detections(percept: Percept) -> Vec<(usize, f64, Rect)> {
    let Percept::Boxes(boxes) = percept else { panic!("a mask") };
    boxes.into_iter().map(|one| (one.class, (100.0 * one.score).round() / 100.0, one.rect)).collect()
}

#[test]
fn a_box_lies_where_the_network_says_on_an_image_of_any_size() {
    let mut network = Vision::read(&detector("Identity"), described(DETECTOR)).unwrap();
    let rgb = of_colour([255, 51, 0], 64, 64);
    let rect = Rect { left: 16.0, top: 32.0, width: 32.0, height: 32.0 };
    assert_eq!(detections(answer(&mut network, picture(&rgb, 64, 64))), [(0, 1.0, rect), (1, 0.2, rect)]);
}

#[test]
fn forms_units_colours_and_proportions_of_a_description_are_obeyed() {
    let rgb = of_colour([255, 0, 0], 32, 32);
    let of = |from: &[(&str, &str)]| {
        let text = from.iter().fold(DETECTOR.to_owned(), |text, (from, to)| text.replace(from, to));
        detections(answer(&mut Vision::read(&detector("Identity"), described(&text)).unwrap(), picture(&rgb, 32, 32)))
    };
    let rect = |left, top, width, height| Rect { left, top, width, height };
    assert_eq!(of(&[("xyxy", "yxyx")]), [(0, 1.0, rect(16.0, 8.0, 16.0, 16.0))]);
    assert_eq!(of(&[("xyxy", "cxcywh")]), [(0, 1.0, rect(-4.0, 0.0, 24.0, 32.0))]);
    // A pixel of the input is 2 pixels wide and 4 pixels high on the image.
    assert_eq!(of(&[("share", "pixels")]), [(0, 1.0, rect(0.5, 2.0, 1.0, 2.0))]);
    assert_eq!(of(&[("[output]", "colours = \"bgr\"\n[output]")])[0].0, 2);
    // The image has 8 x 8 pixels in the middle of the input, with 4 pixels of grey on either side.
    let [(class, score, found), ..] = of(&[("[output]", "resize = \"letterbox\"\n[output]")])[..] else { panic!() };
    assert_eq!((class, found), (0, rect(0.0, 16.0, 32.0, 16.0)));
    assert_eq!(score, 0.72, "half of the input is red, and the other half is grey: {score}");
}

#[test]
fn the_seed_of_the_fuzzer_is_the_detector_of_these_tests() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/seeds/network/detector.onnx");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(path, detector("Identity")).unwrap();
    }
    assert!(std::fs::read(path).unwrap() == detector("Identity"), "UPDATE_GOLDEN=1 writes the seed anew");
    let text = include_str!("../../../../fuzz/seeds/network/detector.toml");
    assert_eq!(described(text), described(DETECTOR));
}

#[test]
fn a_mask_has_the_pixels_of_the_image() {
    let mut network = Vision::read(&segmenter(), described(SEGMENTER)).unwrap();
    // The left half is road, the right half is sky.
    let rgb: Vec<u8> = (0..32 * 16).flat_map(|pixel| if pixel % 32 < 16 { [200, 0, 0] } else { [0, 0, 200] }).collect();
    let Percept::Mask(mask) = answer(&mut network, picture(&rgb, 32, 16)) else { panic!("boxes") };
    assert_eq!((mask.width, mask.height), (32, 16));
    let expected: Vec<bool> = (0..32 * 16).map(|pixel| pixel % 32 < 16).collect();
    assert_eq!(mask.pixels, expected);
}

#[test]
fn networks_that_do_not_fit_their_description_are_refused() {
    let refused = |contents: &[u8], text: &str| Vision::read(contents, described(text)).unwrap_err().to_string();
    let changed = |from: &str, to: &str| DETECTOR.replace(from, to);
    let box_of = detector("Identity");
    assert!(refused(&box_of, &changed("[16, 8]", "[16, 16]")).contains("expected one image of 1 x 3 x 16 x 16, float"));
    let message = refused(&box_of, &changed("scores = \"scores\"", "scores = \"score\""));
    assert!(message.contains("did you mean `scores`?"), "{message}");
    let message = refused(&box_of, &changed(", \"dog\"", ""));
    assert!(message.contains("the output `scores` is 1 x 1 x 3, expected 1 x 1 x 2"), "{message}");
    assert!(refused(&box_of, SEGMENTER).contains("no output `mask`"));
    assert!(refused(b"no network", DETECTOR).contains("ONNX"));
}

#[test]
fn scores_that_are_no_numbers_are_an_error_of_the_image() {
    let text = DETECTOR.replace("mean = [0, 0, 0]", "mean = [100, 100, 100]");
    let mut network = Vision::read(&detector("Sqrt"), described(&text)).unwrap();
    let rgb = of_colour([0, 0, 0], 16, 8);
    let error = network.perceive(&[picture(&rgb, 16, 8)]).unwrap_err();
    assert!(error.to_string().contains("a box has the score NaN"), "{error}");
}

#[test]
fn wrong_descriptions_name_the_entry_and_the_line() {
    let flaw = |from: &str, to: &str| Description::parse(&DETECTOR.replace(from, to)).unwrap_err();
    let text = DETECTOR.replace("form =", "from =");
    let unknown = Description::parse(&text).unwrap_err();
    assert!(unknown.to_string().contains("unknown field `from`") && unknown.line(&text) == Some(9), "{unknown}");
    assert!(flaw("task = \"detection\"", "task = \"detect\"").to_string().contains("did you mean `detection`?"));
    assert!(flaw("[16, 8]", "[16, 0]").to_string().contains("16 x 0"));
    assert!(flaw("mean = [0, 0, 0]", "mean = [0, inf, 0]").to_string().contains("`mean` of [input] has inf"));
    assert!(flaw("[\"car\", \"person\", \"dog\"]", "[]").to_string().contains("`classes` is empty"));
    assert_eq!(
        flaw("unit = \"share\"", "unit = \"share\"\nthreshold = 2"),
        TaskFlaw::Share { entry: "threshold", found: 2.0 }.into()
    );
    let wrong = SEGMENTER.replace("positive = [\"road\"]", "positive = [\"rode\"]");
    assert!(Description::parse(&wrong).unwrap_err().to_string().contains("did you mean `road`?"));
}
