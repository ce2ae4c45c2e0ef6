"""Holds the converted detectors against their original runtimes, on images that were recorded with cameras.

Prints how much boxes and scores differ, on how many images a detector finds a car, how long an image takes, and how many
multiplications a network has.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
from onnx import numpy_helper, shape_inference
from PIL import Image

from detectors import DETECTORS
from fetch import DEFAULT_OUT, unpacked
from originals import AbsentError, original

LEAST_SCORE = 0.1  # candidates below it are not compared
LEAST_HEIGHT = 30  # pixels of a car in an image that is worth a look
SURE = 0.5  # the score of a car that is found, and the least overlap with the true car


def recorded_images(recordings, count):
    """Images with cars from recordings, evenly spaced: pixels and true boxes, as corners."""
    found = []
    for folder in recordings:
        truth = json.loads((folder / "annotations.json").read_text())
        cars = {category["id"] for category in truth["categories"] if category["name"] == "car"}
        boxes = {}
        for mark in truth["annotations"]:
            x, y, width, height = mark["bbox"]
            if mark["category_id"] in cars:
                boxes.setdefault(mark["image_id"], []).append((x, y, x + width, y + height))
        for image in truth["images"]:
            high = [box for box in boxes.get(image["id"], []) if box[3] - box[1] >= LEAST_HEIGHT]
            if high:
                found.append((folder / image["file_name"], high))
    if len(found) < count:
        sys.exit(f"error: the recordings have {len(found)} images with a car of {LEAST_HEIGHT} pixels, expected {count}")
    return [found[index * len(found) // count] for index in range(count)]


def resized(images, size):
    pictures = [Image.open(path).convert("RGB").resize(size, Image.Resampling.BILINEAR) for path, _ in images]
    return np.stack([np.asarray(picture) for picture in pictures])


def run_onnx(path, detector, images):
    """Boxes and scores of all images, and the median time of an image in milliseconds on one core."""
    settings = onnxruntime.SessionOptions()
    settings.intra_op_num_threads = settings.inter_op_num_threads = 1
    session = onnxruntime.InferenceSession(path, settings, providers=["CPUExecutionProvider"])
    answers, times = [], []
    for image in images:
        pixels = (image.astype(np.float32) - np.float32(detector.mean)) * np.float32(round(detector.scale, 10))
        pixels = np.ascontiguousarray(pixels.transpose(2, 0, 1)[None])
        start = time.perf_counter()
        answers.append(session.run(["boxes", "scores"], {"image": pixels}))
        times.append(time.perf_counter() - start)
    boxes, scores = (np.concatenate(part) for part in zip(*answers))
    return boxes, scores, 1000 * float(np.median(times))


def multiplications(path):
    """The number of multiply-adds of all convolutions and products of matrices, from their shapes."""
    graph = shape_inference.infer_shapes(onnx.load(path)).graph
    shapes = {value.name: [dim.dim_value for dim in value.type.tensor_type.shape.dim]
              for value in [*graph.value_info, *graph.input, *graph.output]}
    shapes.update({value.name: list(numpy_helper.to_array(value).shape) for value in graph.initializer})
    total = 0
    for node in graph.node:
        if node.op_type == "Conv":
            total += int(np.prod(shapes[node.output[0]]) * np.prod(shapes[node.input[1]][1:]))
        elif node.op_type in ("Gemm", "MatMul"):
            total += int(np.prod(shapes[node.output[0]]) * shapes[node.input[0]][-1])
    return total


def as_shares(boxes, detector):
    """Boxes as left, top, right and bottom in shares of the image."""
    if detector.form == "yxyx":
        boxes = boxes[..., [1, 0, 3, 2]]
    return boxes / np.array(detector.size * 2) if detector.unit == "pixels" else boxes


def overlap(boxes, box):
    """Intersection over union of many boxes with one box."""
    sides = np.minimum(boxes[:, 2:], box[2:]) - np.maximum(boxes[:, :2], box[:2])
    common = np.prod(np.clip(sides, 0, None), axis=1)
    areas = np.prod(boxes[:, 2:] - boxes[:, :2], axis=1)
    return common / (areas + (box[2] - box[0]) * (box[3] - box[1]) - common)


def compare(detector, folder, path, images, runtimes):
    pixels = resized(images, detector.size)
    boxes, scores, milliseconds = run_onnx(path, detector, pixels)
    boxes = as_shares(boxes, detector)
    classes = detector.convert(folder)[1] if detector.classes is None else detector.classes
    car = classes.index("car")
    claimed = located = 0
    for (image, truth), found, score in zip(images, boxes, scores[..., car]):
        sure = found[score >= SURE]
        scaled = np.array(truth) / np.array(Image.open(image).size * 2)
        claimed += len(sure) > 0
        located += any((overlap(sure, box) >= SURE).any() for box in scaled)
    print(f"{detector.name}")
    print(f"  a car with a score of {SURE} on {claimed} of {len(images)} images, on a true car on {located}")
    print(f"  {milliseconds:.0f} ms an image on one core, {multiplications(path) / 1e6:.0f} million multiply-adds")
    try:
        true_boxes, true_scores = original(detector, folder, pixels, runtimes)
    except AbsentError as error:
        print(f"  NOT COMPARED, the original runtime is absent: {error}")
        return
    true_boxes = as_shares(true_boxes, detector)
    likely = np.maximum(scores, true_scores) >= LEAST_SCORE
    far = np.abs(boxes - true_boxes)[likely.any(axis=2)] * np.array(detector.size * 2)
    apart = np.abs(scores - true_scores)
    print(f"  {likely.sum()} candidates with a score of {LEAST_SCORE}: boxes differ by at most {far.max():.2g} pixels of "
          f"{detector.size[0]}, scores by {apart[likely].max():.2g}; scores of all candidates by {apart.max():.2g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recordings", nargs="+", type=Path, metavar="FOLDER", help="a folder of `paracosm-fuzz record`")
    parser.add_argument("--out", type=Path, default=DEFAULT_OUT, help="the folder of fetch.py [default: target/detectors]")
    parser.add_argument("--packages", type=Path, default=DEFAULT_OUT / "packages",
                        help="the folder for the packages [default: target/detectors/packages]")
    parser.add_argument("--count", type=int, default=20, help="the number of images [default: 20]")
    options = parser.parse_args()
    images = recorded_images(options.recordings, options.count)
    for detector in DETECTORS:
        path = options.out / f"{detector.name}.onnx"
        if not path.exists():
            print(f"{detector.name}\n  NOT COMPARED: {path} is missing, run fetch.py first")
            continue
        compare(detector, unpacked(detector, options.packages), path, images, options.packages.parent)


if __name__ == "__main__":
    main()
