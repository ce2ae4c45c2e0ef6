"""The messages of `paracosm/driver/v1/driver.proto`, made at run time of its description.

`driver.binpb` is that description as a `FileDescriptorSet`. The tests of the Rust crate `paracosm-rpc` make it and keep it in
step: `UPDATE_GOLDEN=1 cargo test --release -p paracosm-rpc python`. So nobody needs a compiler of protocols.
"""

from importlib.resources import files
from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

SERVICE = "paracosm.driver.v1.Driver"
METHOD = "Drive"
VERSION = 1


def _messages() -> dict[str, Any]:
    described = descriptor_pb2.FileDescriptorSet.FromString(files(__package__).joinpath("driver.binpb").read_bytes())
    pool = descriptor_pool.DescriptorPool()
    for file in described.file:
        pool.Add(file)
    return {
        name.rpartition(".")[2]: message
        for name, message in message_factory.GetMessageClassesForFiles([file.name for file in described.file], pool).items()
    }


_ALL = _messages()
Request = _ALL["Request"]
Answer = _ALL["Answer"]
