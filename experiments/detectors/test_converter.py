"""Tests of the converter. They need no package of a detector; one test looks at a package if it was fetched."""

import json
import tempfile
import unittest
from pathlib import Path

import numpy as np
from onnx.reference import ReferenceEvaluator

from anchors import ssd_anchors
from detectors import DETECTORS
from fetch import DEFAULT_OUT, description
from network import ConversionError, Network, operations, pads
from tfjs import GraphModel, read_weights

RANDOM = np.random.default_rng(0)


def numbers(*shape):
    return RANDOM.normal(size=shape).astype(np.float32)


def run(network, outputs, image):
    """The outputs for an image of height x width x 3, and the model."""
    model = network.finish(outputs, "")
    return ReferenceEvaluator(model).run(None, {"image": image.transpose(2, 0, 1)[None]}), model


def naive_conv(image, weights, stride, top, left):
    """A convolution by its definition, with zeros outside the image."""
    height, width = (-(-size // stride) for size in image.shape[:2])
    out = np.zeros((height, width, weights.shape[3]))
    for y, x, dy, dx in np.ndindex(height, width, *weights.shape[:2]):
        row, column = y * stride + dy - top, x * stride + dx - left
        if 0 <= row < image.shape[0] and 0 <= column < image.shape[1]:
            out[y, x] += image[row, column] @ weights[dy, dx]
    return out


class Converter(unittest.TestCase):
    def test_same_padding_puts_the_odd_pixel_below_and_on_the_right(self):
        self.assertEqual(pads((300, 300), (3, 3), (2, 2), (1, 1), "SAME"), [0, 0, 1, 1])
        self.assertEqual(pads((75, 75), (3, 3), (2, 2), (1, 1), "SAME"), [1, 1, 1, 1])
        self.assertEqual(pads((10, 10), (5, 5), (1, 1), (2, 2), "SAME"), [4, 4, 4, 4])

    def test_a_convolution_with_factor_offset_and_normalisation_is_one_operation(self):
        image, weights, network = numbers(6, 8, 3), numbers(3, 3, 3, 4), Network(8, 6)
        factor, offset, scale, shift, mean = (numbers(4) for _ in range(5))
        variance = np.abs(numbers(4)) + 1
        x = network.conv(network.input, weights, (2, 2), "SAME")
        x = network.binary("Mul", x, network.constant(factor))
        x = network.binary("Add", network.constant(offset), x)
        x = network.batch_norm(x, *(network.constant(value) for value in (scale, shift, mean, variance)), 1e-3)
        (result,), model = run(network, {"out": x}, image)
        expected = naive_conv(image, weights, 2, 0, 0) * factor + offset
        expected = (expected - mean) / np.sqrt(variance + 1e-3) * scale + shift
        np.testing.assert_allclose(result[0], expected, atol=1e-4)
        self.assertEqual(operations(model), {"Conv": 1, "Transpose": 1})

    def test_an_offset_stays_apart_if_the_convolution_is_used_twice(self):
        image, weights, network = numbers(4, 4, 3), numbers(1, 1, 3, 2), Network(4, 4)
        x = network.conv(network.input, weights, (1, 1), "SAME")
        more = network.binary("Add", x, network.constant(np.float32([1, 2])))
        (first, second), _ = run(network, {"first": x, "second": more}, image)
        np.testing.assert_allclose(second - first, np.broadcast_to(np.float32([1, 2]), first.shape), atol=1e-5)

    def test_a_depthwise_convolution_sees_each_channel_alone(self):
        image, weights, network = numbers(5, 5, 3), numbers(3, 3, 3, 2), Network(5, 5)
        x = network.depthwise(network.input, weights, (1, 1), "SAME")
        (result,), _ = run(network, {"out": x}, image)
        for channel in range(3):
            expected = naive_conv(image[..., [channel]], weights[:, :, [channel]], 1, 1, 1)
            np.testing.assert_allclose(result[0, ..., 2 * channel:2 * channel + 2], expected, atol=1e-5)

    def test_enlarging_keeps_the_pixels_and_puts_means_between_them(self):
        image, network = numbers(3, 2, 3), Network(2, 3)
        (result,), _ = run(network, {"out": network.resize_bilinear(network.input, 6, 6)}, image)
        rows, columns = np.minimum(np.arange(6) / 2, 2), np.minimum(np.arange(6) / 3, 1)
        for y, x in np.ndindex(6, 6):
            top, left = int(rows[y]), int(columns[x])
            below, right, dy, dx = min(top + 1, 2), min(left + 1, 1), rows[y] - top, columns[x] - left
            expected = ((1 - dy) * ((1 - dx) * image[top, left] + dx * image[top, right])
                        + dy * ((1 - dx) * image[below, left] + dx * image[below, right]))
            np.testing.assert_allclose(result[0, y, x], expected, atol=1e-5)

    def test_operations_on_constants_leave_no_trace(self):
        network = Network(2, 2)
        number = network.binary("Mul", network.constant(np.float32([2, 3, 4])), network.constant(np.float32(10)))
        (result,), model = run(network, {"out": network.binary("Mul", network.input, number)}, np.ones((2, 2, 3), np.float32))
        self.assertEqual(result[0, 1, 1].tolist(), [20, 30, 40])
        self.assertEqual(operations(model), {"Mul": 1, "Transpose": 1})

    def test_an_unknown_operation_is_refused_by_name(self):
        nodes = [{"name": "x", "op": "Placeholder"}, {"name": "y", "op": "Cosh", "input": ["x"]}]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "model.json"
            path.write_text(json.dumps({"modelTopology": {"node": nodes}, "weightsManifest": []}))
            network = Network(2, 2)
            with self.assertRaisesRegex(ConversionError, "the operation Cosh of y is unknown; known are Add"):
                GraphModel(path).write(network, {"x": network.input}, ["y"])

    def test_an_operation_that_the_program_does_not_run_is_refused(self):
        network = Network(2, 2)
        with self.assertRaisesRegex(ConversionError, "the ONNX operation Sinh"):
            network.finish({"out": network.unary("Sinh", network.input)}, "")

    def test_weights_in_bytes_are_scaled_and_half_precision_is_exact(self):
        entries = [{"name": "a", "shape": [2], "dtype": "float32", "quantization": {"dtype": "uint8", "scale": 0.5, "min": -1.0}},
                   {"name": "b", "shape": [], "dtype": "float32", "quantization": {"dtype": "float16"}}]
        weights = dict(read_weights(entries, bytes([0, 4]) + np.float16(0.1).tobytes()))
        self.assertEqual(weights["a"].tolist(), [-1, 1])
        self.assertEqual(float(weights["b"]), float(np.float16(0.1)))

    def test_every_description_names_each_class_once(self):
        import tomllib
        for detector in DETECTORS:
            classes = detector.classes or ["a", "b"]
            read = tomllib.loads(description(detector, classes))
            used = [name for name in read["output"]["classes"] if name]
            self.assertEqual(len(used), len(set(used)))
            self.assertEqual(read["source"]["version"], detector.version)

    def test_the_anchors_are_the_anchors_in_the_graph_of_ssd_on_coco(self):
        detector = DETECTORS[0]
        path = DEFAULT_OUT / "packages" / detector.archive.removesuffix(".tgz") / "package" / detector.file
        if not path.exists():
            self.skipTest("the package is not there: run fetch.py")
        corners = GraphModel(path).weights["Postprocessor/ExpandDims"].reshape(-1, 4)
        anchors = ssd_anchors(300)
        ours = np.hstack([anchors[:, :2] - anchors[:, 2:] / 2, anchors[:, :2] + anchors[:, 2:] / 2])
        # The graph has the ratio 1 / 3 where MediaPipe has 0.3333.
        np.testing.assert_allclose(ours, corners, atol=1e-4)


if __name__ == "__main__":
    unittest.main()
