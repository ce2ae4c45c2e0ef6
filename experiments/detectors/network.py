"""Writes a network as an ONNX file while a converter reads it from another format.

TensorFlow keeps an image as batch x height x width x channels, ONNX as batch x channels x height x width. The methods of
`Network` take and return tensors as TensorFlow means them, and store images as ONNX wants them. So the file needs a
transposition only where an image becomes a list of numbers.

Operations on constants are computed at once and leave no trace in the file.
"""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import onnx
from onnx import helper, numpy_helper, shape_inference
from onnx.reference import ReferenceEvaluator

from fusion import fuse

OPSET = helper.make_opsetid("", 13)

# The operations that the program runs, as in engine/neural/src/limits.rs.
ALLOWED = set("""
    Abs Add AveragePool BatchNormalization Cast Ceil Clip Concat Constant Conv Div Dropout Elu Erf Exp Flatten Floor Gather
    Gelu Gemm GlobalAveragePool GlobalMaxPool HardSigmoid HardSwish Identity InstanceNormalization LayerNormalization
    LeakyRelu Log LogSoftmax MatMul Max MaxPool Min Mish Mul Neg PRelu Pow Reciprocal ReduceMax ReduceMean ReduceMin
    ReduceSum Relu Reshape Selu Shape Sigmoid Slice Softmax Softplus Split Sqrt Squeeze Sub Sum Tanh Transpose Unsqueeze
""".split())

TO_IMAGE, FROM_IMAGE = (0, 3, 1, 2), (0, 2, 3, 1)


class ConversionError(Exception):
    """The network has something that the converter cannot write."""


@dataclass(frozen=True)
class Tensor:
    """A tensor of the network: its name in the file, its stored dimensions, and its value if it is a constant."""

    name: str
    dims: tuple[int, ...]
    image: bool = False  # stored as batch x channels x height x width
    value: np.ndarray | None = field(default=None, compare=False)

    @property
    def shape(self):
        """The dimensions as TensorFlow means them."""
        return tuple(self.dims[i] for i in FROM_IMAGE) if self.image else self.dims


class Network:
    """A network that is being written. Its input is one image: batch 1, float32."""

    def __init__(self, width, height):
        self.nodes = []
        self.constants = {}
        self.count = 0
        self.transposed = {}
        self.input = Tensor("image", (1, 3, height, width), image=True)

    def constant(self, value):
        value = np.asarray(value)
        value = value.astype(np.int64 if value.dtype.kind in "iu" else np.float32)
        name = self._new("constant")
        self.constants[name] = value
        return Tensor(name, value.shape, value=value)

    def emit(self, kind, inputs, outputs=1, image=False, **attributes):
        """Adds an ONNX operation, and returns its output, or a list if there are several. It works on stored dimensions."""
        names = [self._new(kind) for _ in range(outputs)]
        node = helper.make_node(kind, [tensor.name for tensor in inputs], names, **attributes)
        if all(tensor.value is not None for tensor in inputs):
            results = [self.constant(value) for value in self._compute(node, inputs)]
        else:
            self.nodes.append(node)
            results = [Tensor(name, dims, image) for name, dims in zip(names, self._shapes(node, inputs))]
        return results[0] if outputs == 1 else results

    # Images

    def plain(self, x):
        """Stores a tensor as TensorFlow means it."""
        if not x.image:
            return x
        if x.name not in self.transposed:
            self.transposed[x.name] = self.emit("Transpose", [x], perm=FROM_IMAGE)
        return self.transposed[x.name]

    def as_image(self, x):
        return x if x.image else self.emit("Transpose", [x], image=True, perm=TO_IMAGE)

    def conv(self, x, weights, strides, padding, dilations=(1, 1), bias=None, groups=1):
        """A convolution. The weights are height x width x inputs of a group x outputs; padding is SAME or VALID."""
        x = self.as_image(x)
        kernel = weights.shape[:2]
        if weights.shape[2] * groups != x.dims[1]:
            raise ConversionError(f"weights for {weights.shape[2] * groups} channels, expected {x.dims[1]} channels")
        inputs = [x, self.constant(weights.transpose(3, 2, 0, 1))] + ([] if bias is None else [self.constant(bias)])
        return self.emit("Conv", inputs, image=True, kernel_shape=kernel, strides=strides, dilations=dilations, group=groups,
                         pads=pads(x.dims[2:], kernel, strides, dilations, padding))

    def depthwise(self, x, weights, strides, padding, dilations=(1, 1), bias=None):
        """A convolution of each channel alone. The weights are height x width x channels x outputs of a channel."""
        height, width, channels, multiple = weights.shape
        weights = weights.reshape(height, width, 1, channels * multiple)
        return self.conv(x, weights, strides, padding, dilations, bias, groups=channels)

    def max_pool(self, x, kernel, strides, padding):
        x = self.as_image(x)
        return self.emit("MaxPool", [x], image=True, kernel_shape=kernel, strides=strides,
                         pads=pads(x.dims[2:], kernel, strides, (1, 1), padding))

    def batch_norm(self, x, scale, offset, mean, variance, epsilon):
        return self.emit("BatchNormalization", [self.as_image(x), scale, offset, mean, variance], image=True, epsilon=epsilon)

    def mean(self, x, axes):
        if not x.image or sorted(axis % 4 for axis in axes) != [1, 2]:
            raise ConversionError(f"the mean over the axes {axes}, expected the mean over the pixels of an image")
        return self.emit("GlobalAveragePool", [x], image=True)

    def resize_bilinear(self, x, height, width):
        """Bilinear enlargement by a whole factor, where pixel i of the input lies at pixel i * factor of the output.

        The values between two pixels are weighted sums of the image and of the image moved by a pixel, so the file needs no
        operation Resize.
        """
        x = self.as_image(x)
        for axis, size in ((2, height), (3, width)):
            old = x.dims[axis]
            if size % old:
                raise ConversionError(f"a change of an image's size from {old} to {size}, expected a whole factor")
            factor = size // old
            moved = self.emit("Concat", [self._slice(x, axis, 1, old), self._slice(x, axis, old - 1, old)], axis=axis)
            parts = [x]
            for step in range(1, factor):
                near = self.emit("Mul", [x, self.constant(np.float32(1 - step / factor))])
                far = self.emit("Mul", [moved, self.constant(np.float32(step / factor))])
                parts.append(self.emit("Add", [near, far]))
            behind = self.constant([axis + 1])
            parts = [self.emit("Unsqueeze", [part, behind]) for part in parts]
            dims = x.dims[:axis] + (size,) + x.dims[axis + 1:]
            x = self.emit("Reshape", [self.emit("Concat", parts, axis=axis + 1), self.constant(dims)], image=True)
        return x

    # Numbers

    def binary(self, kind, a, b):
        """An operation on each number of two tensors, which are broadcast."""
        if (a.image or b.image) and all(tensor.image or tensor.value is not None for tensor in (a, b)):
            a, b = (tensor if tensor.image else self.constant(beside_image(tensor.value)) for tensor in (a, b))
            return self.emit(kind, [a, b], image=True)
        return self.emit(kind, [self.plain(a), self.plain(b)])

    def unary(self, kind, x):
        """An operation on each number of a tensor."""
        return self.emit(kind, [x], image=x.image)

    def clip(self, x, low, high):
        return self.emit("Clip", [x, self.constant(np.float32(low)), self.constant(np.float32(high))], image=x.image)

    # Shapes

    def concat(self, tensors, axis):
        rank = len(tensors[0].dims)
        if all(tensor.image for tensor in tensors):
            return self.emit("Concat", tensors, image=True, axis=FROM_IMAGE[axis % rank])
        return self.emit("Concat", [self.plain(tensor) for tensor in tensors], axis=axis % rank)

    def reshape(self, x, shape):
        return self.emit("Reshape", [self.plain(x), self.constant(shape)])

    def expand(self, x, axis):
        return self.emit("Unsqueeze", [self.plain(x), self.constant([axis % (len(x.dims) + 1)])])

    def squeeze(self, x, axes):
        return self.emit("Squeeze", [self.plain(x), self.constant([axis % len(x.dims) for axis in axes])])

    def transpose(self, x, axes):
        return self.emit("Transpose", [self.plain(x)], perm=axes)

    def slice(self, x, axis, start, stop):
        return self._slice(self.plain(x), axis % len(x.dims), start, stop)

    def unstack(self, x, axis):
        """A list of the parts of a tensor along an axis, which is left out."""
        x = self.plain(x)
        parts = self.emit("Split", [x], outputs=x.dims[axis], axis=axis)
        return [self.squeeze(part, [axis]) for part in parts]

    # The file

    def finish(self, outputs, story):
        """Returns the ONNX model with these named outputs."""
        outputs = {name: self.plain(tensor) for name, tensor in outputs.items()}
        names = {tensor.name: name for name, tensor in outputs.items()}
        nodes = needed(self.nodes, names)
        nodes, constants = fuse(nodes, self.constants, names)
        for node in nodes:
            if node.op_type not in ALLOWED:
                raise ConversionError(f"the network needs the ONNX operation {node.op_type}, which the program does not run")
            node.input[:] = [names.get(name, name) for name in node.input]
            node.output[:] = [names.get(name, name) for name in node.output]
        used = {name for node in nodes for name in node.input}
        graph = helper.make_graph(
            nodes, "detector",
            [helper.make_tensor_value_info(self.input.name, onnx.TensorProto.FLOAT, self.input.dims)],
            [helper.make_tensor_value_info(name, onnx.TensorProto.FLOAT, tensor.dims) for name, tensor in outputs.items()],
            [numpy_helper.from_array(value, name) for name, value in constants.items() if name in used],
        )
        model = helper.make_model(graph, opset_imports=[OPSET], ir_version=8, producer_name="paracosm", doc_string=story)
        onnx.checker.check_model(model, full_check=True)
        return model

    def _new(self, kind):
        self.count += 1
        return f"{kind.lower()}_{self.count}"

    def _slice(self, x, axis, start, stop):
        return self.emit("Slice", [x, self.constant([start]), self.constant([stop]), self.constant([axis])])

    def _compute(self, node, inputs):
        unknown = [helper.make_tensor_value_info(name, onnx.TensorProto.UNDEFINED, None) for name in node.output]
        known = [helper.make_tensor_value_info(tensor.name, element(tensor), tensor.dims) for tensor in inputs]
        model = helper.make_model(helper.make_graph([node], "constant", known, unknown), opset_imports=[OPSET])
        return ReferenceEvaluator(model).run(None, {tensor.name: tensor.value for tensor in inputs})

    def _shapes(self, node, inputs):
        types = {tensor.name: helper.make_tensor_type_proto(element(tensor), tensor.dims) for tensor in inputs}
        values = {t.name: numpy_helper.from_array(t.value, t.name) for t in inputs if t.value is not None and t.value.ndim < 2}
        schema = onnx.defs.get_schema(node.op_type, OPSET.version)
        found = shape_inference.infer_node_outputs(schema, node, types, values, opset_imports=[OPSET])
        return [tuple(dim.dim_value for dim in found[name].tensor_type.shape.dim) for name in node.output]


def element(tensor):
    """The type of a tensor's numbers in ONNX. Only constants have other numbers than float32."""
    whole = tensor.value is not None and tensor.value.dtype.kind == "i"
    return onnx.TensorProto.INT64 if whole else onnx.TensorProto.FLOAT


def pads(sizes, kernel, strides, dilations, padding):
    """The padding of TensorFlow in pixels: above, left, below, right. SAME pads more below and on the right."""
    if padding == "VALID":
        return [0, 0, 0, 0]
    if padding != "SAME":
        raise ConversionError(f"the padding {padding}, expected SAME or VALID")
    totals = []
    for size, width, stride, dilation in zip(sizes, kernel, strides, dilations):
        reach = (width - 1) * dilation + 1
        totals.append(max((-(-size // stride) - 1) * stride + reach - size, 0))
    return [total // 2 for total in totals] + [total - total // 2 for total in totals]


def beside_image(value):
    """A constant with the dimensions that it needs to be broadcast with a stored image."""
    if value.size == 1:
        return value.reshape(())
    value = value.reshape((1,) * (4 - value.ndim) + value.shape).transpose(TO_IMAGE)
    return value[0] if value.shape[0] == 1 else value


def needed(nodes, outputs):
    """The operations that the outputs depend on."""
    wanted, kept = set(outputs), []
    for node in reversed(nodes):
        if wanted.intersection(node.output):
            wanted.update(node.input)
            kept.append(node)
    return kept[::-1]


def operations(model):
    """How often each operation stands in a model."""
    return Counter(node.op_type for node in model.graph.node)
