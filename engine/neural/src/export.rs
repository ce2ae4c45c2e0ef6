//! Writes a trained network that drives as a file in the ONNX format.

use crate::model::LOOK;
use crate::network::{CONVOLUTIONS, DENSE, LEAK, MIDDLE, Network, SPEED_SCALE};
use crate::onnx_file::{File, attribute, integer, number};
use paracosm_engine::sensor::Look;

/// Returns the contents of the ONNX file of a network, which drives by images of the given size and look. `story`
/// describes the origin of the network.
pub fn onnx(network: &Network, ([width, height], look): ([u32; 2], Look), story: &str) -> Vec<u8> {
    let mut file = File::default();
    if look != Look::default() {
        file.property(LOOK, look.name());
    }
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
        file.node("LeakyRelu", &[&name], &last, vec![number("alpha", LEAK)]);
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
            file.node("LeakyRelu", &[&name], &last, vec![number("alpha", LEAK)]);
        } else {
            file.node("Tanh", &[&name], "control", vec![]);
        }
    }
    let inputs = [("image", &[1, 3, i64::from(height), i64::from(width)][..]), ("speed", &[1, 1])];
    file.finish("driver", &inputs, &[("control", &[1, 2])], story)
}
