"""Reads a network from a TensorFlow.js graph model: `model.json` and the files with the weights beside it."""

import base64
import json
from pathlib import Path

import numpy as np

from network import ConversionError


class GraphModel:
    """The operations and weights of a graph model."""

    def __init__(self, path):
        path = Path(path)
        model = json.loads(path.read_text())
        self.nodes = {node["name"]: node for node in model["modelTopology"]["node"]}
        self.weights = {}
        for group in model["weightsManifest"]:
            contents = b"".join((path.parent / name).read_bytes() for name in group["paths"])
            self.weights.update(read_weights(group["weights"], contents))

    def write(self, network, given, wanted):
        """Writes all operations between the tensors `given` and the tensors `wanted`, and returns the wanted ones."""
        done, waiting = dict(given), list(wanted)
        while waiting:
            name = full_name(waiting[-1])
            if name in done:
                waiting.pop()
                continue
            node = self._node(name)
            inputs = [full_name(source) for source in node.get("input") or [] if not source.startswith("^")]
            missing = [source for source in inputs if source not in done]
            waiting.extend(missing)
            if not missing:
                results = self._write_node(network, node, [done[source] for source in inputs])
                for index, result in enumerate(results):
                    done[f"{node['name']}:{index}" if index else node["name"]] = result
        return [done[full_name(name)] for name in wanted]

    def _node(self, name):
        node = self.nodes.get(name.split(":")[0])
        if node is None:
            raise ConversionError(f"the network has no operation {name}")
        return node

    def _write_node(self, network, node, inputs):
        if node["op"] == "Const":
            return [network.constant(self.weights[node["name"]])]
        writer = WRITERS.get(node["op"])
        if writer is None:
            known = ", ".join(sorted(WRITERS))
            raise ConversionError(f"the operation {node['op']} of {node['name']} is unknown; known are {known}")
        try:
            results = writer(network, inputs, Settings(node.get("attr", {})))
        except ConversionError as error:
            raise ConversionError(f"{node['name']} has {error}") from None
        return results if isinstance(results, list) else [results]


class Settings:
    """The attributes of an operation. Strings are lists of bytes in older files and base64 in newer ones."""

    def __init__(self, attributes):
        self.attributes = attributes

    def integers(self, name):
        return [int(value) for value in self.attributes.get(name, {}).get("list", {}).get("i") or []]

    def integer(self, name, default=0):
        return int(self.attributes.get(name, {}).get("i", default))

    def number(self, name):
        return float(self.attributes[name]["f"])

    def flag(self, name):
        return bool(self.attributes.get(name, {}).get("b", False))

    def text(self, name):
        return as_text(self.attributes[name]["s"])

    def texts(self, name):
        return [as_text(value) for value in self.attributes.get(name, {}).get("list", {}).get("s") or []]

    def pixels(self, name):
        """The middle two of four numbers: how many pixels down and across."""
        if self.text("data_format") != "NHWC":
            raise ConversionError(f"the layout {self.text('data_format')}, expected NHWC")
        return self.integers(name)[1:3]


def as_text(value):
    return bytes(value).decode() if isinstance(value, list) else base64.b64decode(value).decode()


def full_name(name):
    return name.removesuffix(":0")


def read_weights(entries, contents):
    """The weights as float32 and int64. Half precision becomes float32 exactly; bytes are scaled as the file says."""
    start = 0
    for entry in entries:
        packed = entry.get("quantization", {})
        kind = np.dtype(packed.get("dtype", entry["dtype"]))
        count = int(np.prod(entry["shape"], dtype=np.int64))
        value = np.frombuffer(contents, kind, count, start).reshape(entry["shape"])
        start += count * kind.itemsize
        if "scale" in packed:
            value = value.astype(np.float32) * np.float32(packed["scale"]) + np.float32(packed["min"])
        yield entry["name"], value


def constant(tensor, what):
    if tensor.value is None:
        raise ConversionError(f"{what} that depends on the image, expected a constant")
    return tensor.value


def conv(method):
    def write(network, inputs, settings):
        fused = settings.texts("fused_ops")
        bias = constant(inputs[2], "a bias") if fused[:1] == ["BiasAdd"] else None
        x = getattr(network, method)(inputs[0], constant(inputs[1], "weights"), settings.pixels("strides"),
                                     settings.text("padding"), settings.pixels("dilations"), bias)
        for name in fused[0 if bias is None else 1:]:
            if name not in ("Relu", "Relu6"):
                raise ConversionError(f"the fused operation {name}, expected BiasAdd, Relu or Relu6")
            x = WRITERS[name](network, [x], settings)
        return x
    return write


def binary(kind):
    return lambda network, inputs, settings: network.binary(kind, *inputs)


def unary(kind):
    return lambda network, inputs, settings: network.unary(kind, inputs[0])


def add_all(network, inputs, settings):
    total = inputs[0]
    for tensor in inputs[1:]:
        total = network.binary("Add", total, tensor)
    return total


def batch_norm(network, inputs, settings):
    return network.batch_norm(*inputs, settings.number("epsilon"))


def mean(network, inputs, settings):
    if not settings.flag("keep_dims"):
        raise ConversionError("a mean that drops dimensions, expected keep_dims")
    return network.mean(inputs[0], constant(inputs[1], "axes").reshape(-1).tolist())


def resize(network, inputs, settings):
    if settings.flag("align_corners") or settings.flag("half_pixel_centers"):
        raise ConversionError("pixels that are aligned at corners or centres, expected neither")
    return network.resize_bilinear(inputs[0], *constant(inputs[1], "a size").tolist())


def strided_slice(network, inputs, settings):
    """Only of constants: the graphs slice nothing but shapes."""
    value, begin, end, step = (constant(tensor, "a slice") for tensor in inputs)
    bits = {name: settings.integer(f"{name}_mask") for name in ("begin", "end", "shrink_axis", "ellipsis", "new_axis")}
    if bits["ellipsis"] or bits["new_axis"]:
        raise ConversionError("a slice with an ellipsis or a new axis")
    index = []
    for axis, (first, last, by) in enumerate(zip(begin.tolist(), end.tolist(), step.tolist())):
        has = lambda name: bits[name] >> axis & 1
        index.append(first if has("shrink_axis") else slice(None if has("begin") else first, None if has("end") else last, by))
    return network.constant(value[tuple(index)])


def cut(network, inputs, settings):
    x, begin, size = inputs[0], *(constant(tensor, "a slice").tolist() for tensor in inputs[1:])
    for axis, (start, length) in enumerate(zip(begin, size)):
        stop = x.shape[axis] if length == -1 else start + length
        if (start, stop) != (0, x.shape[axis]):
            x = network.slice(x, axis, start, stop)
    return x


def pack(network, inputs, settings):
    axis = settings.integer("axis")
    return network.concat([network.expand(tensor, axis) for tensor in inputs], axis)


WRITERS = {
    "Add": binary("Add"),
    "AddN": add_all,
    "AddV2": binary("Add"),
    "BiasAdd": binary("Add"),
    "ConcatV2": lambda network, inputs, settings: network.concat(inputs[:-1], int(constant(inputs[-1], "an axis"))),
    "Conv2D": conv("conv"),
    "DepthwiseConv2dNative": conv("depthwise"),
    "Exp": unary("Exp"),
    "ExpandDims": lambda network, inputs, settings: network.expand(inputs[0], int(constant(inputs[1], "an axis"))),
    "FusedBatchNorm": batch_norm,
    "FusedBatchNormV3": batch_norm,
    "FusedDepthwiseConv2dNative": conv("depthwise"),
    "Identity": lambda network, inputs, settings: inputs[0],
    "Mean": mean,
    "Mul": binary("Mul"),
    "Pack": pack,
    "Relu": unary("Relu"),
    "Relu6": lambda network, inputs, settings: network.clip(inputs[0], 0, 6),
    "Reshape": lambda network, inputs, settings: network.reshape(inputs[0], constant(inputs[1], "a shape")),
    "ResizeBilinear": resize,
    "Shape": lambda network, inputs, settings: network.constant(np.array(inputs[0].shape, np.int64)),
    "Sigmoid": unary("Sigmoid"),
    "Slice": cut,
    "Squeeze": lambda network, inputs, settings: network.squeeze(inputs[0], settings.integers("squeeze_dims")),
    "StridedSlice": strided_slice,
    "Sub": binary("Sub"),
    "Tile": lambda network, inputs, settings: network.constant(
        np.tile(constant(inputs[0], "a tile"), constant(inputs[1], "a count"))),
    "Transpose": lambda network, inputs, settings: network.transpose(inputs[0], constant(inputs[1], "axes").tolist()),
    "Unpack": lambda network, inputs, settings: network.unstack(inputs[0], settings.integer("axis")),
    "_FusedConv2D": conv("conv"),
}
