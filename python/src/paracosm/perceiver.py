"""A perception network on trial: it sees the images of a simulated drive, and says where road users or the road are."""

import json
import os
import sys
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

PROTOCOL = 1


@dataclass(frozen=True)
class Detection:
    """A road user that a detector found.

    - name: the class, one of the `classes` of the perceiver
    - score: the confidence of the detector, from 0 to 1
    - left, top, width, height: the box, in pixels from the left upper corner of the image
    """

    name: str
    score: float
    left: float
    top: float
    width: float
    height: float


class Perceiver:
    """A perceiver under test: subclass it, and implement `detect` or `segment`.

    An answer must depend on its image alone. Then a test has the same result in every run. Text that the perceiver prints
    goes to the standard error.
    """

    classes: tuple[str, ...] = ()
    """The classes of a detector. Usual names, such as car, truck and person, need no `groups`."""
    threshold: float = 0.5
    """The score from which on a detection counts."""
    overlap: float = 0.5
    """A detection with a larger overlap (IoU) with a better one of its class is dropped; 1 drops none."""
    extent: str = "visible"
    """The part of an object that a box encloses: "visible", as in COCO, or "whole"."""
    groups: list[dict[str, Any]] | None = None
    """Which classes mean which road users, as `[[group]]` in the description of a network: name, detects, is, may_be."""
    segments: tuple[str, ...] = ("road", "road_line")
    """The semantic classes of the true mask of a segmentation network."""

    def detect(self, image: NDArray[np.uint8]) -> Sequence[Detection]:
        """Returns the `Detection`s in an image, an array (height, width, 3) of red, green and blue from 0 to 255.

        It returns all boxes that the detector considers: PARACOSM applies the threshold and drops boxes that overlap.
        """
        raise NotImplementedError(f"{type(self).__name__}.detect")

    def segment(self, image: NDArray[np.uint8]) -> NDArray[Any]:
        """Returns the mask of an image, an array (height, width) that is true where the image shows the road."""
        raise NotImplementedError(f"{type(self).__name__}.segment")

    def serve(self) -> None:
        """Answers the images that PARACOSM sends on the standard input, until the input ends.

        $ paracosm-fuzz perceive highway-traffic --perceiver-command "python my_detector.py"
        """
        questions = sys.stdin.buffer
        # A print in `detect` must not look like an answer.
        answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
        os.dup2(2, 1)
        sys.stdout = sys.stderr
        for line in questions:
            answer = self._answer(json.loads(line), questions)
            answers.write(json.dumps(answer, separators=(",", ":")) + "\n")
            answers.flush()

    @property
    def _detects(self) -> bool:
        return type(self).detect is not Perceiver.detect

    def _answer(self, question: dict[str, Any], stream: BinaryIO) -> dict[str, Any]:
        if "hello" in question:
            return self._meaning(question["hello"])
        shape = question["height"], question["width"], 3
        images = [np.frombuffer(stream.read(shape[0] * shape[1] * 3), np.uint8).reshape(shape) for _ in range(question["images"])]
        try:
            return {"answers": [self._percept(image) for image in images]}
        except Exception as error:
            traceback.print_exc()
            return {"error": f"{type(error).__name__}: {error}"}

    def _meaning(self, protocol: int) -> dict[str, Any]:
        if protocol != PROTOCOL:
            return {"error": f"it speaks version {PROTOCOL} of the protocol, not {protocol}: update PARACOSM or the package"}
        if not self._detects:
            return {"segments": list(self.segments)}
        meaning: dict[str, Any] = {"classes": list(self.classes), "threshold": self.threshold, "overlap": self.overlap, "extent": self.extent}
        return meaning if self.groups is None else {**meaning, "groups": self.groups}

    def _percept(self, image: NDArray[np.uint8]) -> dict[str, Any]:
        if self._detects:
            return {"boxes": [_box(found) for found in self.detect(image)]}
        mask = np.asarray(self.segment(image))
        if mask.shape != image.shape[:2]:
            raise ValueError(f"segment returned the shape {mask.shape}, expected {image.shape[:2]}")
        return {"mask": _runs(mask.astype(bool).ravel())}


def _box(found: Detection) -> dict[str, Any]:
    return {"class": found.name, "score": float(found.score), "box": [float(found.left), float(found.top), float(found.width), float(found.height)]}


def _runs(mask: NDArray[np.bool_]) -> list[int]:
    """The lengths of the runs of equal pixels, the first one of pixels outside of the mask."""
    borders = np.flatnonzero(mask[1:] != mask[:-1]) + 1
    runs = np.diff(np.concatenate(([0], borders, [mask.size]))).tolist()
    return [0, *runs] if mask.size and mask[0] else runs
