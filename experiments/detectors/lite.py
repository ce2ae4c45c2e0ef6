"""Reads a network from a TensorFlow Lite file (.tflite), a FlatBuffer."""

import numpy as np
import tflite

from network import ConversionError

TYPES = {
    tflite.TensorType.FLOAT32: np.float32,
    tflite.TensorType.FLOAT16: np.float16,
    tflite.TensorType.INT32: np.int32,
    tflite.TensorType.INT64: np.int64,
}
OPERATIONS = {number: name for name, number in vars(tflite.BuiltinOperator).items() if isinstance(number, int)}
PADDINGS = {tflite.Padding.SAME: "SAME", tflite.Padding.VALID: "VALID"}


class LiteModel:
    """The operations and weights of the first graph of a file."""

    def __init__(self, contents):
        self.model = tflite.Model.GetRootAs(contents, 0)
        self.graph = self.model.Subgraphs(0)

    def write(self, network, image):
        """Writes all operations, and returns the outputs by name."""
        done = {self.graph.Inputs(0): image}
        for index in range(self.graph.OperatorsLength()):
            operator = self.graph.Operators(index)
            inputs = [self._tensor(network, done, number) for number in operator.InputsAsNumpy() if number >= 0]
            done[operator.Outputs(0)] = self._write(network, operator, inputs)
        outputs = self.graph.OutputsAsNumpy().tolist()
        return {self.graph.Tensors(number).Name().decode(): done[number] for number in outputs}

    def _write(self, network, operator, inputs):
        code = self.model.OperatorCodes(operator.OpcodeIndex())
        # Old files have the number of the operation in a field of one byte.
        name = OPERATIONS[max(code.BuiltinCode(), code.DeprecatedBuiltinCode())]
        if name not in WRITERS:
            raise ConversionError(f"the operation {name} is unknown; known are {', '.join(sorted(WRITERS))}")
        options, write = WRITERS[name]
        settings = None
        if options:
            if operator.BuiltinOptions() is None:
                raise ConversionError(f"the operation {name} has no options")
            settings = options()
            settings.Init(operator.BuiltinOptions().Bytes, operator.BuiltinOptions().Pos)
        return write(network, inputs, settings)

    def _tensor(self, network, done, number):
        if number not in done:
            tensor = self.graph.Tensors(number)
            contents = self.model.Buffers(tensor.Buffer()).DataAsNumpy()
            if tensor.Type() not in TYPES or isinstance(contents, int):
                raise ConversionError(f"the tensor {tensor.Name().decode()} has no value, or a type that is not supported")
            shape = tensor.ShapeAsNumpy() if tensor.ShapeLength() else ()
            # `constant` makes float32 of half precision. Every number of half precision is a number of float32.
            done[number] = network.constant(contents.view(TYPES[tensor.Type()]).reshape(shape))
        return done[number]


def activate(network, x, settings):
    kind = settings.FusedActivationFunction()
    if kind == tflite.ActivationFunctionType.NONE:
        return x
    if kind == tflite.ActivationFunctionType.RELU:
        return network.unary("Relu", x)
    if kind == tflite.ActivationFunctionType.RELU6:
        return network.clip(x, 0, 6)
    raise ConversionError(f"the activation function {kind} is unknown, expected none, RELU or RELU6")


def conv(method, axes):
    """A convolution. `axes` makes height x width x inputs x outputs of the stored weights."""
    def write(network, inputs, settings):
        weights = inputs[1].value.transpose(axes)
        bias = inputs[2].value if len(inputs) > 2 else None
        x = getattr(network, method)(inputs[0], weights, (settings.StrideH(), settings.StrideW()),
                                     PADDINGS[settings.Padding()],
                                     (settings.DilationHFactor(), settings.DilationWFactor()), bias)
        return activate(network, x, settings)
    return write


WRITERS = {
    "ADD": (tflite.AddOptions, lambda network, inputs, settings:
            activate(network, network.binary("Add", *inputs), settings)),
    "CONCATENATION": (tflite.ConcatenationOptions, lambda network, inputs, settings:
                      activate(network, network.concat(inputs, settings.Axis()), settings)),
    "CONV_2D": (tflite.Conv2DOptions, conv("conv", (1, 2, 3, 0))),
    # The weights are 1 x height x width x (channels * outputs of a channel); only one output of a channel is supported.
    "DEPTHWISE_CONV_2D": (tflite.DepthwiseConv2DOptions, conv("depthwise", (1, 2, 3, 0))),
    "DEQUANTIZE": (None, lambda network, inputs, settings: inputs[0]),
    "RESHAPE": (None, lambda network, inputs, settings: network.reshape(inputs[0], inputs[1].value)),
}
