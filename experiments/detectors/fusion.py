"""Puts factors, offsets and batch normalisations that follow a convolution into the convolution's weights.

A trained network often has them as operations of their own. Not every program that runs ONNX files puts them together, and
each would cost a pass over the image.
"""

from collections import Counter

import numpy as np


def fuse(nodes, constants, outputs):
    """Returns the operations and the constants of an equal network with fewer operations."""
    constants = dict(constants)
    uses = Counter(name for node in nodes for name in node.input) + Counter(list(outputs))
    makers, kept = {}, []
    for node in nodes:
        conv = makers.get(next((name for name in node.input if name not in constants), None))
        change = conv and uses[conv.output[0]] == 1 and as_scale_and_offset(node, constants)
        if change:
            rescale(conv, constants, *change)
            conv.output[0] = node.output[0]
        else:
            kept.append(node)
            conv = node if node.op_type == "Conv" else None
        if conv:
            makers[conv.output[0]] = conv
    return kept, constants


def as_scale_and_offset(node, constants):
    """The operation as a factor and an offset of each channel, or None if it is another operation."""
    values = [constants[name].astype(np.float64) for name in node.input if name in constants]
    if node.op_type == "BatchNormalization" and len(values) == 4:
        scale, offset, mean, variance = values
        epsilon = next(setting.f for setting in node.attribute if setting.name == "epsilon")
        scale = scale / np.sqrt(variance + epsilon)
        return scale, offset - mean * scale
    if node.op_type not in ("Add", "Mul") or len(values) != 1:
        return None
    value = values[0]
    if value.size > 1 and (value.ndim != 3 or value.shape[1:] != (1, 1)):
        return None
    value = value.reshape(-1)
    return (value, 0.0) if node.op_type == "Mul" else (1.0, value)


def rescale(conv, constants, scale, offset):
    weights = constants[conv.input[1]].astype(np.float64)
    bias = constants[conv.input[2]].astype(np.float64) if len(conv.input) > 2 else np.zeros(len(weights))
    scale = np.broadcast_to(scale, len(weights))
    names = [f"{conv.name or conv.output[0]}_weights", f"{conv.name or conv.output[0]}_bias"]
    constants[names[0]] = (weights * scale[:, None, None, None]).astype(np.float32)
    constants[names[1]] = (bias * scale + offset).astype(np.float32)
    conv.input[:] = [conv.input[0], *names]
