#!/usr/bin/env python3
"""Measures how many images a core-second `paracosm-fuzz perceive` draws, shows to a detector, and judges.

    benches/perceive.py PROGRAM [--rounds N]

PROGRAM is a `paracosm-fuzz` that was built with the feature `neural`. The detector is an ONNX network of 20 MFLOP with
random weights for images of 200 x 66 pixels; its answers do not matter. A campaign runs on one thread, but the software
renderer uses more, so the figure is images for each second of CPU time of the whole command. Needs onnx and numpy.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
import onnx
from onnx import TensorProto, helper

WIDTH, HEIGHT = 200, 66
# Channels, kernel and stride of each convolution; the last one gives a score and four numbers of a box for each cell.
LAYERS = [(16, 3, 2), (24, 3, 2), (32, 3, 2), (32, 3, 1), (32, 3, 1), (5, 1, 1)]
DESCRIPTION = """task = "detection"

[input]
size = [200, 66]
mean = [127.5, 127.5, 127.5]
scale = [0.00784314, 0.00784314, 0.00784314]
colours = "rgb"
resize = "stretch"

[output]
boxes = "boxes"
scores = "scores"
form = "xyxy"
unit = "share"
classes = ["car"]
threshold = 0.9
overlap = 0.5
"""
CAMERAS = """seed = 0
look = "textured"

[camera.front]
resolution = [200, 66]
focal_mm = 24.0
sensor_mm = 36.0
position = [0.3, 0.0, 1.35]
yaw_pitch_roll = [0.0, 2.0, 0.0]
rate = 10.0
"""


def network():
    """Makes the network. Returns the model and its multiplications and additions for an image."""
    chance = numpy.random.default_rng(0)
    nodes, constants, operations = [], [], 0
    seen, channels, width, height = "image", 3, WIDTH, HEIGHT

    def constant(name, values):
        constants.append(onnx.numpy_helper.from_array(values, name))
        return name

    for number, (out, kernel, stride) in enumerate(LAYERS, 1):
        width, height = -(-width // stride), -(-height // stride)
        operations += 2 * channels * kernel * kernel * out * width * height
        size = (2 / (channels * kernel * kernel)) ** 0.5
        weights = (size * chance.standard_normal((out, channels, kernel, kernel))).astype(numpy.float32)
        inputs = [seen, constant(f"w{number}", weights), constant(f"b{number}", numpy.zeros(out, numpy.float32))]
        pads = [kernel // 2] * 4
        nodes.append(
            helper.make_node("Conv", inputs, [f"c{number}"], kernel_shape=[kernel] * 2, strides=[stride] * 2, pads=pads)
        )
        seen, channels = f"c{number}", out
        if number < len(LAYERS):
            nodes.append(helper.make_node("Relu", [seen], [f"r{number}"]))
            seen = f"r{number}"
    cells = width * height
    nodes += [
        helper.make_node("Reshape", [seen, constant("flat", numpy.array([1, 5, cells], numpy.int64))], ["columns"]),
        helper.make_node("Transpose", ["columns"], ["cells"], perm=[0, 2, 1]),
        helper.make_node("Sigmoid", ["cells"], ["shares"]),
    ]
    for name, first, last in [("boxes", 0, 4), ("scores", 4, 5)]:
        bounds = [constant(f"{name} {part}", numpy.array([n], numpy.int64)) for part, n in
                  [("from", first), ("to", last), ("axis", 2)]]
        nodes.append(helper.make_node("Slice", ["shares", *bounds], [name]))
    outputs = [
        helper.make_tensor_value_info("boxes", TensorProto.FLOAT, [1, cells, 4]),
        helper.make_tensor_value_info("scores", TensorProto.FLOAT, [1, cells, 1]),
    ]
    image = helper.make_tensor_value_info("image", TensorProto.FLOAT, [1, 3, HEIGHT, WIDTH])
    graph = helper.make_graph(nodes, "detector", [image], outputs, constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], ir_version=8)
    onnx.checker.check_model(model)
    return model, operations


def measure(program, folder, scenario, tests, out):
    """Runs a campaign. Returns the number of images and the CPU seconds of the command."""
    command = [program, "perceive", scenario, "--perceiver", folder / "detector.onnx", "--cameras",
               folder / "cameras.toml", "--strategy", "halton", "--budget", str(tests), "--jobs", "1", "--out", out, "-q"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    # 1 says that tests failed.
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        sys.exit(errors)
    return json.loads((out / "perception.json").read_text())["images"], usage.ru_utime + usage.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    model, operations = network()
    print(f"a network of {operations / 1e6:.1f} MFLOP")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        onnx.save(model, folder / "detector.onnx")
        (folder / "detector.toml").write_text(DESCRIPTION)
        (folder / "cameras.toml").write_text(CAMERAS)
        for scenario, tests in [("pedestrian-crossing", 16), ("highway-traffic", 4)]:
            rates = []
            for number in range(arguments.rounds):
                images, seconds = measure(arguments.program, folder, scenario, tests, folder / f"{scenario}-{number}")
                rates.append(images / seconds)
            print(f"{scenario}: {images} images, {statistics.median(rates):.0f} images a core-second "
                  f"[{min(rates):.0f}, {max(rates):.0f}]")


if __name__ == "__main__":
    main()
