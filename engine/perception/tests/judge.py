"""Evaluates detections with pycocotools, and prints the results as JSON.

The standard input has the images, the objects and the detections of one class, and the ranges of areas.
"""

import contextlib
import io
import json
import sys

from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval


def main():
    data = json.load(sys.stdin)
    truth = COCO()
    truth.dataset = {
        "info": {},
        "images": [{"id": image} for image in range(1, data["images"] + 1)],
        "categories": [{"id": 1, "name": "vehicle"}],
        "annotations": [
            {"id": number, "category_id": 1, **annotation} for number, annotation in enumerate(data["objects"], 1)
        ],
    }
    results = []
    with contextlib.redirect_stdout(io.StringIO()):
        truth.createIndex()
        found = truth.loadRes([{"category_id": 1, **detection} for detection in data["detections"]])
        for overlap, areas in data["cases"]:
            evaluation = COCOeval(truth, found, "bbox")
            evaluation.params.iouThrs = [overlap]
            evaluation.params.areaRng = [areas]
            evaluation.params.areaRngLbl = ["range"]
            evaluation.params.maxDets = [100]
            evaluation.evaluate()
            evaluation.accumulate()
            precision = evaluation.eval["precision"]
            counted = precision[precision > -1]
            recall = float(evaluation.eval["recall"].ravel()[0])
            results.append([float(counted.mean()) if counted.size else -1.0, recall])
    json.dump(results, sys.stdout)


main()
