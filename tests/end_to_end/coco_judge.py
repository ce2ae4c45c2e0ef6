"""Reads the masks of a recording with pycocotools, and prints how many agree with the boxes and the areas beside them."""

import json
import sys

from pycocotools import mask

with open(sys.argv[1]) as file:
    annotations = json.load(file)["annotations"]
for annotation in annotations:
    encoded = annotation["segmentation"]
    assert mask.area(encoded) == annotation["area"], annotation
    assert list(mask.toBbox(encoded)) == annotation["bbox"], annotation
    assert mask.decode(encoded).sum() == annotation["area"], annotation
print(len(annotations))
