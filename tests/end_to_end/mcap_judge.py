"""Reads an MCAP file with the packages mcap and mcap-protobuf-support, and compares it with the trace of the run and with a recording.

    python3 mcap_judge.py RUN.mcap TRACE.csv [RECORDING]
"""

import csv
import json
import math
import struct
import sys
from pathlib import Path

import numpy as np
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory


def pose(transform):
    """The matrix that takes points of the child to the parent."""
    q, t = transform.rotation, transform.translation
    x, y, z, w = q.x, q.y, q.z, q.w
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = t.x, t.y, t.z
    return matrix


def near(found, expected, tolerance, what):
    assert abs(found - expected) <= tolerance, f"{what}: found {found}, expected {expected}"


run, trace, *recording = sys.argv[1:]
reader = make_reader(open(run, "rb"), decoder_factories=[DecoderFactory()])
topics, frames, parents, tracks, last = {}, {}, {}, {}, -1
for schema, channel, message, decoded in reader.iter_decoded_messages():
    assert message.log_time >= last, "messages stand in the order of their times"
    last = message.log_time
    topics.setdefault(channel.topic, []).append((message.log_time, decoded))
    if schema.name == "foxglove.FrameTransforms":
        for transform in decoded.transforms:
            near(transform.timestamp.seconds + 1e-9 * transform.timestamp.nanos, 1e-9 * message.log_time, 2e-9, "stamp")
            parents[transform.child_frame_id] = transform.parent_frame_id
            tracks.setdefault(transform.child_frame_id, []).append((message.log_time, pose(transform)))


def at(frame, time):
    """The pose of a frame in the world at a time: the last message by then."""
    matrix = np.eye(4)
    while frame != "world":
        known = [pose for stamp, pose in tracks[frame] if stamp <= time]
        matrix = (known or [tracks[frame][0][1]])[-1] @ matrix
        frame = parents[frame]
    return matrix


# Every signal has every number of the trace, to the last digit.
rows = list(csv.DictReader(line for line in open(trace) if not line.startswith("#")))
names = [name for name in rows[0] if name != "time"]
for name in names:
    messages = topics["/signals/" + name.replace(".", "/")]
    assert len(messages) == len(rows), name
    for (stamp, message), row in zip(messages, rows):
        number = float(row[name])
        assert message.value == number if math.isfinite(number) else not message.HasField("value"), name

# The frames of the bodies are where the trace has them.
end = topics["/tf"][-1][0]
row = rows[round(1e-9 * end / (float(rows[1]["time"]) - float(rows[0]["time"])))]
for body in ("car", "pedestrian"):
    place = at(body, end)[:3, 3]
    near(place[0], float(row[f"{body}.x"]), 1e-9, f"{body} x")
    near(place[1], float(row[f"{body}.y"]), 1e-9, f"{body} y")
facing = at("car", end)[:3, 0]
near(math.atan2(facing[1], facing[0]), float(row["car.heading"]), 1e-9, "heading")

# The scene has roads and both bodies, each in its own frame.
roads = topics["/roads"][0][1].entities[0]
assert sum(len(surface.indices) for surface in roads.triangles) > 0
assert all(max(surface.indices) < len(surface.points) for surface in roads.triangles)
entities = {entity.id: entity for _, update in topics["/bodies"] for entity in update.entities}
assert entities["car"].frame_id == "car" and entities["car"].frame_locked and entities["car"].cubes
walker = entities["pedestrian"].cylinders[0]

# The margin of a requirement narrows, and the violation is an event.
bounds = [message for _, message in topics["/requirements/no-collision"]]
assert bounds[-1].lower == bounds[-1].upper < 0
events = {event.name: (stamp, event.message) for stamp, event in topics["/events"]}
assert events["contact"] == (end, "car touches pedestrian"), events
assert events["verdict"] == (end, "fail"), events

# The points of the LiDAR that came from the pedestrian lie on the pedestrian.
echoes = 0
for stamp, cloud in topics["/lidar/points"]:
    fields = {field.name: field.offset for field in cloud.fields}
    assert list(fields) == ["x", "y", "z", "intensity", "body"] and cloud.point_stride == 20
    points = np.frombuffer(cloud.data, dtype=[("place", "<f4", 3), ("intensity", "<f4"), ("body", "<u4")])
    body = at("pedestrian", stamp)[:3, 3]
    hits = points["place"][points["body"] == 2].astype(float)
    world = hits @ at("lidar", stamp)[:3, :3].T + at("lidar", stamp)[:3, 3]
    for x, y, z in world:
        echoes += 1
        # The pedestrian is a cylinder with a side and a top. The noise has a standard deviation of 2 cm along the beam.
        radius = math.hypot(x - body[0], y - body[1])
        from_side, from_top = abs(radius - 0.5 * walker.size.x), abs(z - walker.size.z)
        assert min(from_side, from_top) <= 0.12, (radius, z)
        assert radius <= 0.5 * walker.size.x + 0.12 and -0.12 <= z <= walker.size.z + 0.12, (radius, z)
assert echoes > 20, f"only {echoes} echoes of the pedestrian"

# The images are the images of the recording, and the pinhole shows the pedestrian where the recording has it.
seen = 0
if recording:
    folder = Path(recording[0])
    annotations = json.loads((folder / "annotations.json").read_text())
    files = {image["id"]: image for image in annotations["images"]}
    images = topics["/camera/front/image"]
    for number, (stamp, image) in enumerate(images):
        assert image.format == "png" and image.data == (folder / f"000000/front/rgb/{number:06}.png").read_bytes()
    calibration = topics["/camera/front/calibration"][0][1]
    width, height = struct.unpack(">II", images[0][1].data[16:24])
    assert (calibration.width, calibration.height) == (width, height)
    for note in annotations["annotations"]:
        image = files[note["image_id"]]
        category = next(c["name"] for c in annotations["categories"] if c["id"] == note["category_id"])
        if category != "pedestrian":
            continue
        number = int(Path(image["file_name"]).stem)
        stamp = images[number][0]
        middle = at("pedestrian", stamp) @ [0, 0, 0.5 * walker.size.z, 1]
        x, y, z, _ = np.linalg.inv(at("camera front", stamp)) @ middle
        focal, _, u, _, _, v = list(calibration.K)[:6]
        left, top, across, down = note["bbox"]
        column, line = focal * x / z + u, focal * y / z + v
        # A box of a few pixels says little, and a box may be cut off at the border of the image.
        if down >= 10 and 0 < left and left + across < width and 0 < top and top + down < height:
            seen += 1
            # The pedestrian has depth and moves its legs, so that its middle is not exactly the middle of the box.
            near(column, left + 0.5 * across, 1.5 + 0.1 * across, "column")
            near(line, top + 0.5 * down, 1.5 + 0.1 * down, "line")
    assert seen > 20, f"only {seen} images have the pedestrian as a whole"

summary = reader.get_summary()
facts = [record.metadata for record in reader.iter_metadata() if record.name == "paracosm"][0]
assert facts["verdict"] == "fail" and facts["subject"] == "pedestrian-crossing", facts
print(json.dumps({"messages": summary.statistics.message_count, "echoes": echoes, "images": seen}))
