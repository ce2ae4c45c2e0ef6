"""Runs the detectors in their original runtimes, with nothing of the converter."""

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from anchors import ssd_anchors
from detectors import objectron_parts

TFJS = ("@tensorflow/tfjs@4.22.0", "@tensorflow/tfjs-backend-wasm@4.22.0")


class AbsentError(Exception):
    """The original runtime is not there."""


def original(detector, folder, images, runtimes):
    """The boxes and scores of the original file for images of the detector's size, in the terms of the description."""
    return ORIGINALS[detector.name](detector, folder, images, runtimes)


def run_tfjs(detector, folder, images, runtimes, tensors):
    """The tensors of a TensorFlow.js graph for each image. `tensors` has their names and shapes."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        raise AbsentError("TensorFlow.js needs `node` and `npm`: install Node.js")
    place = runtimes / "tfjs"
    place.mkdir(parents=True, exist_ok=True)
    install = ["npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", str(place), *TFJS]
    if subprocess.run(install, stdout=subprocess.DEVNULL).returncode:
        raise AbsentError(f"npm cannot install {' and '.join(TFJS)}")
    with tempfile.TemporaryDirectory() as name:
        pixels, out = Path(name) / "pixels", Path(name) / "out"
        pixels.write_bytes(images.tobytes())
        program = Path(__file__).with_name("tfjs_run.mjs")
        command = ["node", program, (folder / detector.file).resolve(), detector.size[0], len(images), pixels, out, *tensors]
        subprocess.run([str(part) for part in command], cwd=place, check=True, stdout=subprocess.DEVNULL)
        numbers = np.fromfile(out, np.float32).reshape(len(images), -1)
    sizes = [int(np.prod(shape)) for shape in tensors.values()]
    parts = np.split(numbers, np.cumsum(sizes)[:-1], axis=1)
    return [part.reshape(len(images), *shape) for part, shape in zip(parts, tensors.values())]


def ssd_coco(detector, folder, images, runtimes):
    tensors = {"Postprocessor/ExpandDims_1": (1917, 4), "Postprocessor/Slice": (1917, 90)}
    return run_tfjs(detector, folder, images, runtimes, tensors)


def centernet_coco(detector, folder, images, runtimes):
    """Boxes and scores of all cells, from tensors shortly before the end. The graph's own end has the best 100 of them."""
    tensors = {"tower_0/wh": (128, 128, 4), "tower_0/mul_1": (128 * 128, 80), "tower_0/detections": (100, 6)}
    reach, scores, best = run_tfjs(detector, folder, images, runtimes, tensors)
    y, x = np.mgrid[:128, :128] * np.float32(4)
    sides = [x - reach[..., 0], y - reach[..., 1], x + reach[..., 2], y + reach[..., 3]]
    boxes = np.stack(sides, axis=-1).reshape(len(images), -1, 4)
    for index, found in enumerate(best):
        places = np.argsort(-scores[index].reshape(-1), kind="stable")[:100]
        cells, classes = np.divmod(places, 80)
        again = np.column_stack([boxes[index][cells], scores[index][cells, classes], classes])
        # Equal scores may stand in any order, so each of the graph's detections is compared with the most similar one here.
        far = np.abs(found[:, None] - again[None]).max(axis=2).min(axis=1)
        sure = found[:, 4] > scores[index][cells[-1], classes[-1]]
        if np.any(far[sure] > 1e-4):
            raise AssertionError(f"image {index}: the end of the original graph differs from its tensors by {far[sure].max()}")
    return boxes, scores


def ssd_open_images(detector, folder, images, runtimes):
    """The raw answers of LiteRT, decoded box by box as MediaPipe's TensorsToDetectionsCalculator does."""
    try:
        from ai_edge_litert.interpreter import Interpreter
    except ImportError as error:
        raise AbsentError(f"LiteRT is missing: pip install ai-edge-litert ({error})") from None
    interpreter = Interpreter(model_content=objectron_parts(folder, detector)[1], num_threads=1)
    interpreter.allocate_tensors()
    outputs = {output["name"]: output["index"] for output in interpreter.get_output_details()}
    anchors = ssd_anchors(detector.size[0])
    all_boxes, all_scores = [], []
    for image in images:
        pixels = (image[None].astype(np.float32) - np.float32(127.5)) * np.float32(1 / 127.5)
        interpreter.set_tensor(interpreter.get_input_details()[0]["index"], pixels)
        interpreter.invoke()
        codes = interpreter.get_tensor(outputs["raw_outputs/box_encodings"])[0].astype(np.float64)
        logits = interpreter.get_tensor(outputs["raw_outputs/class_predictions"])[0].astype(np.float64)
        boxes = []
        for (dy, dx, dh, dw), (y, x, height, width) in zip(codes, anchors):
            y, x = dy / 10 * height + y, dx / 10 * width + x
            height, width = np.exp(dh / 5) * height, np.exp(dw / 5) * width
            boxes.append((y - height / 2, x - width / 2, y + height / 2, x + width / 2))
        all_boxes.append(boxes)
        all_scores.append(1 / (1 + np.exp(-logits[:, 1:])))
    return np.array(all_boxes), np.array(all_scores)


ORIGINALS = {"ssd-coco": ssd_coco, "centernet-coco": centernet_coco, "ssd-open-images": ssd_open_images}
