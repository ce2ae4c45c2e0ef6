"""The anchors of SSD-MobileNet: the boxes that the network's answers are relative to."""

import math

import numpy as np

# The settings of `SsdAnchorsCalculator` in the graph ObjectDetectionOidV4Subgraph, which lies in the package's
# objectron_solution_wasm_bin.wasm. They are the settings of SSD in the TensorFlow Object Detection API, too.
STRIDES = (16, 32, 64, 128, 256, 512)
SCALES = (0.2, 0.95)
RATIOS = (1.0, 2.0, 0.5, 3.0, 0.3333)
LOWEST = ((0.1, 1.0), (SCALES[0], 2.0), (SCALES[0], 0.5))  # reduce_boxes_in_lowest_layer
OFFSET = 0.5


def ssd_anchors(size):
    """The anchors for an image of `size` x `size` pixels, as y, x, height and width in shares of the image.

    W. Liu et al., "SSD: Single Shot MultiBox Detector" (2016), section 2.2, in the order of MediaPipe's calculator.
    """
    least, greatest = SCALES
    scales = [least + (greatest - least) * layer / (len(STRIDES) - 1) for layer in range(len(STRIDES))] + [1.0]
    anchors = []
    for layer, stride in enumerate(STRIDES):
        between = math.sqrt(scales[layer] * scales[layer + 1])
        boxes = LOWEST if layer == 0 else [(scales[layer], ratio) for ratio in RATIOS] + [(between, 1.0)]
        cells = math.ceil(size / stride)
        for y in range(cells):
            for x in range(cells):
                for scale, ratio in boxes:
                    root = math.sqrt(ratio)
                    anchors.append(((y + OFFSET) / cells, (x + OFFSET) / cells, scale / root, scale * root))
    return np.array(anchors)
